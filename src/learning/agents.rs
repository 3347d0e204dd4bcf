//! The agents that can be trained, by name.

use super::{
    ddpg::trainer::AGENT as DDPG,
    learner::AgentKind,
    thesis::{agent::kind_of, ddpg::PlainDdpg, dqn::Dqn, q_learning::QLearning},
};
use crate::printing::did_you_mean;

/// The agents that can be trained. To add one: implement [`Learner`](super::learner::Learner) and add its line here.
pub const AGENTS: [AgentKind; 4] = [DDPG, kind_of::<QLearning>(), kind_of::<Dqn>(), kind_of::<PlainDdpg>()];

impl AgentKind {
    /// Returns the agent called `name`.
    ///
    /// # Errors
    /// [`UnknownAgent`], whose message lists the known agents.
    pub fn named(name: &str) -> Result<Self, UnknownAgent> {
        AGENTS.into_iter().find(|agent| agent.name == name).ok_or_else(|| UnknownAgent(name.to_owned()))
    }
}

/// The name of an agent is unknown.
#[derive(Debug, thiserror::Error, PartialEq)]
#[error(
    "there is no agent \"{0}\"; use {list}{meant}",
    list = AGENTS.map(|agent| agent.name).join(", "),
    meant = did_you_mean(_0, AGENTS.map(|agent| agent.name))
)]
pub struct UnknownAgent(String);
