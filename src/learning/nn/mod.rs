//! Networks on candle: dense layers as a [`Module`](candle_nn::Module), Adam as an [`Optimizer`](candle_nn::Optimizer), gradients
//! by candle's automatic differentiation, and files of weights. Where it pays a whole network is one operation ([`fused`]).

pub mod adam;
pub mod fused;
mod matmul;
pub mod mlp;
pub mod squared_error;
pub mod tensors;
pub mod weights;

/// What an error of candle says: its first line. The others say where in the program, if the environment asks for that.
pub fn first_line(error: &candle_core::Error) -> String {
    error.to_string().lines().next().unwrap_or_default().to_owned()
}
