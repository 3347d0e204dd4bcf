//! Agents that learn to play: what they see, what they do, and how they get better.

pub mod action;
pub mod adam;
pub mod ddpg;
mod dual;
pub mod evaluation;
pub mod exploration;
mod features;
mod matmul;
pub mod mlp;
pub mod networks;
pub mod policy;
pub mod replay;
pub mod scenes;
mod tensors;
pub mod trainer;
pub mod view;
