//! The agent that the coach uses: deep deterministic policy gradient with several actor heads, its observations and actions.
//!
//! A shot passes through these steps: an [`observation`] of the layout, its [`features`], the actor's [`action`], the cue inputs, the
//! [reward](crate::game::Reward) and the [replay buffer](super::replay). The [`agent`] and its [`networks`] compute the gradients. The
//! [`trainer`] alternates rollout and update. The result is a [`policy`].

pub mod action;
pub mod agent;
pub mod context;
mod dual;
mod expert;
pub mod exploration;
pub mod features;
pub mod first_contact;
pub mod hyperparameters;
pub mod networks;
pub mod observation;
pub mod observation_batch;
mod paths;
pub mod policy;
mod rail_first;
pub mod randomized_tables;
mod rollout;
pub mod snapshot;
pub mod trainer;
