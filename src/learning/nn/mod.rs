//! Neural networks on candle: dense layers as a [`Module`](candle_nn::Module), Adam as an [`Optimizer`](candle_nn::Optimizer),
//! gradients by candle's automatic differentiation, and weights files. For speed a whole network is one operation ([`fused`]).

pub mod adam;
pub mod fused;
mod matmul;
pub mod mlp;
pub mod squared_error;
pub mod tensors;
pub mod weights;

/// Returns the first line of candle's error, which is its message. The other lines are a backtrace, if the environment enables it.
pub fn first_line(error: &candle_core::Error) -> String {
    error.to_string().lines().next().unwrap_or_default().to_owned()
}
