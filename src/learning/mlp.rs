//! Multi-layer perceptrons: flat parameters, seeded initialisation, forward and backward pass as one candle operation.

use std::sync::OnceLock;

use candle_core::{CpuStorage, CustomOp2, Device, Layout, Result, Shape, Tensor, Var, bail};
use rand::{Rng, RngExt};

use super::{
    matmul::{Matrix, product},
    tensors::{stored_values, values},
};

/// A network of dense layers with rectified linear units between them and a linear output.
///
/// All weights and biases lie in one flat variable, layer after layer: the weight matrix (inputs x outputs, row after
/// row), then the bias. The optimiser, the target update and a checkpoint then handle one tensor a network.
#[derive(Clone, Debug)]
pub struct Mlp {
    sizes: Vec<usize>,
    parameters: Var,
}

impl Mlp {
    /// A network with the given layer sizes, inputs first, drawn from `rng`: weights uniform within ±sqrt(6 / inputs)
    /// (He), those of the last layer a hundredth of that so that training starts from indifferent outputs, biases
    /// zero. candle's own generator cannot be seeded on a CPU.
    ///
    /// # Errors
    /// Whatever candle reports.
    pub fn random(sizes: &[usize], rng: &mut (impl Rng + ?Sized)) -> Result<Self> {
        let mut parameters = Vec::with_capacity(parameter_count(sizes));
        for (layer, pair) in sizes.windows(2).enumerate() {
            let shrink = if layer + 2 == sizes.len() { 0.01 } else { 1.0 };
            let bound = shrink * (6.0 / pair[0] as f32).sqrt();
            parameters.extend((0..pair[0] * pair[1]).map(|_| rng.random_range(-bound..=bound)));
            parameters.resize(parameters.len() + pair[1], 0.0);
        }
        Self::from_parameters(sizes, parameters)
    }

    /// A network with the given parameters.
    ///
    /// # Errors
    /// Where their number does not fit the layer sizes.
    pub fn from_parameters(sizes: &[usize], parameters: Vec<f32>) -> Result<Self> {
        let count = parameter_count(sizes);
        if parameters.len() != count {
            bail!("a network of sizes {sizes:?} has {count} parameters, not {}", parameters.len());
        }
        Ok(Self { sizes: sizes.to_vec(), parameters: Var::from_vec(parameters, count, &Device::Cpu)? })
    }

    /// A network with its own copy of the parameters.
    ///
    /// # Errors
    /// Whatever candle reports.
    pub fn duplicate(&self) -> Result<Self> {
        Self::from_parameters(&self.sizes, self.parameters.to_vec1()?)
    }

    /// This network with another bias in its last layer.
    ///
    /// # Errors
    /// Where `bias` has not one value for each output.
    pub fn with_output_bias(self, bias: &[f32]) -> Result<Self> {
        let mut parameters: Vec<f32> = self.parameters.to_vec1()?;
        let outputs = self.sizes[self.sizes.len() - 1];
        if bias.len() != outputs {
            bail!("{outputs} outputs have no bias of {} values", bias.len());
        }
        let start = parameters.len() - outputs;
        parameters[start..].copy_from_slice(bias);
        Self::from_parameters(&self.sizes, parameters)
    }

    /// Layer sizes, inputs first.
    pub fn sizes(&self) -> &[usize] {
        &self.sizes
    }

    /// The flat parameters.
    pub const fn parameters(&self) -> &Var {
        &self.parameters
    }

    /// Outputs (rows x outputs) for inputs (rows x inputs); gradients flow to the parameters and to the inputs.
    ///
    /// # Errors
    /// Where the inputs have another shape.
    pub fn forward(&self, inputs: &Tensor) -> Result<Tensor> {
        self.apply(inputs, self.parameters.as_tensor())
    }

    /// As [`Mlp::forward`], without gradients for the parameters.
    ///
    /// # Errors
    /// Where the inputs have another shape.
    pub fn forward_frozen(&self, inputs: &Tensor) -> Result<Tensor> {
        self.apply(inputs, &self.parameters.as_detached_tensor())
    }

