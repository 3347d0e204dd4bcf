//! Multi-layer perceptrons with flat parameters and seeded initialisation.

use candle_core::{Device, Result, Tensor, Var, bail};
use candle_nn::{Linear, Module};
use rand::{Rng, RngExt};

use super::fused::Fused;

/// Implementation of a network's passes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Operations {
    /// The whole network as one operation, [`Fused`].
    #[default]
    Fused,
    /// Layer by layer with candle's own operations: equal up to rounding, and slower. (Numbers that are not finite may propagate
    /// differently in the fused operation; a training with such numbers stops anyway because of its loss.)
    Plain,
}

/// A network of dense layers with rectified linear units between them and a linear output.
///
/// One flat variable contains all weights and biases, layer by layer: the weight matrix (inputs x outputs, row-major), then the bias.
/// The optimiser, the target update and a checkpoint then handle one tensor per network.
#[derive(Clone, Debug)]
pub struct Mlp {
    sizes: Vec<usize>,
    parameters: Var,
    operations: Operations,
}

/// Number of weights and biases of a network with layer sizes `sizes`, inputs first.
pub fn parameter_count(sizes: &[usize]) -> usize {
    sizes.windows(2).map(|pair| (pair[0] + 1) * pair[1]).sum()
}

impl Mlp {
    /// Creates a network with the given layer sizes, inputs first, drawn from `rng`. Weights are uniform within ±sqrt(6 / inputs)
    /// (He), those of the last layer within a hundredth of that, so that training starts with outputs near zero. Biases
    /// are zero. candle's own generator cannot be seeded on a CPU.
    pub fn random(sizes: &[usize], rng: &mut (impl Rng + ?Sized)) -> Result<Self> {
        Self::uniform(sizes, rng, |layer, [inputs, _]| {
            let shrink = if layer + 2 == sizes.len() { 0.01 } else { 1.0 };
            shrink * (6.0 / inputs).sqrt()
        })
    }

    /// Creates a network with weights uniform within ±sqrt(6 / (inputs + outputs)) (Glorot and Bengio 2010), the default of Keras.
    pub fn glorot(sizes: &[usize], rng: &mut (impl Rng + ?Sized)) -> Result<Self> {
        Self::uniform(sizes, rng, |_, [inputs, outputs]| (6.0 / (inputs + outputs)).sqrt())
    }

    /// Draws weights uniformly within their layer's bound, a function of its index, inputs and outputs. Biases are zero.
    fn uniform(sizes: &[usize], rng: &mut (impl Rng + ?Sized), bound: impl Fn(usize, [f32; 2]) -> f32) -> Result<Self> {
        let mut parameters = Vec::with_capacity(parameter_count(sizes));
        for (layer, pair) in sizes.windows(2).enumerate() {
            let bound = bound(layer, [pair[0] as f32, pair[1] as f32]);
            parameters.extend((0..pair[0] * pair[1]).map(|_| rng.random_range(-bound..=bound)));
            parameters.resize(parameters.len() + pair[1], 0.0);
        }
        Self::from_parameters(sizes, parameters)
    }

    /// Creates a network with the given parameters.
    pub fn from_parameters(sizes: &[usize], parameters: Vec<f32>) -> Result<Self> {
        let count = parameter_count(sizes);
        if parameters.len() != count {
            bail!("a network of sizes {sizes:?} has {count} parameters, not {}", parameters.len());
        }
        let parameters = Var::from_vec(parameters, count, &Device::Cpu)?;
        Ok(Self { sizes: sizes.to_vec(), parameters, operations: Operations::default() })
    }

    /// Returns a network with its own copy of the parameters.
    pub fn duplicate(&self) -> Result<Self> {
        Ok(Self::from_parameters(&self.sizes, self.parameters.to_vec1()?)?.with_operations(self.operations))
    }

    /// Returns this network with other operations.
    #[must_use]
    pub fn with_operations(self, operations: Operations) -> Self {
        Self { operations, ..self }
    }

    /// Returns this network with another bias in its last layer.
    pub fn with_output_bias(self, bias: &[f32]) -> Result<Self> {
        let mut parameters: Vec<f32> = self.parameters.to_vec1()?;
        let outputs = self.sizes[self.sizes.len() - 1];
        if bias.len() != outputs {
            bail!("a bias of {} values does not fit {outputs} outputs", bias.len());
        }
        let start = parameters.len() - outputs;
        parameters[start..].copy_from_slice(bias);
        Ok(Self::from_parameters(&self.sizes, parameters)?.with_operations(self.operations))
    }

    /// Returns this network with `count` more inputs, inserted after the first `after` inputs. Their weights are zero, so the outputs
    /// do not change.
    pub fn with_more_inputs(self, after: usize, count: usize) -> Result<Self> {
        let mut parameters: Vec<f32> = self.parameters.to_vec1()?;
        let mut sizes = self.sizes;
        if after > sizes[0] {
            bail!("inputs cannot be inserted after input {after} of {}", sizes[0]);
        }
        let at = after * sizes[1];
        parameters.splice(at..at, std::iter::repeat_n(0.0, count * sizes[1]));
        sizes[0] += count;
        Ok(Self::from_parameters(&sizes, parameters)?.with_operations(self.operations))
    }

