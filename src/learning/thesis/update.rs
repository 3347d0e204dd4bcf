//! One update of a plain actor and critic (thesis Algorithm 4) as a single candle operation, in place.
//!
//! An update of networks as small as the thesis' is some twenty thousand multiplications a layer; candle's dispatch, its
//! allocations and passes over memory then take ten times as long as the arithmetic. Here everything that changes lies in
//! one flat candle tensor, and one operation on it does the critic's step, the actor's step, both optimisers and both
//! soft updates, through buffers that are kept: nothing is allocated.

use std::cell::RefCell;

use candle_core::{CpuStorage, InplaceOp1, Layout, Result, bail};
use pulp::Arch;
use serde::{Deserialize, Serialize};

use super::{
    kernels::Rows,
    pass::{MOST_INPUTS, Pass},
};
use crate::learning::network::pass::parameter_count;

/// Parts of the flat tensor, in this order, each the actor's and then the critic's: parameters, target parameters, and
/// the optimiser's averages of the gradient and of its square.
pub const PARTS: usize = 4;

/// Adam's decay rates and the number that keeps its step finite (Kingma and Ba 2015).
const BETA: [f32; 2] = [0.9, 0.999];
const EPSILON: f32 = 1e-8;

/// Layer sizes of both networks, inputs first.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Sizes {
    /// From the state to the action.
    pub actor: Vec<usize>,
    /// From the state and the action to one value.
    pub critic: Vec<usize>,
}

impl Sizes {
    /// Networks with the given hidden layers.
    pub fn new(states: usize, actions: usize, actor: &[usize], critic: &[usize]) -> Self {
        let whole = |first, hidden: &[usize], last| [&[first], hidden, &[last]].concat();
        Self { actor: whole(states, actor, actions), critic: whole(states + actions, critic, 1) }
    }

    /// Numbers of a state.
    pub fn states(&self) -> usize {
        self.actor[0]
    }

    /// Numbers of an action.
    pub fn actions(&self) -> usize {
        self.actor[self.actor.len() - 1]
    }

    /// Parameters of the actor and of the critic.
    pub fn parameters(&self) -> [usize; 2] {
        [parameter_count(&self.actor), parameter_count(&self.critic)]
    }

    /// Values of the flat tensor.
    pub fn values(&self) -> usize {
        PARTS * self.parameters().iter().sum::<usize>()
    }
}

/// How to learn (thesis Table 4; the networks' example gives the clipping).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Rates {
    /// Adam's learning rate for both networks.
    pub learning_rate: f64,
    /// What a reward one shot later is worth now.
    pub discount: f64,
    /// The part k of the target networks that a soft update keeps (equation 59).
    pub keep: f64,
    /// Longest gradient that is not shortened.
    pub gradient_clip: f64,
}

/// Transitions to learn from.
#[derive(Clone, Debug)]
pub struct Batch {
    /// States and the actions that were taken in them (rows x (states + actions)).
    pub inputs: Vec<f32>,
    /// What they earned.
    pub rewards: Vec<f32>,
    /// One where the episode went on, nought where it was over.
    pub goes_on: Vec<f32>,
    /// The states thereafter, as `inputs`; the update itself writes the target actor's actions.
    pub next_inputs: Vec<f32>,
}

impl Batch {
    /// Room for `rows` transitions between states and actions of the given sizes.
    pub fn new(sizes: &Sizes, rows: usize) -> Self {
        let inputs = vec![0.0; rows * sizes.critic[0]];
        Self { next_inputs: inputs.clone(), inputs, rewards: vec![0.0; rows], goes_on: vec![0.0; rows] }
    }
}

/// What an update saw.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BatchStats {
    /// Mean squared error of the critic before its step.
    pub loss: f64,
    /// Mean value that the critic, after its step, gives to the actor's actions before the actor's.
    pub value: f64,
}

/// Everything an update writes to on its way, kept from one to the next.
#[derive(Debug)]
pub struct Workspace {
    sizes: Sizes,
    actor: Pass,
    critic: Pass,
    /// The batch's states with the actor's own actions.
    proposed: Vec<f32>,
    values: Vec<f32>,
    wanted: Vec<f32>,
    errors: Vec<f32>,
    action_errors: Vec<f32>,
    gradients: [Vec<f32>; 2],
}

