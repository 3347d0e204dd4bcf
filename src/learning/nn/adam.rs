//! The Adam optimiser with a readable state, and the soft update of target networks; both work in place.

use candle_core::{CpuStorage, InplaceOp2, InplaceOp3, Layout, Result, Tensor, Var, backprop::GradStore, bail};
use candle_nn::Optimizer;
use pulp::Arch;

use super::{stored_values, values};

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AdamConfig {
    pub learning_rate: f64,
    /// Largest norm of the gradient over all variables; a longer gradient is scaled down to it.
    pub max_grad_norm: f64,
}

/// Adam (Kingma and Ba 2015).
///
/// candle's own `AdamW` does not clip and keeps its moments private, so a run could not be resumed exactly.
#[derive(Debug)]
pub struct Adam {
    variables: Vec<Var>,
    /// Decaying averages of each variable's gradient and of its square.
    moments: Vec<[Tensor; 2]>,
    config: AdamConfig,
    steps: u32,
}

const BETA: [f32; 2] = [0.9, 0.999];
/// Keeps the step finite where a gradient has always been zero.
const EPSILON: f32 = 1e-8;

impl Adam {
    /// Creates an optimiser that continues from the values of [`Adam::moments`] and [`Adam::steps`].
    pub const fn resume(variables: Vec<Var>, config: AdamConfig, moments: Vec<[Tensor; 2]>, steps: u32) -> Self {
        Self { variables, moments, config, steps }
    }

    /// The decaying averages of each variable's gradient and its square.
    pub fn moments(&self) -> &[[Tensor; 2]] {
        &self.moments
    }

    pub const fn steps(&self) -> u32 {
        self.steps
    }
}

impl Optimizer for Adam {
    type Config = AdamConfig;

    fn new(variables: Vec<Var>, config: AdamConfig) -> Result<Self> {
        let zeros = |variable: &Var| Ok([variable.zeros_like()?, variable.zeros_like()?]);
        let moments = variables.iter().map(zeros).collect::<Result<_>>()?;
        Ok(Self { variables, moments, config, steps: 0 })
    }

    /// Moves the variables one step down their gradients. Variables without a gradient stay unchanged.
    fn step(&mut self, gradients: &GradStore) -> Result<()> {
        let found: Vec<_> = self
            .variables
            .iter()
            .zip(&self.moments)
            .filter_map(|(variable, moments)| Some((variable, moments, gradients.get(variable)?)))
            .collect();
        let length = found.iter().map(|(.., gradient)| squares(gradient)).sum::<Result<f64>>()?.sqrt();
        let AdamConfig { learning_rate, max_grad_norm } = self.config;
        // A step with such a gradient would destroy the network.
        if !length.is_finite() {
            bail!(
                "the gradient is not finite: the learning rate {learning_rate} may be too high; start a new run with a lower one"
            );
        }
        let scale = (max_grad_norm / length).min(1.0) as f32;
        self.steps += 1;
        let correction = BETA.map(|beta| 1.0 - f64::from(beta).powi(self.steps.cast_signed()));
        let descend = Descend { rate: (learning_rate / correction[0]) as f32, unbias: (1.0 / correction[1]) as f32 };
        for (variable, [first, second], gradient) in found {
            first.inplace_op2(gradient, &Blend { decay: BETA[0], scale, squared: false })?;
            second.inplace_op2(gradient, &Blend { decay: BETA[1], scale, squared: true })?;
            variable.inplace_op3(first, second, &descend)?;
        }
        Ok(())
    }

    fn learning_rate(&self) -> f64 {
        self.config.learning_rate
    }

    fn set_learning_rate(&mut self, learning_rate: f64) {
        self.config.learning_rate = learning_rate;
    }
}

/// Moves the target network's parameters the fraction `tau` of the way to the online network's (Polyak averaging).
pub fn soft_update(target: &Var, online: &Var, tau: f64) -> Result<()> {
    target.inplace_op2(online.as_tensor(), &Blend { decay: (1.0 - tau) as f32, scale: 1.0, squared: false })
}

/// Sum of the squares of a tensor's values.
fn squares(tensor: &Tensor) -> Result<f64> {
    let (storage, layout) = tensor.storage_and_layout();
    let (chunks, rest) = stored_values(&storage, layout)?.as_chunks::<16>();
    // Sixteen partial sums, which the processor can add in parallel in wide registers.
    let mut sums = [0.0f32; 16];
    Arch::new().dispatch(|| {
        for chunk in chunks {
            for (sum, x) in sums.iter_mut().zip(chunk) {
                *sum += x * x;
            }
        }
    });
    Ok(sums.into_iter().chain(rest.iter().map(|x| x * x)).map(f64::from).sum())
}

/// `x <- decay x + (1 - decay) y`, where y is `scale` times the other tensor, or the square of that.
struct Blend {
    decay: f32,
    scale: f32,
    squared: bool,
}

