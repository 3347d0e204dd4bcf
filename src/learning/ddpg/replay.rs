//! A shot as the replay buffer holds it.

use super::{action::Action, observation::Observation, venues::Conditions};

/// Proposals of a layout that are played where the critic learns to rank them: the best of those that all heads give. Among the others
/// it hardly ever chooses wrongly.
pub const RANKED: usize = 8;

/// The best proposals of one layout, as they were played.
pub type Ranking = [Transition; RANKED];

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