impl Workspace {
    /// Room for networks of the given sizes and batches of `rows`.
    ///
    /// # Errors
    /// Where the sizes do not belong to an actor and its critic.
    pub fn new(sizes: &Sizes, rows: usize) -> Result<Self> {
        let Sizes { actor, critic } = sizes;
        let fit = actor.len() > 1 && critic.len() > 1 && critic[critic.len() - 1] == 1;
        if !fit || critic[0] != sizes.states() + sizes.actions() || sizes.actions() > MOST_INPUTS || rows == 0 {
            bail!("layers {actor:?} and {critic:?} with batches of {rows} are no actor with a critic of its actions");
        }
        let column = vec![0.0; rows];
        Ok(Self {
            actor: Pass::new(actor, rows),
            critic: Pass::new(critic, rows),
            proposed: vec![0.0; rows * critic[0]],
            action_errors: vec![0.0; rows * sizes.actions()],
            gradients: sizes.parameters().map(|count| vec![0.0; count]),
            values: column.clone(),
            wanted: column.clone(),
            errors: column,
            sizes: sizes.clone(),
        })
    }

    /// One update of everything in `state`; `steps` is the number of updates up to and including this one.
    fn update(&mut self, state: &mut [f32], batch: &mut Batch, rates: &Rates, steps: u32) -> Result<BatchStats> {
        let rows = self.values.len();
        if batch.rewards.len() != rows || state.len() != self.sizes.values() {
            bail!("this workspace is for batches of {rows} and states of {} values", self.sizes.values());
        }
        let [actor_count, critic_count] = self.sizes.parameters();
        let (parameters, rest) = state.split_at_mut(actor_count + critic_count);
        let (targets, rest) = rest.split_at_mut(actor_count + critic_count);
        let (first, second) = rest.split_at_mut(actor_count + critic_count);
        let (actor, critic) = parameters.split_at_mut(actor_count);
        let (actor_target, critic_target) = targets.split_at_mut(actor_count);
        let (actor_first, critic_first) = first.split_at_mut(actor_count);
        let (actor_second, critic_second) = second.split_at_mut(actor_count);

        self.write_wanted(actor_target, critic_target, batch, rates.discount as f32);
        let loss = self.critic_gradient(critic, batch);
        let descent = Descent::new(&self.gradients[1], rates, steps)?;
        descent.step(&self.gradients[1], critic, critic_target, [critic_first, critic_second]);
        let value = self.actor_gradient(actor, critic, batch);
        let descent = Descent::new(&self.gradients[0], rates, steps)?;
        descent.step(&self.gradients[0], actor, actor_target, [actor_first, actor_second]);
        Ok(BatchStats { loss, value })
    }

    /// What the critic should have said: the reward and, where the episode went on, the discounted value of the target
    /// actor's action thereafter in the target critic's eyes (the target of equation 57 with equation 58). The target
    /// networks are not asked where every episode of the batch was over.
    fn write_wanted(&mut self, actor: &[f32], critic: &[f32], batch: &mut Batch, discount: f32) {
        self.wanted.copy_from_slice(&batch.rewards);
        if batch.goes_on.iter().all(|goes_on| *goes_on == 0.0) {
            return;
        }
        let (states, width) = (self.sizes.states(), self.sizes.critic[0]);
        self.proposed.copy_from_slice(&batch.next_inputs);
        let inputs = Rows::new(&batch.next_inputs, width).first(states);
        self.actor.forward(actor, inputs, &mut self.proposed[states..], width);
        self.critic.forward(critic, Rows::new(&self.proposed, width), &mut self.values, 1);
        for ((wanted, value), goes_on) in self.wanted.iter_mut().zip(&self.values).zip(&batch.goes_on) {
            *wanted += discount * goes_on * value;
        }
    }

    /// Leaves the gradient of the critic's mean squared error; returns that error.
    fn critic_gradient(&mut self, critic: &[f32], batch: &Batch) -> f64 {
        let inputs = Rows::new(&batch.inputs, self.sizes.critic[0]);
        self.critic.forward(critic, inputs, &mut self.values, 1);
        let rows = self.values.len() as f32;
        let mut loss = 0.0;
        for ((error, value), wanted) in self.errors.iter_mut().zip(&self.values).zip(&self.wanted) {
            let off = value - wanted;
            loss += f64::from(off * off);
            *error = 2.0 * off / rows;
        }
        self.critic.backward(critic, inputs, &self.errors, &mut self.gradients[1]);
        loss / f64::from(rows)
    }

