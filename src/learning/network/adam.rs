//! The Adam optimiser with its own, visible state, and the soft update of target networks; both in place.

use candle_core::{CpuStorage, DType, Device, InplaceOp2, InplaceOp3, Layout, Result, Tensor, Var, bail};
use pulp::Arch;

use super::tensors::{stored_values, values};

/// Adam (Kingma and Ba 2015) for one flat variable.
///
/// candle's own `AdamW` keeps its moments private, so that a run could not be resumed exactly.
#[derive(Debug)]
pub struct Adam {
    /// Decaying averages of the gradient and of its square.
    moments: [Tensor; 2],
    steps: u32,
}

const BETA: [f32; 2] = [0.9, 0.999];
/// Keeps the step finite where a gradient has always been zero.
const EPSILON: f32 = 1e-8;

impl Adam {
    /// An optimiser for `count` parameters that has not taken a step.
    ///
    /// # Errors
    /// Whatever candle reports.
    pub fn new(count: usize) -> Result<Self> {
        let zeros = || Tensor::zeros(count, DType::F32, &Device::Cpu);
        Ok(Self { moments: [zeros()?, zeros()?], steps: 0 })
    }

    /// An optimiser that continues from what [`Adam::state`] gave.
    ///
    /// # Errors
    /// Where the two moments differ in length.
    pub fn from_state(moments: [Vec<f32>; 2], steps: u32) -> Result<Self> {
        if moments[0].len() != moments[1].len() {
            bail!("the optimiser's moments have {} and {} values", moments[0].len(), moments[1].len());
        }
        let [first, second] = moments.map(|moment| {
            let count = moment.len();
            Tensor::from_vec(moment, count, &Device::Cpu)
        });
        Ok(Self { moments: [first?, second?], steps })
    }

    /// The decaying averages of the gradient and its square, and the number of steps taken.
    pub const fn state(&self) -> (&[Tensor; 2], u32) {
        (&self.moments, self.steps)
    }

    /// Moves `parameters` one step down `gradient`, whose norm is first limited to `clip`.
    ///
    /// # Errors
    /// Where the lengths differ.
    pub fn step(&mut self, parameters: &Var, gradient: &Tensor, learning_rate: f64, clip: f64) -> Result<()> {
        let norm = norm(gradient)?;
        // Such a step would destroy the network.
        if !norm.is_finite() {
            bail!("the gradient is not finite: the learning rate {learning_rate} may be too high");
        }
        let scale = (clip / norm).min(1.0) as f32;
        self.steps += 1;
        let correction = BETA.map(|beta| 1.0 - f64::from(beta).powi(self.steps.cast_signed()));
        let [first, second] = &self.moments;
        first.inplace_op2(gradient, &Blend { keep: BETA[0], scale, squared: false })?;
        second.inplace_op2(gradient, &Blend { keep: BETA[1], scale, squared: true })?;
        let rate = (learning_rate / correction[0]) as f32;
        parameters.inplace_op3(first, second, &Descend { rate, unbias: (1.0 / correction[1]) as f32 })
    }
}

/// Moves the target network's parameters the fraction `rate` of the way to the online network's (Polyak averaging).
///
/// # Errors
/// Where the lengths differ.
pub fn soft_update(target: &Var, online: &Var, rate: f64) -> Result<()> {
    target.inplace_op2(online.as_tensor(), &Blend { keep: (1.0 - rate) as f32, scale: 1.0, squared: false })
}

fn norm(tensor: &Tensor) -> Result<f64> {
    let (storage, layout) = tensor.storage_and_layout();
    let (chunks, rest) = stored_values(&storage, layout)?.as_chunks::<16>();
    // Sixteen sums at a time, which the processor can add side by side.
    let mut sums = [0.0f32; 16];
    for chunk in chunks {
        for (sum, x) in sums.iter_mut().zip(chunk) {
            *sum += x * x;
        }
    }
    let total: f64 = sums.into_iter().chain(rest.iter().map(|x| x * x)).map(f64::from).sum();
    Ok(total.sqrt())
}

/// `x <- keep x + (1 - keep) y`, where y is `scale` times the other tensor, or the square of that.
struct Blend {
    keep: f32,
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
        let Self { keep, scale, squared } = *self;
        // Dispatched so that the loops are compiled for the wide registers of the processor at hand.
        Arch::new().dispatch(|| {
            if squared {
                for (x, y) in to.iter_mut().zip(from) {
                    let y = scale * y;
                    *x = keep * *x + (1.0 - keep) * y * y;
                }
            } else {
                for (x, y) in to.iter_mut().zip(from) {
                    *x = keep * *x + (1.0 - keep) * scale * y;
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
    use candle_nn::{AdamW, Optimizer, ParamsAdamW};

    fn variable(values: &[f32]) -> Var {
        Var::new(values, &Device::Cpu).unwrap()
    }

    #[test]
    fn a_hundred_steps_agree_with_candles_own_optimiser_without_weight_decay() {
        let start = [0.5f32, -1.0, 2.0, 0.0, 3.0];
        let (ours, theirs) = (variable(&start), variable(&start));
        let mut adam = Adam::new(start.len()).unwrap();
        let settings = ParamsAdamW { lr: 0.01, weight_decay: 0.0, ..ParamsAdamW::default() };
        let mut reference = AdamW::new(vec![theirs.clone()], settings).unwrap();
        let loss = |x: &Var| (x.sin().unwrap() + x.sqr().unwrap()).unwrap().sum_all().unwrap();
        for _ in 0..100 {
            let gradients = loss(&ours).backward().unwrap();
            adam.step(&ours, gradients.get(&ours).unwrap(), 0.01, f64::INFINITY).unwrap();
            reference.backward_step(&loss(&theirs)).unwrap();
        }
        let (ours, theirs) = (ours.to_vec1::<f32>().unwrap(), theirs.to_vec1::<f32>().unwrap());
        for (a, b) in ours.iter().zip(theirs) {
            assert!((a - b).abs() < 1e-5, "{a} against {b}");
        }
    }

    #[test]
    fn a_gradient_that_is_not_a_number_is_refused_before_it_does_harm() {
        let parameters = variable(&[1.0, 2.0]);
        let gradient = Tensor::new(&[f32::NAN, 0.0], &Device::Cpu).unwrap();
        assert!(Adam::new(2).unwrap().step(&parameters, &gradient, 0.01, 1.0).is_err());
        assert_eq!(parameters.to_vec1::<f32>().unwrap(), [1.0, 2.0]);
    }

    #[test]
    fn a_soft_update_goes_its_fraction_of_the_way() {
        let (target, online) = (variable(&[0.0, 1.0]), variable(&[1.0, 1.0]));
        soft_update(&target, &online, 0.25).unwrap();
        assert_eq!(target.to_vec1::<f32>().unwrap(), [0.25, 1.0]);
    }
}