    /// Layer sizes, inputs first.
    pub fn sizes(&self) -> &[usize] {
        &self.sizes
    }

    /// The flat parameters.
    pub const fn parameters(&self) -> &Var {
        &self.parameters
    }

    /// Computes [`Module::forward`] without gradients for the parameters.
    pub fn forward_frozen(&self, inputs: &Tensor) -> Result<Tensor> {
        self.apply(inputs, &self.parameters.as_detached_tensor())
    }

    fn apply(&self, inputs: &Tensor, parameters: &Tensor) -> Result<Tensor> {
        match self.operations {
            Operations::Fused => {
                let gradients = [inputs.track_op(), parameters.track_op()];
                inputs.apply_op2(parameters, Fused::new(&self.sizes, gradients))
            }
            Operations::Plain => self.apply_layers(inputs, parameters),
        }
    }

    fn apply_layers(&self, inputs: &Tensor, parameters: &Tensor) -> Result<Tensor> {
        let (mut values, mut start) = (inputs.clone(), 0);
        for (index, pair) in self.sizes.windows(2).enumerate() {
            let weights = parameters.narrow(0, start, pair[0] * pair[1])?.reshape((pair[0], pair[1]))?;
            let bias = parameters.narrow(0, start + pair[0] * pair[1], pair[1])?;
            let layer = Linear::new(weights.t()?, Some(bias));
            if index > 0 {
                values = values.relu()?;
            }
            values = layer.forward(&values)?;
            start += (pair[0] + 1) * pair[1];
        }
        Ok(values)
    }
}

impl Module for Mlp {
    /// Outputs (rows x outputs) for inputs (rows x inputs); gradients flow to the parameters and to the inputs.
    fn forward(&self, inputs: &Tensor) -> Result<Tensor> {
        self.apply(inputs, self.parameters.as_tensor())
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

    fn largest_difference(a: &Tensor, b: &Tensor) -> f32 {
        a.sub(b).unwrap().abs().unwrap().flatten_all().unwrap().max(0).unwrap().to_scalar().unwrap()
    }

    #[test]
    fn outputs_and_gradients_agree_with_candle() {
        let (mlp, inputs) = network_and_inputs();
        let fused = mlp.forward(&inputs).unwrap();
        let plain = mlp.clone().with_operations(Operations::Plain).forward(&inputs).unwrap();
        assert!(largest_difference(&fused, &plain) < 1e-5);
        let loss = |outputs: &Tensor| outputs.sin().unwrap().sum_all().unwrap().backward().unwrap();
        let (fused, plain) = (loss(&fused), loss(&plain));
        for variable in [mlp.parameters(), &inputs] {
            assert!(largest_difference(fused.get(variable).unwrap(), plain.get(variable).unwrap()) < 1e-5);
        }
    }

    #[test]
    fn added_inputs_start_without_effect() {
        let (mlp, inputs) = network_and_inputs();
        let wide = mlp.duplicate().unwrap().with_more_inputs(2, 4).unwrap();
        assert_eq!(wide.sizes(), [9, 33, 17, 3]);
        let others = Tensor::ones((11, 4), DType::F32, &Device::Cpu).unwrap();
        let [before, after] = [(0, 2), (2, 3)].map(|(start, count)| inputs.narrow(1, start, count).unwrap());
        let joined = Tensor::cat(&[&before, &others, &after], 1).unwrap().contiguous().unwrap();
        assert!(largest_difference(&mlp.forward(&inputs).unwrap(), &wide.forward(&joined).unwrap()) < 1e-6);
        assert!(mlp.with_more_inputs(6, 1).is_err());
    }

    #[test]
    fn frozen_networks_pass_gradients_only_to_inputs() {
        for operations in [Operations::Fused, Operations::Plain] {
            let (mlp, inputs) = network_and_inputs();
            let mlp = mlp.with_operations(operations);
            let slopes = |outputs: &Tensor| outputs.sum_all().unwrap().backward().unwrap();
            let (frozen, free) =
                (slopes(&mlp.forward_frozen(&inputs).unwrap()), slopes(&mlp.forward(&inputs).unwrap()));
            assert!(frozen.get(mlp.parameters()).is_none() && free.get(mlp.parameters()).is_some());
            assert_eq!(largest_difference(frozen.get(&inputs).unwrap(), free.get(&inputs).unwrap()), 0.0);
        }
    }

    #[test]
    fn a_wrong_number_of_parameters_or_inputs_is_refused() {
        assert!(Mlp::from_parameters(&[2, 3], vec![0.0; 8]).unwrap_err().to_string().contains('9'));
        let (mlp, _) = network_and_inputs();
        assert!(mlp.forward(&Tensor::zeros((2, 4), DType::F32, &Device::Cpu).unwrap()).is_err());
    }
}