    /// Leaves the deterministic policy gradient, downhill: the actor climbs the critic. Returns the mean value of its
    /// actions.
    fn actor_gradient(&mut self, actor: &[f32], critic: &[f32], batch: &Batch) -> f64 {
        let (states, width) = (self.sizes.states(), self.sizes.critic[0]);
        let inputs = Rows::new(&batch.inputs, width).first(states);
        self.proposed.copy_from_slice(&batch.inputs);
        self.actor.forward(actor, inputs, &mut self.proposed[states..], width);
        self.critic.forward(critic, Rows::new(&self.proposed, width), &mut self.values, 1);
        let rows = self.values.len() as f32;
        self.errors.fill(-1.0 / rows);
        self.critic.backward_to_inputs(critic, &self.errors, states, &mut self.action_errors);
        self.actor.backward(actor, inputs, &self.action_errors, &mut self.gradients[0]);
        self.values.iter().map(|value| f64::from(*value)).sum::<f64>() / f64::from(rows)
    }
}

/// A step of Adam and the soft update that follows it.
struct Descent {
    /// Shortens a gradient that is too long.
    scale: f32,
    rate: f32,
    unbias: f32,
    keep: f32,
}

impl Descent {
    fn new(gradient: &[f32], rates: &Rates, steps: u32) -> Result<Self> {
        let norm = norm(gradient);
        // Such a step would destroy the network.
        if !norm.is_finite() {
            bail!("the gradient is not finite: the learning rate {} may be too high", rates.learning_rate);
        }
        let correction = BETA.map(|beta| 1.0 - f64::from(beta).powi(steps.cast_signed()));
        Ok(Self {
            scale: (rates.gradient_clip / norm).min(1.0) as f32,
            rate: (rates.learning_rate / correction[0]) as f32,
            unbias: (1.0 / correction[1]) as f32,
            keep: rates.keep as f32,
        })
    }

    /// One pass over memory for the averages, the parameters and their target.
    fn step(&self, gradient: &[f32], parameters: &mut [f32], target: &mut [f32], moments: [&mut [f32]; 2]) {
        let Self { scale, rate, unbias, keep } = *self;
        let [first, second] = moments;
        Arch::new().dispatch(|| {
            for ((((g, x), t), m), v) in gradient.iter().zip(parameters).zip(target).zip(first).zip(second) {
                let g = scale * g;
                *m = BETA[0] * *m + (1.0 - BETA[0]) * g;
                *v = BETA[1] * *v + (1.0 - BETA[1]) * g * g;
                *x -= rate * *m / ((unbias * *v).sqrt() + EPSILON);
                *t = keep * *t + (1.0 - keep) * *x;
            }
        });
    }
}

fn norm(values: &[f32]) -> f64 {
    let (chunks, rest) = values.as_chunks::<16>();
    let mut sums = [0.0f32; 16];
    Arch::new().dispatch(|| {
        for chunk in chunks {
            for (sum, x) in sums.iter_mut().zip(chunk) {
                *sum += x * x;
            }
        }
    });
    sums.into_iter().chain(rest.iter().map(|x| x * x)).map(f64::from).sum::<f64>().sqrt()
}

/// The update as candle meets it.
pub(super) struct Update<'a> {
    rates: &'a Rates,
    steps: u32,
    /// What is written to; candle hands operations out as shared references.
    inner: RefCell<(&'a mut Workspace, &'a mut Batch, BatchStats)>,
}

impl<'a> Update<'a> {
    /// Update number `steps`, the first being 1.
    pub fn new(workspace: &'a mut Workspace, batch: &'a mut Batch, rates: &'a Rates, steps: u32) -> Self {
        Self { rates, steps, inner: RefCell::new((workspace, batch, BatchStats::default())) }
    }

    /// What it saw, once it has run.
    pub fn seen(self) -> BatchStats {
        self.inner.into_inner().2
    }
}

impl InplaceOp1 for Update<'_> {
    fn name(&self) -> &'static str {
        "ddpg-update"
    }

    fn cpu_fwd(&self, storage: &mut CpuStorage, layout: &Layout) -> Result<()> {
        let (Some((start, end)), CpuStorage::F32(values)) = (layout.contiguous_offsets(), storage) else {
            bail!("this operation takes contiguous f32 tensors only")
        };
        let (workspace, batch, seen) = &mut *self.inner.borrow_mut();
        *seen = workspace.update(&mut values[start..end], batch, self.rates, self.steps)?;
        Ok(())
    }
}
