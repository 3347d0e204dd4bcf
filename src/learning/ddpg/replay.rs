//! A shot as the replay buffer holds it.

use super::{action::Action, observation::Observation, randomized_tables::Conditions};

/// One shot: what was seen, what was done, what it earned. A shot is a whole episode, so there is no next state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transition {
    /// The layout as the agent saw it.
    pub observation: Observation,
    /// Under which conditions it was played.
    pub conditions: Conditions,
    /// What it did.
    pub action: Action,
    /// What that earned, as a share of the most that there is to earn.
    pub success: f32,
}
