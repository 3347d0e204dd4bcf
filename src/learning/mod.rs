//! Agents that learn to play: what they see, what they do, and how they get better.
//!
//! `ddpg` is the agent that coaches, with its way of seeing the table; [`thesis`] holds the thesis' own three; both learn
//! with what `nn` has. A [`run`] on disk drives any [`learner`] of the [`agents`]. What comes out is a [`policy`]; how
//! good it is [`evaluation`] tells.

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
