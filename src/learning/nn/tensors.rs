//! Access to the values of candle's tensors on the CPU.

use candle_core::{CpuStorage, Layout, Result, Storage, bail};

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
