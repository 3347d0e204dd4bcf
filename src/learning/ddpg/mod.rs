//! The agent that coaches: deep deterministic policy gradient with several actor heads, and its way of seeing the table.
//!
//! The way of a shot: a [`observation`] of the layout, its [`features`], the actor's [`action`], the cue inputs, the
//! [reward](crate::game::Reward), the [replay buffer](super::replay). The way of a gradient: the [`agent`] and its [`networks`]. The
//! [`trainer`] iterates over both, rollout and update. What comes out is a [`policy`].

pub mod action;
pub mod agent;
pub mod context;
mod dual;
mod expert;
pub mod exploration;
pub mod features;
pub mod first_contact;
pub mod hyperparameters;
pub mod learner;
pub mod networks;
pub mod observation;
pub mod observation_batch;
pub mod policy;
mod rail_first;
pub mod randomized_tables;
mod rollout;
pub mod snapshot;
pub mod trainer;
mod ways;
