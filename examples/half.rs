//! Writes the arrays of a policy's file with numbers of 16 bits in place of 32: half the bytes in the program and in its package.
//! What that costs `carom evaluate --policy-only --policy FILE` tells.

use std::{env, error::Error, fs};

use half::f16;
use safetensors::{Dtype, SafeTensors, tensor::TensorView};

fn main() -> Result<(), Box<dyn Error>> {
    for path in env::args().skip(1) {
        let bytes = fs::read(&path)?;
        let (_, metadata) = SafeTensors::read_metadata(&bytes)?;
        let note = metadata.metadata().clone();
        let arrays = SafeTensors::deserialize(&bytes)?;
        let mut short = Vec::new();
        for (name, array) in arrays.iter() {
            if array.dtype() != Dtype::F32 {
                return Err(format!(
                    "{path}: the array {name} is {:?}; accepted are numbers of 32 bits",
                    array.dtype()
                )
                .into());
            }
            let (values, _) = array.data().as_chunks::<4>();
            let values: Vec<f16> = values.iter().map(|value| f16::from_f32(f32::from_le_bytes(*value))).collect();
            if values.iter().any(|value| !value.is_finite()) {
                return Err(format!("{path}: the array {name} has numbers that 16 bits cannot hold").into());
            }
            let values: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
            short.push((name.to_owned(), array.shape().to_vec(), values));
        }
        let views = short.iter().map(|(name, shape, values)| {
            TensorView::new(Dtype::F16, shape.clone(), values).map(|view| (name.as_str(), view))
        });
        let views = views.collect::<Result<Vec<_>, _>>()?;
        fs::write(&path, safetensors::serialize(views, note)?)?;
    }
    Ok(())
}
