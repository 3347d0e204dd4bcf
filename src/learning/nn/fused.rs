//! Forward and backward pass of a whole network as one fused candle operation.

use std::sync::OnceLock;

use candle_core::{CpuStorage, CustomOp2, Device, Layout, Result, Shape, Tensor, bail};
use pulp::Arch;

use super::{
    matmul::{Matrix, product, product_into},
    stored_values, values,
};

/// One pass through the network with layer sizes `sizes`, from inputs (rows x inputs) and flat parameters to outputs.
/// candle's own layers would allocate a dozen intermediate tensors for it.
pub struct Fused {
    sizes: Vec<usize>,
    /// Whether the backward pass computes the gradients with respect to the inputs and to the parameters.
    gradients: [bool; 2],
    /// Outputs of the hidden layers, stored by the forward pass for the backward pass.
    hidden: OnceLock<Vec<Vec<f32>>>,
}

impl Fused {
    /// Creates a pass. `gradients` selects whether its backward pass computes those of the inputs and those of the parameters.
    pub fn new(sizes: &[usize], gradients: [bool; 2]) -> Self {
        Self { sizes: sizes.to_vec(), gradients, hidden: OnceLock::new() }
    }
}

/// Iterates over the layers' weights and biases inside the flat parameters.
fn layers<'a>(sizes: &'a [usize], mut parameters: &'a [f32]) -> impl Iterator<Item = (Matrix<'a>, &'a [f32])> {
    sizes.windows(2).map(move |pair| {
        let (weights, rest) = parameters.split_at(pair[0] * pair[1]);
        let (bias, rest) = rest.split_at(pair[1]);
        parameters = rest;
        (Matrix::new(weights, pair[0], pair[1]), bias)
    })
}

impl CustomOp2 for Fused {
    fn name(&self) -> &'static str {
        "mlp"
    }

    fn cpu_fwd(&self, s1: &CpuStorage, l1: &Layout, s2: &CpuStorage, l2: &Layout) -> Result<(CpuStorage, Shape)> {
        let (rows, inputs) = l1.shape().dims2()?;
        if inputs != self.sizes[0] {
            bail!("a network of sizes {:?} cannot take rows of {inputs} inputs", self.sizes);
        }
        let (inputs, parameters) = (values(s1, l1)?, values(s2, l2)?);
        let mut outputs: Vec<Vec<f32>> = Vec::with_capacity(self.sizes.len());
        for (index, (weights, bias)) in layers(&self.sizes, parameters).enumerate() {
            let from = outputs.last().map_or(inputs, Vec::as_slice);
            let mut next = product(Matrix::new(from, rows, self.sizes[index]), weights);
            let least = if index + 2 == self.sizes.len() { f32::NEG_INFINITY } else { 0.0 };
            // Dispatched so that the loops are compiled for the wide registers of the processor in use.
            Arch::new().dispatch(|| {
                for row in next.chunks_exact_mut(bias.len()) {
                    for (x, b) in row.iter_mut().zip(bias) {
                        *x = (*x + b).max(least);
                    }
                }
            });
            outputs.push(next);
        }
        let Some(last) = outputs.pop() else { bail!("a network needs at least two layer sizes") };
        if self.gradients.contains(&true) {
            self.hidden.get_or_init(|| outputs);
        }
        Ok((CpuStorage::F32(last), Shape::from((rows, self.sizes[self.sizes.len() - 1]))))
    }

    fn bwd(
        &self,
        inputs: &Tensor,
        parameters: &Tensor,
        _outputs: &Tensor,
        gradient: &Tensor,
    ) -> Result<(Option<Tensor>, Option<Tensor>)> {
        let Some(hidden) = self.hidden.get() else { bail!("the forward pass of this network is missing") };
        let (input_storage, input_layout) = inputs.storage_and_layout();
        let (parameter_storage, parameter_layout) = parameters.storage_and_layout();
        let (inputs, parameters) =
            (stored_values(&input_storage, input_layout)?, stored_values(&parameter_storage, parameter_layout)?);
        let [for_inputs, for_parameters] = self.gradients;
        let (rows, mut end) = (input_layout.dims()[0], parameters.len());
        // The gradient with respect to the outputs of the current layer.
        let mut errors: Vec<f32> = gradient.flatten_all()?.to_vec1()?;
        let mut parameter_gradient = vec![0.0; if for_parameters { end } else { 0 }];
        let mut input_gradient = None;
        let layers: Vec<_> = layers(&self.sizes, parameters).collect();
        for (index, (weights, bias)) in layers.into_iter().enumerate().rev() {
            let (before, after) = (self.sizes[index], self.sizes[index + 1]);
            let from = if index == 0 { inputs } else { &hidden[index - 1] };
            let delta = Matrix::new(&errors, rows, after);
            let start = end - (before * after + bias.len());
            if for_parameters {
                let (weight_part, bias_part) = parameter_gradient[start..end].split_at_mut(before * after);
                product_into(Matrix::new(from, rows, before).transposed(), delta, weight_part);
                Arch::new().dispatch(|| {
                    for row in errors.chunks_exact(after) {
                        for (sum, error) in bias_part.iter_mut().zip(row) {
                            *sum += error;
                        }
                    }
                });
            }
            end = start;
            if index == 0 {
                if for_inputs {
                    let values = product(delta, weights.transposed());
                    input_gradient = Some(Tensor::from_vec(values, (rows, before), &Device::Cpu)?);
                }
            } else {
                let slopes = product(delta, weights.transposed());
                // Written to the other vector: in place these become masked stores, slow on AMD's processors without AVX-512.
                errors.clear();
                Arch::new().dispatch(|| {
                    let passed =
                        slopes.iter().zip(from).map(|(slope, output)| if *output > 0.0 { *slope } else { 0.0 });
                    errors.extend(passed);
                });
            }
        }
        let count = parameter_gradient.len();
        let parameter_gradient = for_parameters.then(|| Tensor::from_vec(parameter_gradient, count, &Device::Cpu));
        Ok((input_gradient, parameter_gradient.transpose()?))
    }
}
