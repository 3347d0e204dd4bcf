//! Views of a shot that need less learning: the symmetries of a level table, and coordinates relative to the nearer object ball.

use std::f32::consts::PI;

use super::{
    environment::{Action, State},
    replay::StoredTransition,
};

/// Number of symmetric views, the identity included: the table mirrored along its length and its width, the object balls exchanged.
pub const SYMMETRIES: u32 = 8;

/// A transformation of states and actions under which a shot earns the same, on level tables with equal object balls.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct View {
    /// Which of the [`SYMMETRIES`]: bit 0 mirrors x, bit 1 mirrors y, bit 2 exchanges the object balls.
    symmetry: u32,
    /// In relative coordinates: the direction from the cue ball to the first object ball, in half turns, after the symmetry.
    line: Option<f32>,
}

impl View {
    /// The view through one symmetry; `symmetry` is below [`SYMMETRIES`].
    pub const fn symmetric(symmetry: u32) -> Self {
        Self { symmetry, line: None }
    }

    /// The one of the symmetric views that all eight share: a policy that acts in it has an eighth as much to learn. The nearer
    /// object ball is the first and lies to the right of the cue ball; the other one lies above the cue ball.
    pub fn canonical(state: State) -> Self {
        let (exchanged, [nearer, farther]) = by_distance(state);
        Self::symmetric(bits([nearer[0] < 0.0, farther[1] < 0.0, exchanged]))
    }

    /// The view along the line from the cue ball to the nearer object ball, which is the first and lies to the right of the cue ball.
    /// The other one lies on the left of that line, and directions are measured from it.
    pub fn relative(state: State) -> Self {
        let (exchanged, [nearer, farther]) = by_distance(state);
        // Each mirror exchanges left and right.
        let mirrored_x = nearer[0] < 0.0;
        let mirrored_y = mirrored_x != (cross(nearer, farther) < 0.0);
        let symmetry = Self::symmetric(bits([mirrored_x, mirrored_y, exchanged]));
        let [x, y] = offset(symmetry.state(state), 1);
        Self { line: Some(y.atan2(x) / PI), ..symmetry }
    }

    /// The state in this view. In relative coordinates: the place of the cue ball, the direction of the first ball (in quarter turns)
    /// and its distance, and the place of the second ball along and to the left of that line; lengths in widths of the table.
    pub fn state(self, state: State) -> State {
        let [x0, y0, x1, y1, x2, y2] = state;
        let balls = if self.symmetry & 4 == 0 { state } else { [x0, y0, x2, y2, x1, y1] };
        let seen: State =
            std::array::from_fn(
                |index| if self.symmetry & (1 << (index % 2)) == 0 { balls[index] } else { -balls[index] },
            );
        let Some(line) = self.line else { return seen };
        let [first, second] = [1, 2].map(|ball| offset(seen, ball));
        let (sine, cosine) = (PI * line).sin_cos();
        let [along, left] = [dot([cosine, sine], second), cross([cosine, sine], second)];
        [seen[0], seen[1], 2.0 * line, 0.5 * first[0].hypot(first[1]), 0.5 * along, 0.5 * left]
    }

    /// An action on the table as this view has it.
    pub fn action(self, on_table: Action) -> Action {
        let [phi, speed] = self.mirrored(on_table);
        [wrapped(phi, -self.line.unwrap_or_default()), speed]
    }

    /// An action in this view as it is carried out on the table.
    pub fn on_table(self, [phi, speed]: Action) -> Action {
        self.mirrored([wrapped(phi, self.line.unwrap_or_default()), speed])
    }

    /// An action in the mirrored table, or back from it.
    fn mirrored(self, [phi, speed]: Action) -> Action {
        let (along, across) = (self.symmetry & 1 != 0, self.symmetry & 2 != 0);
        let phi = if across { -phi } else { phi };
        // Half a turn less the direction, both in half turns.
        let phi = if along { 1.0_f32.copysign(phi) - phi.clamp(-1.0, 1.0) } else { phi };
        [phi, speed]
    }

