//! The thesis' three agents (its chapter 4): Q-learning, deep Q-learning and a plain deep deterministic policy gradient.
//!
//! An [`agent`] plays against an [`environment`], which is `carom` or anything else that has states of six numbers
//! and actions of two. What the thesis found with them, and what they find here, is in `docs/thesis.md`.

pub(crate) mod actor_critic;
pub mod agent;
pub(crate) mod carom;
pub mod ddpg;
pub mod dqn;
pub mod environment;
pub mod exploration;
mod hindsight;
mod lessons;
pub mod q_learning;
pub(crate) mod replay;
mod symmetry;
