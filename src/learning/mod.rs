//! Agents that learn to play: what they see, what they do, and how they get better.

mod adam;
mod matmul;
mod mlp;
mod tensors;
