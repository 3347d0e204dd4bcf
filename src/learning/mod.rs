//! Reinforcement learning: the agents, their networks, training runs on disk, and evaluation.
//!
//! `ddpg` is the agent that the coach uses, with its own observations and actions; [`thesis`] holds the three agents of the thesis.
//! Both use the networks of `nn`. A [`run`] on disk trains the [`learner`] of any of the [`agents`]. The result is a [`policy`];
//! [`evaluation`] measures how good it is.

pub mod agents;
mod checksum;
pub(crate) mod ddpg;
pub mod evaluation;
pub mod learner;
pub(crate) mod nn;
pub(crate) mod replay;
pub mod run;
pub(crate) mod settings;
pub mod thesis;

pub use ddpg::policy::{self, Policy, Proposal, file::PolicyError};
pub use nn::weights;
