//! Networks on candle: perceptrons whose passes are single operations, their optimiser, and their files.

pub mod adam;
mod matmul;
pub mod mlp;
pub mod pass;
pub mod tensors;
pub mod weights;
