//! Views of a shot that need less learning: the symmetries of a level table, and coordinates relative to the nearer object ball.

use std::f32::consts::PI;

use glam::Vec2;

use super::{
    agent::{Choice, Transition},
    environment::{Action, Observation, State},
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
    /// Returns the view through one symmetry; `symmetry` is below [`SYMMETRIES`].
    pub const fn symmetric(symmetry: u32) -> Self {
        Self { symmetry, line: None }
    }

    /// Returns the symmetric view in which all eight views of a layout look the same, so that a policy has an eighth as much to learn.
    /// The nearer object ball is the first and lies to the right of the cue ball; the other one lies above the cue ball.
    pub fn canonical(state: State) -> Self {
        let (exchanged, [nearer, farther]) = by_distance(state);
        Self::symmetric(bits([nearer.x < 0.0, farther.y < 0.0, exchanged]))
    }

    /// Returns the view along the line from the cue ball to the nearer object ball. This ball is the first and lies to the right of
    /// the cue ball; the other one lies on the left of the line. Directions are measured from the line.
    pub fn relative(state: State) -> Self {
        let (exchanged, [nearer, farther]) = by_distance(state);
        // Each mirror exchanges left and right.
        let mirrored_x = nearer.x < 0.0;
        let mirrored_y = mirrored_x != (nearer.perp_dot(farther) < 0.0);
        let symmetry = Self::symmetric(bits([mirrored_x, mirrored_y, exchanged]));
        Self { line: Some(offset(symmetry.state(state), 1).to_angle() / PI), ..symmetry }
    }

    /// Returns the state in this view. In relative coordinates: the position of the cue ball, the direction of the first ball (quarter
    /// turns) and its distance, and the position of the second ball along and to the left of the line; both in widths of the table.
    pub fn state(self, state: State) -> State {
        let [x0, y0, x1, y1, x2, y2] = state;
        let balls = if self.symmetry & 4 == 0 { state } else { [x0, y0, x2, y2, x1, y1] };
        let seen: State =
            std::array::from_fn(
                |index| if self.symmetry & (1 << (index % 2)) == 0 { balls[index] } else { -balls[index] },
            );
        let Some(line) = self.line else { return seen };
        let [first, second] = [1, 2].map(|ball| 0.5 * offset(seen, ball));
        let direction = Vec2::from_angle(PI * line);
        [seen[0], seen[1], 2.0 * line, first.x.hypot(first.y), direction.dot(second), direction.perp_dot(second)]
    }

    /// Returns an action on the table as an action in this view.
    pub fn action(self, on_table: Action) -> Action {
        let [phi, speed] = self.mirrored(on_table);
        [wrapped(phi, -self.line.unwrap_or_default()), speed]
    }

    /// Returns an action in this view as an action on the table.
    pub fn on_table(self, [phi, speed]: Action) -> Action {
        self.mirrored([wrapped(phi, self.line.unwrap_or_default()), speed])
    }

    /// Mirrors an action; the inverse is the same function.
    fn mirrored(self, [phi, speed]: Action) -> Action {
        let (along, across) = (self.symmetry & 1 != 0, self.symmetry & 2 != 0);
        let phi = if across { -phi } else { phi };
        // Half a turn less the direction, both in half turns.
        let phi = if along { 1.0_f32.copysign(phi) - phi.clamp(-1.0, 1.0) } else { phi };
        [phi, speed]
    }

    /// Returns a transition in this view; `next` is the view of its next state.
    pub fn shot(self, shot: &Transition, next: Self) -> Transition {
        let seen = |view: Self, seen: Observation| Observation { state: view.state(seen.state), ..seen };
        let choice = Choice { action: self.action(shot.choice.action), ..shot.choice };
        Transition { before: seen(self, shot.before), choice, after: seen(next, shot.after), ..*shot }
    }
}

/// Turns `phi` by `turn`, in half turns, into the range from -1 to 1. Without a turn, a direction out of range stays as it is.
fn wrapped(phi: f32, turn: f32) -> f32 {
    if turn == 0.0 {
        return phi;
    }
    let turned = phi + turn;
    turned - 2.0 * (0.5 * turned).round()
}

/// Returns whether the second object ball is the nearer one, and the [`offset`]s of the nearer and the farther ball.
fn by_distance(state: State) -> (bool, [Vec2; 2]) {
    let [one, other] = [1, 2].map(|ball| offset(state, ball));
    let exchanged = other.x.hypot(other.y) < one.x.hypot(one.y);
    (exchanged, if exchanged { [other, one] } else { [one, other] })
}

/// Length of the area that a ball's centre can reach, in widths of it: 2.051 on `thesis`, 2.045 on `match`. A state has shares of half
/// of each.
const ASPECT: f32 = 2.05;

/// Returns the vector from the cue ball to another ball, in half widths of the reachable area.
fn offset(state: State, ball: usize) -> Vec2 {
    Vec2::new(ASPECT * (state[2 * ball] - state[0]), state[2 * ball + 1] - state[1])
}

/// Packs flags into a number, the first into bit 0.
fn bits(flags: [bool; 3]) -> u32 {
    (0..).zip(flags).map(|(bit, flag)| u32::from(flag) << bit).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        game::Reward,
        learning::thesis::carom::{CaromGame, Episode},
        table::{Layout, Table},
    };
    use glam::DVec2;
    use rand::{RngExt, SeedableRng};
    use rand_xoshiro::Xoshiro256PlusPlus;

    #[test]
    fn a_shot_earns_the_same_in_every_view() {
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(8);
        let table = Table::preset("thesis").unwrap();
        let game = CaromGame::new(table.clone(), Reward::R1, Episode::OneShot);
        let (mut same, mut cases) = (0, 0);
        for _ in 0..100 {
            let layout = Layout::random(&table, &mut rng);
            let played = [rng.random_range(-1.0..1.0), rng.random_range(-1.0..1.0)];
            let before = game.observation(&layout);
            let (state, choice) = (before.state, Choice { action: played, index: 0 });
            let shot = Transition { before, choice, after: before, ..Transition::default() };
            let earned = game.reward_of(&layout, played);
            let relative = View::relative(state);
            assert!((relative.on_table(relative.action(played))[0] - played[0]).abs() < 1e-6);
            for symmetry in 0..SYMMETRIES {
                let view = View::symmetric(symmetry);
                let shot_seen = view.shot(&shot, view);
                let (seen, action) = (shot_seen.before.state, shot_seen.choice.action);
                assert_eq!(View::canonical(seen).state(seen), View::canonical(state).state(state));
                let again = View::relative(seen);
                for (number, before) in again.state(seen).into_iter().zip(relative.state(state)) {
                    assert!((number - before).abs() < 1e-6);
                }
                assert!((again.action(action)[0] - relative.action(played)[0]).abs() < 1e-6);
                assert!((view.action(action)[0] - played[0]).abs() < 1e-6);
                let ball = |index: usize| {
                    let [x, y] = [0, 1].map(|axis| f64::from(seen[2 * index + axis]));
                    DVec2::new(x, y) * table.reach()
                };
                let mirrored = Layout::new([0, 1, 2].map(ball));
                assert_eq!(shot_seen.after, shot_seen.before);
                cases += 1;
                same += u32::from(game.reward_of(&mirrored, action) == earned);
                if symmetry == 0 {
                    assert_eq!(shot_seen, shot);
                }
            }
        }
        // Positions and directions are rounded to 24 bits, so a shot that just touches a ball may miss it.
        assert!(same + 2 >= cases, "{same} of {cases}");
    }
}
