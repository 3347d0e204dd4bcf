//! The mean squared error as one candle operation: of candle's own, which takes four, a small network's update would spend a thirtieth.

use candle_core::{CpuStorage, CustomOp2, Layout, Result, Shape, Tensor, bail};

use super::tensors::values;

/// The mean of the squares by which values are off what was wanted of them; its gradient is that of the values alone.
struct SquaredError;

/// The mean squared error of `values` against `wanted`, of the same shape.
///
/// # Errors
/// Where the shapes differ, or one of them is not contiguous.
pub fn squared_error(values: &Tensor, wanted: &Tensor) -> Result<Tensor> {
    values.apply_op2(wanted, SquaredError)
}

impl CustomOp2 for SquaredError {
    fn name(&self) -> &'static str {
        "squared-error"
    }

    fn cpu_fwd(&self, s1: &CpuStorage, l1: &Layout, s2: &CpuStorage, l2: &Layout) -> Result<(CpuStorage, Shape)> {
        if l1.shape() != l2.shape() {
            bail!("values of the shape {:?} were compared with {:?}", l1.shape(), l2.shape());
        }
        let (told, wanted) = (values(s1, l1)?, values(s2, l2)?);
        let sum: f32 = told.iter().zip(wanted).map(|(told, wanted)| (told - wanted) * (told - wanted)).sum();
        Ok((CpuStorage::F32(vec![sum / told.len() as f32]), Shape::from(())))
    }

    fn bwd(
        &self,
        told: &Tensor,
        wanted: &Tensor,
        _error: &Tensor,
        gradient: &Tensor,
    ) -> Result<(Option<Tensor>, Option<Tensor>)> {
        let share = f64::from(gradient.to_scalar::<f32>()?) / told.elem_count() as f64;
        Ok((Some((told - wanted)?.affine(2.0 * share, 0.0)?), None))
    }
}

#[cfg(test)]
mod tests {
    use candle_core::{Device, Var};
    use candle_nn::loss::mse;

    use super::*;

    #[test]
    fn error_and_gradient_are_those_of_candle_s_own_operations() {
        let told = Var::new(&[[1.5f32], [-0.25], [3.0]], &Device::Cpu).unwrap();
        let wanted = Tensor::new(&[[1.0f32], [0.5], [-2.0]], &Device::Cpu).unwrap();
        let [ours, theirs] = [squared_error(&told, &wanted), mse(&told, &wanted)].map(|error| {
            let error = (error.unwrap() * 3.0).unwrap();
            let gradients = error.backward().unwrap();
            let gradient = gradients.get(&told).unwrap().flatten_all().unwrap().to_vec1::<f32>().unwrap();
            (error.to_scalar::<f32>().unwrap(), gradient)
        });
        assert_eq!(ours, theirs);
        assert!(squared_error(&told, &wanted.t().unwrap()).is_err());
    }
}