    /// As [`Mlp::forward`], but outside candle's automatic differentiation: the record gives the gradients when asked.
    ///
    /// # Errors
    /// Where the inputs have another shape.
    pub fn record(&self, inputs: &Tensor, wanted: Wanted) -> Result<Record> {
        let pass = Pass { sizes: self.sizes.clone(), hidden: OnceLock::new(), wanted: Some(wanted) };
        let (inputs, parameters) = (inputs.detach(), self.parameters.as_detached_tensor());
        let outputs = inputs.apply_op2_no_bwd(&parameters, &pass)?;
        Ok(Record { pass, inputs, parameters, outputs })
    }

    fn apply(&self, inputs: &Tensor, parameters: &Tensor) -> Result<Tensor> {
        let wanted = match (inputs.track_op(), parameters.track_op()) {
            (true, true) => Some(Wanted::Both),
            (true, false) => Some(Wanted::Inputs),
            (false, true) => Some(Wanted::Parameters),
            (false, false) => None,
        };
        inputs.apply_op2(parameters, Pass { sizes: self.sizes.clone(), hidden: OnceLock::new(), wanted })
    }
}

/// What gradients are wanted for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wanted {
    /// For the inputs only.
    Inputs,
    /// For the parameters only.
    Parameters,
    /// For both.
    Both,
}

/// A forward pass that remembers what its backward pass needs.
///
/// candle's own backward pass through the same operation adds every gradient to a tensor of zeros, on a pool of
/// spinning threads from 65,536 values on; that takes as long as the matrix products.
pub struct Record {
    pass: Pass,
    inputs: Tensor,
    parameters: Tensor,
    outputs: Tensor,
}

impl Record {
    /// What the network said.
    pub const fn outputs(&self) -> &Tensor {
        &self.outputs
    }

    /// The gradients for the inputs and the parameters, where wanted, from that for the outputs.
    ///
    /// # Errors
    /// Where `gradient` has another shape than the outputs.
    pub fn backward(&self, gradient: &Tensor) -> Result<(Option<Tensor>, Option<Tensor>)> {
        self.pass.bwd(&self.inputs, &self.parameters, &self.outputs, gradient)
    }
}

fn parameter_count(sizes: &[usize]) -> usize {
    sizes.windows(2).map(|pair| (pair[0] + 1) * pair[1]).sum()
}

/// One pass through a network. candle's own layers would allocate a dozen intermediate tensors for it.
struct Pass {
    sizes: Vec<usize>,
    /// Outputs of the hidden layers, kept by the forward pass for the backward pass.
    hidden: OnceLock<Vec<Vec<f32>>>,
    wanted: Option<Wanted>,
}

impl Pass {
    fn for_inputs(&self) -> bool {
        matches!(self.wanted, Some(Wanted::Inputs | Wanted::Both))
    }

    fn for_parameters(&self) -> bool {
        matches!(self.wanted, Some(Wanted::Parameters | Wanted::Both))
    }
}

/// A layer's weights and bias inside the flat parameters.
fn layers<'a>(sizes: &'a [usize], mut parameters: &'a [f32]) -> impl Iterator<Item = (Matrix<'a>, &'a [f32])> {
    sizes.windows(2).map(move |pair| {
        let (weights, rest) = parameters.split_at(pair[0] * pair[1]);
        let (bias, rest) = rest.split_at(pair[1]);
        parameters = rest;
        (Matrix::new(weights, pair[0], pair[1]), bias)
    })
}