impl InplaceOp2 for Blend {
    fn name(&self) -> &'static str {
        "blend"
    }

    fn cpu_fwd(&self, s1: &mut CpuStorage, l1: &Layout, s2: &CpuStorage, l2: &Layout) -> Result<()> {
        let (to, from) = (values_mut(s1, l1)?, values(s2, l2)?);
        same_length(to, from)?;
        let Self { decay, scale, squared } = *self;
        // Dispatched so that the loops are compiled for the wide registers of the processor in use.
        Arch::new().dispatch(|| {
            if squared {
                for (x, y) in to.iter_mut().zip(from) {
                    let y = scale * y;
                    *x = decay * *x + (1.0 - decay) * y * y;
                }
            } else {
                for (x, y) in to.iter_mut().zip(from) {
                    *x = decay * *x + (1.0 - decay) * scale * y;
                }
            }
        });
        Ok(())
    }
}

/// `x <- x - rate m / (sqrt(unbias v) + epsilon)`.
struct Descend {
    rate: f32,
    unbias: f32,
}

impl InplaceOp3 for Descend {
    fn name(&self) -> &'static str {
        "adam"
    }

    fn cpu_fwd(
        &self,
        s1: &mut CpuStorage,
        l1: &Layout,
        s2: &CpuStorage,
        l2: &Layout,
        s3: &CpuStorage,
        l3: &Layout,
    ) -> Result<()> {
        let (to, first, second) = (values_mut(s1, l1)?, values(s2, l2)?, values(s3, l3)?);
        same_length(to, first)?;
        let Self { rate, unbias } = *self;
        Arch::new().dispatch(|| {
            for ((x, m), v) in to.iter_mut().zip(first).zip(second) {
                *x -= rate * m / ((unbias * v).sqrt() + EPSILON);
            }
        });
        Ok(())
    }
}

fn values_mut<'a>(storage: &'a mut CpuStorage, layout: &Layout) -> Result<&'a mut [f32]> {
    match (layout.contiguous_offsets(), storage) {
        (Some((start, end)), CpuStorage::F32(values)) => Ok(&mut values[start..end]),
        _ => bail!("this operation takes contiguous f32 tensors only"),
    }
}

fn same_length(a: &[f32], b: &[f32]) -> Result<()> {
    if a.len() == b.len() { Ok(()) } else { bail!("{} values meet {}", a.len(), b.len()) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use candle_core::Device;
    use candle_nn::{AdamW, ParamsAdamW};

    fn variable(values: &[f32]) -> Var {
        Var::new(values, &Device::Cpu).unwrap()
    }

    const CONFIG: AdamConfig = AdamConfig { learning_rate: 0.01, max_grad_norm: f64::INFINITY };

    #[test]
    fn a_hundred_steps_agree_with_candles_optimiser() {
        let start = [0.5f32, -1.0, 2.0, 0.0, 3.0];
        let (ours, theirs) = (variable(&start), variable(&start));
        let mut adam = Adam::new(vec![ours.clone()], CONFIG).unwrap();
        let settings = ParamsAdamW { lr: 0.01, weight_decay: 0.0, ..ParamsAdamW::default() };
        let mut reference = AdamW::new(vec![theirs.clone()], settings).unwrap();
        let loss = |x: &Var| (x.sin().unwrap() + x.sqr().unwrap()).unwrap().sum_all().unwrap();
        for _ in 0..100 {
            adam.backward_step(&loss(&ours)).unwrap();
            reference.backward_step(&loss(&theirs)).unwrap();
        }
        let (ours, theirs) = (ours.to_vec1::<f32>().unwrap(), theirs.to_vec1::<f32>().unwrap());
        for (a, b) in ours.iter().zip(theirs) {
            assert!((a - b).abs() < 1e-5, "{a} against {b}");
        }
    }

    #[test]
    fn the_gradient_norm_is_clipped_over_all_variables() {
        let (x, y) = (variable(&[3.0]), variable(&[4.0]));
        let mut adam = Adam::new(vec![x.clone(), y.clone()], AdamConfig { max_grad_norm: 1.0, ..CONFIG }).unwrap();
        let loss = ((x.sqr().unwrap() + y.sqr().unwrap()).unwrap() * 0.5).unwrap().sum_all().unwrap();
        adam.backward_step(&loss).unwrap();
        // After one step the averages are a tenth of the gradient, whose length was five.
        let first: Vec<f32> = adam.moments().iter().map(|[first, _]| first.to_vec1::<f32>().unwrap()[0]).collect();
        assert!((first[0] - 0.06).abs() < 1e-6 && (first[1] - 0.08).abs() < 1e-6, "{first:?}");
    }

    #[test]
    fn a_soft_update_moves_by_its_rate() {
        let (target, online) = (variable(&[0.0, 1.0]), variable(&[1.0, 1.0]));
        soft_update(&target, &online, 0.25).unwrap();
        assert_eq!(target.to_vec1::<f32>().unwrap(), [0.25, 1.0]);
    }
}
