//! Looking into candle's tensors on the CPU.

use candle_core::{CpuStorage, Layout, Result, Storage, bail};

/// The values of a contiguous `f32` tensor, as a custom operation meets it; others are refused.
pub fn values<'a>(storage: &'a CpuStorage, layout: &Layout) -> Result<&'a [f32]> {
    match layout.contiguous_offsets() {
        Some((start, end)) => Ok(&storage.as_slice::<f32>()?[start..end]),
        None => bail!("this operation takes contiguous tensors only"),
    }
}

/// As [`values`], from what `Tensor::storage_and_layout` gives.
pub fn stored_values<'a>(storage: &'a Storage, layout: &Layout) -> Result<&'a [f32]> {
    match storage {
        Storage::Cpu(storage) => values(storage, layout),
        _ => bail!("this operation runs on the CPU only"),
    }
}