    /// A shot in this view; `next` is the view of what follows it.
    pub fn shot(self, shot: &StoredTransition, next: Self) -> StoredTransition {
        let (state, action) = (self.state(shot.state), self.action(shot.action));
        StoredTransition { state, action, next: next.state(shot.next), ..*shot }
    }
}

/// `phi` turned by `turn`, in half turns; directions out of range stay so where nothing is turned.
fn wrapped(phi: f32, turn: f32) -> f32 {
    if turn == 0.0 {
        return phi;
    }
    let turned = phi + turn;
    turned - 2.0 * (0.5 * turned).round()
}

/// Whether the second object ball is the nearer one, and the [`offset`]s of the nearer and the farther ball.
fn by_distance(state: State) -> (bool, [[f32; 2]; 2]) {
    let [one, other] = [1, 2].map(|ball| offset(state, ball));
    let exchanged = other[0].hypot(other[1]) < one[0].hypot(one[1]);
    (exchanged, if exchanged { [other, one] } else { [one, other] })
}

/// From the cue ball to another ball, in half widths of the table. A state has parts of half the table, which is twice as long as wide.
fn offset(state: State, ball: usize) -> [f32; 2] {
    [2.0 * (state[2 * ball] - state[0]), state[2 * ball + 1] - state[1]]
}

fn bits(flags: [bool; 3]) -> u32 {
    (0..).zip(flags).map(|(bit, flag)| u32::from(flag) << bit).sum()
}

fn dot(a: [f32; 2], b: [f32; 2]) -> f32 {
    a[0] * b[0] + a[1] * b[1]
}

/// Positive if `b` points to the left of `a`.
fn cross(a: [f32; 2], b: [f32; 2]) -> f32 {
    a[0] * b[1] - a[1] * b[0]
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
    fn a_shot_earns_the_same_in_every_view() {
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(8);
        let table = Table::preset("thesis").unwrap();
        let game = Carom::new(table.clone(), Reward::R1, Episode::OneShot);
        let (mut same, mut cases) = (0, 0);
        for _ in 0..100 {
            let layout = Layout::random(&table, &mut rng);
            let played = [rng.random_range(-1.0..1.0), rng.random_range(-1.0..1.0)];
            let state = game.observation(&layout).state;
            let shot = StoredTransition { state, action: played, index: 0, reward: 0.0, continues: false, next: state };
            let earned = game.reward_of(&layout, played);
            let relative = View::relative(state);
            assert!((relative.on_table(relative.action(played))[0] - played[0]).abs() < 1e-6);
            for symmetry in 0..SYMMETRIES {
                let view = View::symmetric(symmetry);
                let seen = view.shot(&shot, view);
                assert_eq!(View::canonical(seen.state).state(seen.state), View::canonical(state).state(state));
                let again = View::relative(seen.state);
                for (number, before) in again.state(seen.state).into_iter().zip(relative.state(state)) {
                    assert!((number - before).abs() < 1e-6);
                }
                assert!((again.action(seen.action)[0] - relative.action(played)[0]).abs() < 1e-6);
                assert!((view.action(seen.action)[0] - played[0]).abs() < 1e-6);
                let ball = |index: usize| {
                    let [x, y] = [0, 1].map(|axis| f64::from(seen.state[2 * index + axis]));
                    DVec2::new(x, y) * table.reach()
                };
                let mirrored = Layout::new([0, 1, 2].map(ball));
                assert_eq!(seen.next, seen.state);
                cases += 1;
                same += u32::from(game.reward_of(&mirrored, seen.action) == earned);
                if symmetry == 0 {
                    assert_eq!(seen, shot);
                }
            }
        }
        // Places and directions are rounded to 24 bits: a shot that just touches a ball may miss it.
        assert!(same + 2 >= cases, "{same} of {cases}");
    }
}
