//! Neural networks on candle: dense layers as a [`Module`](candle_nn::Module), Adam as an [`Optimizer`](candle_nn::Optimizer),
//! gradients by candle's automatic differentiation, and weights files. For speed a whole network is one operation ([`fused`]).

pub mod adam;
pub mod fused;
mod matmul;
pub mod mlp;
pub mod squared_error;
pub mod weights;

use candle_core::{CpuStorage, Layout, Result, Storage, Tensor, bail};

/// Returns the first line of candle's error, which is its message. The other lines are a backtrace, if the environment enables it.
pub fn first_line(error: &candle_core::Error) -> String {
    error.to_string().lines().next().unwrap_or_default().to_owned()
}

/// Returns the number in a scalar tensor.
pub fn number(tensor: &Tensor) -> Result<f64> {
    tensor.to_scalar::<f32>().map(f64::from)
}

/// Returns the values of a contiguous `f32` tensor inside a custom operation; fails for any other tensor.
pub fn values<'a>(storage: &'a CpuStorage, layout: &Layout) -> Result<&'a [f32]> {
    match layout.contiguous_offsets() {
        Some((start, end)) => Ok(&storage.as_slice::<f32>()?[start..end]),
        None => bail!("this operation takes contiguous tensors only"),
    }
}

/// Returns the same as [`values`], from the result of `Tensor::storage_and_layout`.
pub fn stored_values<'a>(storage: &'a Storage, layout: &Layout) -> Result<&'a [f32]> {
    match storage {
        Storage::Cpu(storage) => values(storage, layout),
        _ => bail!("this operation runs on the CPU only"),
    }
}
