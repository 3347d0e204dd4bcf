//! The mean squared error as one candle operation. candle's own takes four, a thirtieth of the time of a small network's update.

use candle_core::{CpuStorage, CustomOp2, Layout, Result, Shape, Tensor, bail};

use super::values;

/// The mean squared difference of predictions and targets. It has a gradient with respect to the predictions only.
struct SquaredError;

/// Returns the mean squared error of `predicted` against `target`, of the same shape.
///
/// # Errors
/// Fails if the shapes differ or if a tensor is not contiguous.
pub fn squared_error(predicted: &Tensor, target: &Tensor) -> Result<Tensor> {
    predicted.apply_op2(target, SquaredError)
}

impl CustomOp2 for SquaredError {
    fn name(&self) -> &'static str {
        "squared-error"
    }

    fn cpu_fwd(&self, s1: &CpuStorage, l1: &Layout, s2: &CpuStorage, l2: &Layout) -> Result<(CpuStorage, Shape)> {
        if l1.shape() != l2.shape() {
            bail!("values of the shape {:?} were compared with {:?}", l1.shape(), l2.shape());
        }
        let (predicted, target) = (values(s1, l1)?, values(s2, l2)?);
        let sum: f32 =
            predicted.iter().zip(target).map(|(predicted, target)| (predicted - target) * (predicted - target)).sum();
        Ok((CpuStorage::F32(vec![sum / predicted.len() as f32]), Shape::from(())))
    }

    fn bwd(
        &self,
        predicted: &Tensor,
        target: &Tensor,
        _error: &Tensor,
        gradient: &Tensor,
    ) -> Result<(Option<Tensor>, Option<Tensor>)> {
        let share = f64::from(gradient.to_scalar::<f32>()?) / predicted.elem_count() as f64;
        Ok((Some((predicted - target)?.affine(2.0 * share, 0.0)?), None))
    }
}

#[cfg(test)]
mod tests {
    use candle_core::{Device, Var};
    use candle_nn::loss::mse;

    use super::*;

    #[test]
    fn error_and_gradient_agree_with_candle() {
        let predicted = Var::new(&[[1.5f32], [-0.25], [3.0]], &Device::Cpu).unwrap();
        let target = Tensor::new(&[[1.0f32], [0.5], [-2.0]], &Device::Cpu).unwrap();
        let [ours, theirs] = [squared_error(&predicted, &target), mse(&predicted, &target)].map(|error| {
            let error = (error.unwrap() * 3.0).unwrap();
            let gradients = error.backward().unwrap();
            let gradient = gradients.get(&predicted).unwrap().flatten_all().unwrap().to_vec1::<f32>().unwrap();
            (error.to_scalar::<f32>().unwrap(), gradient)
        });
        assert_eq!(ours, theirs);
        assert!(squared_error(&predicted, &target.t().unwrap()).is_err());
    }
}
