//! The thesis' three agents (its chapter 4): Q-learning, deep Q-learning and a plain deep deterministic policy gradient.

pub mod actor_critic;
mod kernels;
mod pass;
pub mod update;
