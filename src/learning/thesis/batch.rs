//! A batch of transitions as candle's tensors.

use candle_core::{Device, Result, Tensor};

use super::{
    environment::{ACTIONS, STATES},
    replay::StoredTransition,
};

/// Transitions to learn from, a row each.
#[derive(Clone, Debug)]
pub struct Batch {
    /// States (rows x states).
    pub states: Tensor,
    /// What was done in them (rows x actions).
    pub actions: Tensor,
    /// The same by number, for discrete actions (rows x 1, unsigned).
    pub indices: Tensor,
    /// What it earned (rows x 1).
    pub rewards: Tensor,
    /// What a value one shot later counts: `discount` where the episode went on, nought where it was over (rows x 1).
    pub discounts: Tensor,
    /// Whether any episode went on: else nobody asks for values one shot later.
    pub any_goes_on: bool,
    /// The states thereafter (rows x states).
    pub next_states: Tensor,
}

impl Batch {
    /// The batch of these transitions.
    ///
    /// # Errors
    /// Whatever candle reports.
    pub fn new(drawn: &[StoredTransition], discount: f64) -> Result<Self> {
        let rows = drawn.len();
        let matrix = |values: Vec<f32>, columns: usize| Tensor::from_vec(values, (rows, columns), &Device::Cpu);
        let discounts = drawn.iter().map(|drawn| if drawn.goes_on { discount as f32 } else { 0.0 });
        let indices = drawn.iter().map(|drawn| drawn.index).collect();
        Ok(Self {
            states: matrix(drawn.iter().flat_map(|drawn| drawn.state).collect(), STATES)?,
            actions: matrix(drawn.iter().flat_map(|drawn| drawn.action).collect(), ACTIONS)?,
            indices: Tensor::from_vec(indices, (rows, 1), &Device::Cpu)?,
            rewards: matrix(drawn.iter().map(|drawn| drawn.reward).collect(), 1)?,
            discounts: matrix(discounts.collect(), 1)?,
            any_goes_on: drawn.iter().any(|drawn| drawn.goes_on),
            next_states: matrix(drawn.iter().flat_map(|drawn| drawn.next).collect(), STATES)?,
        })
    }

    /// What the values should be: the reward and, where the episode went on, what `next` says of the states thereafter (rows x 1),
    /// discounted (the target of equation 57). `next` is not asked where every episode was over.
    ///
    /// # Errors
    /// Whatever candle reports.
    pub fn targets(&self, next: impl FnOnce(&Tensor) -> Result<Tensor>) -> Result<Tensor> {
        if !self.any_goes_on {
            return Ok(self.rewards.clone());
        }
        &self.rewards + (next(&self.next_states)? * &self.discounts)?
    }
}

/// The one number in a tensor.
///
/// # Errors
/// Where there are more.
pub fn number(tensor: &Tensor) -> Result<f64> {
    tensor.to_scalar::<f32>().map(f64::from)
}