impl CustomOp2 for Pass {
    fn name(&self) -> &'static str {
        "mlp"
    }

    fn cpu_fwd(&self, s1: &CpuStorage, l1: &Layout, s2: &CpuStorage, l2: &Layout) -> Result<(CpuStorage, Shape)> {
        let (rows, inputs) = l1.shape().dims2()?;
        if inputs != self.sizes[0] {
            bail!("a network of sizes {:?} was given rows of {inputs}", self.sizes);
        }
        let (inputs, parameters) = (values(s1, l1)?, values(s2, l2)?);
        let mut outputs: Vec<Vec<f32>> = Vec::with_capacity(self.sizes.len());
        for (index, (weights, bias)) in layers(&self.sizes, parameters).enumerate() {
            let from = outputs.last().map_or(inputs, Vec::as_slice);
            let mut next = product(Matrix::new(from, rows, self.sizes[index]), weights);
            let least = if index + 2 == self.sizes.len() { f32::NEG_INFINITY } else { 0.0 };
            for row in next.chunks_exact_mut(bias.len()) {
                for (x, b) in row.iter_mut().zip(bias) {
                    *x = (*x + b).max(least);
                }
            }
            outputs.push(next);
        }
        let Some(last) = outputs.pop() else { bail!("a network needs at least two layer sizes") };
        if self.wanted.is_some() {
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
        let (rows, mut end) = (input_layout.dims()[0], parameters.len());
        // The gradient with respect to the outputs of the layer that is being worked on.
        let mut errors: Vec<f32> = gradient.flatten_all()?.to_vec1()?;
        let mut parameter_gradient = vec![0.0; if self.for_parameters() { end } else { 0 }];
        let mut input_gradient = None;
        let layers: Vec<_> = layers(&self.sizes, parameters).collect();
        for (index, (weights, bias)) in layers.into_iter().enumerate().rev() {
            let (before, after) = (self.sizes[index], self.sizes[index + 1]);
            let from = if index == 0 { inputs } else { &hidden[index - 1] };
            let delta = Matrix::new(&errors, rows, after);
            let start = end - (before * after + bias.len());
            if self.for_parameters() {
                let (weight_part, bias_part) = parameter_gradient[start..end].split_at_mut(before * after);
                weight_part.copy_from_slice(&product(Matrix::new(from, rows, before).transposed(), delta));
                for row in errors.chunks_exact(after) {
                    for (sum, error) in bias_part.iter_mut().zip(row) {
                        *sum += error;
                    }
                }
            }
            end = start;
            if index == 0 {
                if self.for_inputs() {
                    let values = product(delta, weights.transposed());
                    input_gradient = Some(Tensor::from_vec(values, (rows, before), &Device::Cpu)?);
                }
            } else {
                let mut previous = product(delta, weights.transposed());
                for (error, output) in previous.iter_mut().zip(from) {
                    *error = if *output > 0.0 { *error } else { 0.0 };
                }
                errors = previous;
            }
        }
        let parameter_gradient = if self.for_parameters() {
            let count = parameter_gradient.len();
            Some(Tensor::from_vec(parameter_gradient, count, &Device::Cpu)?)
        } else {
            None
        };
        Ok((input_gradient, parameter_gradient))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use candle_core::DType;
    use rand::SeedableRng;
    use rand_xoshiro::Xoshiro256PlusPlus;

    const SIZES: [usize; 4] = [5, 33, 17, 3];

    fn network_and_inputs() -> (Mlp, Var) {
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(7);
        let mlp = Mlp::random(&SIZES, &mut rng).unwrap();
        let mut uniform = |count: usize| (0..count).map(|_| rng.random_range(-0.5f32..0.5)).collect::<Vec<_>>();
        let (parameters, inputs) = (uniform(mlp.parameters().elem_count()), uniform(11 * 5));
        (Mlp::from_parameters(&SIZES, parameters).unwrap(), Var::from_vec(inputs, (11, 5), &Device::Cpu).unwrap())
    }

    /// The same network out of candle's own operations.
    fn plain_forward(parameters: &Tensor, inputs: &Tensor) -> Result<Tensor> {
        let (mut values, mut start) = (inputs.clone(), 0);
        for (index, pair) in SIZES.windows(2).enumerate() {
            let weights = parameters.narrow(0, start, pair[0] * pair[1])?.reshape((pair[0], pair[1]))?;
            let bias = parameters.narrow(0, start + pair[0] * pair[1], pair[1])?;
            values = values.matmul(&weights)?.broadcast_add(&bias)?;
            values = if index + 2 < SIZES.len() { values.relu()? } else { values };
            start += (pair[0] + 1) * pair[1];
        }
        Ok(values)
    }

    fn largest_difference(a: &Tensor, b: &Tensor) -> f32 {
        a.sub(b).unwrap().abs().unwrap().flatten_all().unwrap().max(0).unwrap().to_scalar().unwrap()
    }

    #[test]
    fn outputs_and_gradients_agree_with_candles_own_operations() {
        let (mlp, inputs) = network_and_inputs();
        let fused = mlp.forward(&inputs).unwrap();
        let plain = plain_forward(mlp.parameters(), &inputs).unwrap();
        assert!(largest_difference(&fused, &plain) < 1e-5);
        let loss = |outputs: &Tensor| outputs.sin().unwrap().sum_all().unwrap().backward().unwrap();
        let (fused, plain) = (loss(&fused), loss(&plain));
        for variable in [mlp.parameters(), &inputs] {
            assert!(largest_difference(fused.get(variable).unwrap(), plain.get(variable).unwrap()) < 1e-5);
        }
    }

    #[test]
    fn gradients_agree_with_finite_differences() {
        let (mlp, inputs) = network_and_inputs();
        let loss = |inputs: &Tensor| mlp.forward(inputs).unwrap().sqr().unwrap().sum_all().unwrap();
        let gradients = loss(&inputs).backward().unwrap();
        let gradient: Vec<f32> = gradients.get(&inputs).unwrap().flatten_all().unwrap().to_vec1().unwrap();
        for (index, slope) in gradient.iter().enumerate().step_by(7) {
            let moved = |step: f32| -> f32 {
                let mut values: Vec<f32> = inputs.flatten_all().unwrap().to_vec1().unwrap();
                values[index] += step;
                loss(&Tensor::from_vec(values, (11, 5), &Device::Cpu).unwrap()).to_scalar().unwrap()
            };
            let difference = (moved(1e-2) - moved(-1e-2)) / 2e-2;
            assert!((difference - slope).abs() < 1e-2 * (1.0 + slope.abs()), "{difference} against {slope}");
        }
    }

    #[test]
    fn a_record_gives_the_gradients_that_are_wanted_and_no_others() {
        let (mlp, inputs) = network_and_inputs();
        let outputs = mlp.forward(&inputs).unwrap();
        let gradients = outputs.sum_all().unwrap().backward().unwrap();
        let ones = outputs.ones_like().unwrap();
        for wanted in [Wanted::Inputs, Wanted::Parameters, Wanted::Both] {
            let record = mlp.record(&inputs, wanted).unwrap();
            let (for_inputs, for_parameters) = record.backward(&ones).unwrap();
            assert_eq!(for_inputs.is_some(), wanted != Wanted::Parameters);
            assert_eq!(for_parameters.is_some(), wanted != Wanted::Inputs);
            for (ours, variable) in [(for_inputs, &inputs), (for_parameters, mlp.parameters())] {
                let theirs = gradients.get(variable).unwrap();
                assert!(ours.is_none_or(|ours| largest_difference(&ours, theirs) == 0.0));
            }
        }
    }

    #[test]
    fn the_same_seed_gives_the_same_network() {
        let network = |seed| {
            let mlp = Mlp::random(&SIZES, &mut Xoshiro256PlusPlus::seed_from_u64(seed)).unwrap();
            mlp.parameters().to_vec1::<f32>().unwrap()
        };
        assert_eq!(network(1), network(1));
        assert_ne!(network(1), network(2));
    }

    #[test]
    fn a_wrong_number_of_parameters_or_inputs_is_refused() {
        assert!(Mlp::from_parameters(&[2, 3], vec![0.0; 8]).unwrap_err().to_string().contains('9'));
        let (mlp, _) = network_and_inputs();
        assert!(mlp.forward(&Tensor::zeros((2, 4), DType::F32, &Device::Cpu).unwrap()).is_err());
    }
}
