//! The eight ways to see one shot: the table mirrored along and across, the object balls exchanged.

use super::{
    environment::{Action, State},
    replay::StoredTransition,
};

/// Number of ways, the shot as it is among them.
pub const WAYS: u32 = 8;

/// A shot seen in way number `way`: for level tables, where no ball and no side is unlike another.
pub fn seen(shot: &StoredTransition, way: u32) -> StoredTransition {
    StoredTransition {
        state: state(shot.state, way),
        next: state(shot.next, way),
        action: action(shot.action, way),
        ..*shot
    }
}

/// The way in which `state` is seen in its canonical frame: all eight ways of one shot have it in common, so that whoever acts there
/// has an eighth as much to learn. The nearer object ball comes first and lies to the right of the cue ball, the other one above it.
pub fn to_canonical(state: State) -> u32 {
    // Numbers of a state are parts of half the table, which is twice as long as wide.
    let offset = |ball: usize| [0, 1].map(|axis| state[2 * ball + axis] - state[axis]);
    let distance = |[x, y]: [f32; 2]| (2.0 * x).hypot(y);
    let [one, other] = [1, 2].map(offset);
    let exchanged = distance(other) < distance(one);
    let [nearer, farther] = if exchanged { [other, one] } else { [one, other] };
    u32::from(nearer[0] < 0.0) | u32::from(farther[1] < 0.0) << 1 | u32::from(exchanged) << 2
}

/// A shot in the canonical frame of its state, and what comes next in its own.
pub fn canonical(shot: &StoredTransition) -> StoredTransition {
    StoredTransition { next: state(shot.next, to_canonical(shot.next)), ..seen(shot, to_canonical(shot.state)) }
}

/// A state in way number `way`.
pub fn state(state: State, way: u32) -> State {
    let [x0, y0, x1, y1, x2, y2] = state;
    let balls = if way & 4 != 0 { [x0, y0, x2, y2, x1, y1] } else { state };
    std::array::from_fn(|index| if way & (1 << (index % 2)) != 0 { -balls[index] } else { balls[index] })
}

/// An action in way number `way`; the same way leads back.
pub fn action([phi, speed]: Action, way: u32) -> Action {
    let (along, across) = (way & 1 != 0, way & 2 != 0);
    let phi = if across { -phi } else { phi };
    // Half a turn less the direction, both in half turns.
    let phi = if along { 1.0_f32.copysign(phi) - phi.clamp(-1.0, 1.0) } else { phi };
    [phi, speed]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        game::Reward,
        learning::thesis::carom::{Carom, Episode},
        table::{Layout, Table},
    };
    use glam::DVec2;
    use rand::{RngExt, SeedableRng};
    use rand_xoshiro::Xoshiro256PlusPlus;

    #[test]
    fn a_shot_earns_the_same_in_whichever_way_it_is_seen() {
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(8);
        let table = Table::preset("thesis").unwrap();
        let game = Carom::new(table.clone(), Reward::R1, Episode::OneShot);
        let (mut same, mut cases) = (0, 0);
        for _ in 0..100 {
            let layout = Layout::random(&table, &mut rng);
            let played = [rng.random_range(-1.0..1.0), rng.random_range(-1.0..1.0)];
            let state = game.observation(&layout).state;
            let shot = StoredTransition { state, action: played, index: 0, reward: 0.0, goes_on: false, next: state };
            let earned = game.reward_of(&layout, played);
            for way in 0..WAYS {
                let seen = seen(&shot, way);
                assert_eq!(canonical(&seen).state, canonical(&shot).state);
                assert!((action(seen.action, way)[0] - shot.action[0]).abs() < 1e-6);
                let ball = |index: usize| {
                    let [x, y] = [0, 1].map(|axis| f64::from(seen.state[2 * index + axis]));
                    DVec2::new(x, y) * table.reach()
                };
                let mirrored = Layout::new([0, 1, 2].map(ball));
                assert_eq!(seen.next, seen.state);
                cases += 1;
                same += u32::from(game.reward_of(&mirrored, seen.action) == earned);
                if way == 0 {
                    assert_eq!(seen, shot);
                }
            }
        }
        // Places and directions are rounded to 24 bits: a shot that just touches a ball may miss it.
        assert!(same + 2 >= cases, "{same} of {cases}");
    }
}
