//! Experience replay (thesis 4.3.1): replay buffers in files, and minibatches.

use candle_core::{Device, Error, Tensor};
use rand::{Rng, RngExt};

use super::{
    agent::{Choice, Transition},
    environment::{ACTIONS, Observation, STATES},
};
use crate::learning::{
    nn::weights::{Reader, WeightsError, Writer},
    replay::ReplayBuffer,
};

/// Name, in a file, of the replay buffer with the agent's own shots: that of all earlier checkpoints.
pub const REPLAY_BUFFER: &str = "memory";

/// Numbers per transition in a file.
const NUMBERS: usize = 2 * STATES + ACTIONS + 3;

fn numbers(shot: &Transition) -> [f32; NUMBERS] {
    let [a, b, c, d, e, f] = shot.before.state;
    let [g, h, i, j, k, l] = shot.after.state;
    let Choice { action: [phi, speed], index } = shot.choice;
    let (reward, continues) = (shot.reward as f32, f32::from(u8::from(shot.continues)));
    // An action's index is below 2^24, so `f32` represents it exactly.
    [a, b, c, d, e, f, g, h, i, j, k, l, phi, speed, index as f32, reward, continues]
}

/// Returns the transition of these numbers. A file contains no discrete states, which the agents with a replay buffer do not use.
fn from_numbers(numbers: &[f32; NUMBERS]) -> Transition {
    let &[a, b, c, d, e, f, g, h, i, j, k, l, phi, speed, index, reward, continues] = numbers;
    let [before, after] = [[a, b, c, d, e, f], [g, h, i, j, k, l]].map(|state| Observation { state, cell: 0 });
    let choice = Choice { action: [phi, speed], index: index as u32 };
    Transition { before, choice, reward: reward.into(), continues: continues != 0.0, after }
}

/// Adds a replay buffer to a file under `name`; returns the index of the slot that the next transition overwrites.
pub fn save(buffer: &ReplayBuffer<Transition>, name: &str, writer: &mut Writer) -> usize {
    let numbers: Vec<f32> = buffer.stored().iter().flat_map(numbers).collect();
    writer.add(name, &[buffer.len(), NUMBERS], &numbers);
    buffer.next()
}

/// Restores a replay buffer that [`save`] wrote.
pub fn restore(
    capacity: usize,
    reader: &Reader<'_>,
    name: &str,
    next: usize,
) -> Result<ReplayBuffer<Transition>, WeightsError> {
    let capacity = capacity.max(1);
    let (shape, numbers) = reader.array(name)?;
    if shape.len() != 2 || shape[1] != NUMBERS || shape[0] > capacity {
        let expected = format!("at most {capacity} rows of {NUMBERS} values");
        return Err(WeightsError::Array { name: name.to_owned(), expected });
    }
    let stored = numbers.as_chunks::<NUMBERS>().0.iter().map(from_numbers).collect();
    Ok(ReplayBuffer::restore(capacity, stored, next))
}

/// A minibatch of transitions, one per row.
#[derive(Clone, Debug)]
pub struct Batch {
    /// States (rows x states).
    pub states: Tensor,
    /// Actions played in them (rows x actions).
    pub actions: Tensor,
    /// Indices of these actions, for discrete actions (rows x 1, unsigned).
    pub indices: Tensor,
    /// Rewards (rows x 1).
    pub rewards: Tensor,
    /// Factor of the next state's value: `gamma` if the episode continued, zero if it ended (rows x 1).
    pub discounts: Tensor,
    /// Whether any episode continued. If none did, the values of the next states are not needed.
    pub any_continues: bool,
    /// The next states (rows x states).
    pub next_states: Tensor,
}

impl Batch {
    pub fn new(drawn: &[Transition], gamma: f64) -> Result<Self, Error> {
        let rows = drawn.len();
        let matrix = |values: Vec<f32>, columns: usize| Tensor::from_vec(values, (rows, columns), &Device::Cpu);
        let discounts = drawn.iter().map(|drawn| if drawn.continues { gamma as f32 } else { 0.0 });
        let indices = drawn.iter().map(|drawn| drawn.choice.index).collect();
        Ok(Self {
            states: matrix(drawn.iter().flat_map(|drawn| drawn.before.state).collect(), STATES)?,
            actions: matrix(drawn.iter().flat_map(|drawn| drawn.choice.action).collect(), ACTIONS)?,
            indices: Tensor::from_vec(indices, (rows, 1), &Device::Cpu)?,
            rewards: matrix(drawn.iter().map(|drawn| drawn.reward as f32).collect(), 1)?,
            discounts: matrix(discounts.collect(), 1)?,
            any_continues: drawn.iter().any(|drawn| drawn.continues),
            next_states: matrix(drawn.iter().flat_map(|drawn| drawn.after.state).collect(), STATES)?,
        })
    }

    /// Draws a minibatch of numbers uniform between -1 and 1 with a gamma of 0.99, for benchmarks and tests.
    pub fn random(rows: usize, continues: bool, rng: &mut impl Rng) -> Result<Self, Error> {
        let mut number = || rng.random_range(-1.0f32..1.0);
        let draw = |_| Transition {
            before: Observation { state: std::array::from_fn(|_| number()), cell: 0 },
            choice: Choice { action: std::array::from_fn(|_| number()), index: 0 },
            reward: number().into(),
            continues,
            after: Observation { state: std::array::from_fn(|_| number()), cell: 0 },
        };
        Self::new(&(0..rows).map(draw).collect::<Vec<_>>(), 0.99)
    }

    /// Returns the targets of the values (rows x 1): the reward plus, if the episode continued, the discounted value that `next` returns
    /// for the next state (the target of equation 57). `next` is not called if every episode ended.
    pub fn targets(&self, next: impl FnOnce(&Tensor) -> Result<Tensor, Error>) -> Result<Tensor, Error> {
        if !self.any_continues {
            return Ok(self.rewards.clone());
        }
        &self.rewards + (next(&self.next_states)? * &self.discounts)?
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn oversized_replay_buffers_are_refused() {
        let mut replay = ReplayBuffer::new(3);
        (0..3).for_each(|_| replay.push(Transition::default()));
        let mut writer = Writer::default();
        let next = save(&replay, REPLAY_BUFFER, &mut writer);
        let bytes = writer.finish(&"").unwrap();
        let reader = Reader::new(&bytes).unwrap();
        assert!(restore(3, &reader, REPLAY_BUFFER, next).is_ok() && restore(2, &reader, REPLAY_BUFFER, 0).is_err());
    }
}
