//! Multi-layer perceptrons with flat parameters and seeded initialisation.

use candle_core::{CustomOp2, Device, Result, Tensor, Var, bail};
use rand::{Rng, RngExt};

use super::pass::{Pass, Wanted, parameter_count};

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
        let pass = Pass::new(&self.sizes, Some(wanted));
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
        inputs.apply_op2(parameters, Pass::new(&self.sizes, wanted))
    }
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
