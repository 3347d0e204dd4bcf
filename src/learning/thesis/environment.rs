//! The environment interface of the thesis' agents: states, actions and rewards (thesis 4.1).

use std::f64::consts::PI;

use rand_xoshiro::Xoshiro256PlusPlus;

/// Numbers in a state: the positions of the three balls (equation 43).
pub const STATES: usize = 6;

/// Numbers in an action: direction and speed (4.1.3).
pub const ACTIONS: usize = 2;

/// A state, each number from -1 to 1.
pub type State = [f32; STATES];

/// An action; numbers outside -1 to 1 are clamped to this range.
pub type Action = [f32; ACTIONS];

/// Directions of the discrete actions: -180° to 180° in steps of 5°. As in the thesis, both ends count.
const DIRECTIONS: u32 = 73;

/// Speeds of the discrete actions: 0.5 to 6 m/s in steps of 0.5 m/s.
const SPEEDS: u32 = 12;

/// Number of discrete actions (4.2.2).
pub const DISCRETE_ACTIONS: u32 = DIRECTIONS * SPEEDS;

/// Slowest and fastest shot, m/s.
const SPEED: [f64; 2] = [0.5, 6.0];

/// Returns the action of the discrete action `index`.
pub fn discrete_action(index: u32) -> Action {
    let (direction, speed) = (index / SPEEDS % DIRECTIONS, index % SPEEDS);
    let part = |value: u32, count: u32| 2.0 * value as f32 / (count - 1) as f32 - 1.0;
    [part(direction, DIRECTIONS), part(speed, SPEEDS)]
}

/// Returns the direction (rad) and the speed (m/s) of an action.
pub fn direction_and_speed(action: Action) -> [f64; 2] {
    // NaN becomes the middle of the range, so that a broken network still plays a shot.
    let [direction, speed] = action.map(|value| if value.is_nan() { 0.0 } else { f64::from(value.clamp(-1.0, 1.0)) });
    [PI * direction, SPEED[0] + 0.5 * (SPEED[1] - SPEED[0]) * (speed + 1.0)]
}

/// An agent's observation of the environment.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Observation {
    /// The state.
    pub state: State,
    /// Index of the discrete state, for tabular agents.
    pub cell: u32,
}

/// Outcome of an action.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outcome {
    /// The reward.
    pub reward: f64,
    /// Whether the episode is over.
    pub terminated: bool,
}

/// A game that an agent plays.
pub trait Environment {
    /// Begins an episode.
    fn reset(&mut self, rng: &mut Xoshiro256PlusPlus);

    /// Returns the current observation.
    fn observe(&self) -> Observation;

    /// Carries out an action and returns what follows.
    fn step(&mut self, action: Action) -> Outcome;

    /// Returns the reward that an action would earn now, without carrying it out; 0 if the environment does not support this.
    fn reward_for(&self, _action: Action) -> f64 {
        0.0
    }

    /// Returns states similar to the present one in which an action would succeed; none if the environment does not support this.
    fn hindsight_states(&self, _action: Action, _rng: &mut Xoshiro256PlusPlus) -> Vec<State> {
        Vec::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn discrete_actions_are_the_876_of_the_thesis() {
        assert_eq!(DISCRETE_ACTIONS, 876);
        let close = |index, degrees: f64, speed: f64| {
            let [phi, v] = direction_and_speed(discrete_action(index));
            assert!((phi.to_degrees() - degrees).abs() < 1e-4 && (v - speed).abs() < 1e-5, "{index}: {phi}, {v}");
        };
        close(0, -180.0, 0.5);
        close(11, -180.0, 6.0);
        close(12, -175.0, 0.5);
        close(875, 180.0, 6.0);
    }

    #[test]
    fn actions_out_of_range_are_clamped() {
        assert_eq!(direction_and_speed([3.0, -9.0]), [PI, 0.5]);
        assert_eq!(direction_and_speed([f32::NAN, 1.0]), [0.0, 6.0]);
    }
}
