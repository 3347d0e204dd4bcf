//! The agent that coaches: deep deterministic policy gradient with several actor heads, and its way of seeing the table.
//!
//! The way of a shot: a [`view`] of the layout, its [`features`], the actor's [`action`], the cue inputs, the
//! [reward](crate::game::Reward), the [`replay`] buffer. The way of a gradient: the [`agent`] and its [`networks`]. The
//! [`trainer`] makes a turn of both, practice and update.

pub mod action;
pub mod agent;
pub mod demonstrations;
mod dual;
pub mod exploration;
pub mod features;
pub mod hindsight;
pub mod hyperparameters;
pub mod learner;
pub mod networks;
pub(super) mod practice;
pub mod replay;
pub mod scenes;
pub mod snapshot;
pub mod stroke;
pub mod trainer;
pub mod view;
