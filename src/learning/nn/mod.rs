//! Networks on candle: dense layers as a [`Module`](candle_nn::Module), Adam as an [`Optimizer`](candle_nn::Optimizer), gradients
//! by candle's automatic differentiation, and files of weights. Where it pays a whole network is one operation ([`fused`]).

pub mod adam;
pub mod fused;
mod matmul;
pub mod mlp;
pub mod squared_error;
pub mod tensors;
pub mod weights;
