//! The eight ways to see one shot: the table mirrored along and across, the object balls exchanged.

use super::{
    environment::{Action, State},
    replay::StoredTransition,
};

/// Number of ways, the shot as it is among them.
pub const WAYS: u32 = 8;

/// A shot seen in way number `way`: for level tables, where no ball and no side is unlike another.
pub fn seen(shot: &StoredTransition, way: u32) -> StoredTransition {
    let (along, across, exchanged) = (way & 1 != 0, way & 2 != 0, way & 4 != 0);
    let state = |state: State| {
        let [x0, y0, x1, y1, x2, y2] = state;
        let balls = if exchanged { [x0, y0, x2, y2, x1, y1] } else { state };
        let flip = [along, across].map(|mirrored| if mirrored { -1.0 } else { 1.0 });
        std::array::from_fn(|index| flip[index % 2] * balls[index])
    };
    StoredTransition {
        state: state(shot.state),
        next: state(shot.next),
        action: action(shot.action, along, across),
        ..*shot
    }
}

fn action([phi, speed]: Action, along: bool, across: bool) -> Action {
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
            let action = [rng.random_range(-1.0..1.0), rng.random_range(-1.0..1.0)];
            let state = game.observation(&layout).state;
            let shot = StoredTransition { state, action, index: 0, reward: 0.0, goes_on: false, next: state };
            let earned = game.reward_of(&layout, action);
            for way in 0..WAYS {
                let seen = seen(&shot, way);
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
