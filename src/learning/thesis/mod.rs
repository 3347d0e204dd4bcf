//! The thesis' three agents (its chapter 4): Q-learning, deep Q-learning and a plain deep deterministic policy gradient.
//!
//! An [`agent`] plays in an [`environment`], which is `carom` or any other with states of six numbers and actions of two.
//! `docs/thesis.md` compares the results of the thesis with those of this program.

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
