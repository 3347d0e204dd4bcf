//! Agents that learn to play: what they see, what they do, and how they get better.
//!
//! The way of a shot: a [`view`] of the layout, its [`features`], the actor's [`action`], the cue inputs, the
//! [reward](crate::game::Reward), the [`replay`] buffer. The way of a gradient: [`ddpg`], the [`networks`] and their
//! [`mlp`], [`adam`]. Around both: the [`trainer`], which a [`run`] on disk drives like any other [`learner`],
//! [`evaluation`], and the finished [`policy`].

pub mod action;
pub mod adam;
mod calendar;
pub mod ddpg;
pub mod demonstrations;
mod dual;
pub mod evaluation;
pub mod exploration;
pub mod features;
pub mod hindsight;
pub mod hyperparameters;
pub mod learner;
mod matmul;
pub mod metrics;
pub mod mlp;
pub mod networks;
pub mod pass;
pub mod policy;
pub mod policy_file;
mod practice;
pub mod replay;
pub mod run;
pub mod scenes;
pub mod snapshot;
mod stroke;
mod tensors;
pub mod thesis;
pub mod trainer;
pub mod view;
pub mod weights;

pub use calendar::timestamp;
pub use policy::{Policy, Proposal};
pub use policy_file::PolicyError;
