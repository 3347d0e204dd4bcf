//! The library of experiences (thesis 4.3.1): what is remembered of a shot, and a replay buffer of these in a file.

use super::{
    agent::Transition,
    environment::{ACTIONS, Action, STATES, State},
};
use crate::learning::{
    nn::weights::{Reader, WeightsError, Writer},
    replay::ReplayBuffer,
};

/// One shot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StoredTransition {
    /// The state before.
    pub state: State,
    /// What was done.
    pub action: Action,
    /// Its number among the discrete actions, for agents that have them.
    pub index: u32,
    /// What it earned.
    pub reward: f32,
    /// Whether the episode went on.
    pub goes_on: bool,
    /// The state after.
    pub next: State,
}

/// The name of a library of one's own shots in a file.
pub const MEMORY: &str = "memory";

/// Numbers of a transition in a file.
const NUMBERS: usize = 2 * STATES + ACTIONS + 3;

impl StoredTransition {
    /// What is remembered of a transition.
    pub fn of(transition: &Transition) -> Self {
        let Transition { before, choice, reward, goes_on, after } = *transition;
        let (state, next, reward) = (before.state, after.state, reward as f32);
        Self { state, action: choice.action, index: choice.index, reward, goes_on, next }
    }

    fn numbers(&self) -> [f32; NUMBERS] {
        let [a, b, c, d, e, f] = self.state;
        let [g, h, i, j, k, l] = self.next;
        let goes_on = f32::from(u8::from(self.goes_on));
        // An action's number is below 2^24: exact.
        [a, b, c, d, e, f, g, h, i, j, k, l, self.action[0], self.action[1], self.index as f32, self.reward, goes_on]
    }

    fn from_numbers(numbers: &[f32; NUMBERS]) -> Self {
        let &[a, b, c, d, e, f, g, h, i, j, k, l, phi, speed, index, reward, goes_on] = numbers;
        let (state, next) = ([a, b, c, d, e, f], [g, h, i, j, k, l]);
        Self { state, next, action: [phi, speed], index: index as u32, reward, goes_on: goes_on != 0.0 }
    }
}

/// Adds what a library holds to a file under `name`; returns where the next one goes.
pub fn save(buffer: &ReplayBuffer<StoredTransition>, name: &str, writer: &mut Writer) -> usize {
    let numbers: Vec<f32> = buffer.held().iter().flat_map(StoredTransition::numbers).collect();
    writer.add(name, &[buffer.len(), NUMBERS], &numbers);
    buffer.next()
}

/// A library with the content that [`save`] wrote.
///
/// # Errors
/// Where the file has none.
pub fn restore(
    capacity: usize,
    reader: &Reader<'_>,
    name: &str,
    next: usize,
) -> Result<ReplayBuffer<StoredTransition>, WeightsError> {
    let capacity = capacity.max(1);
    let (shape, numbers) = reader.array(name)?;
    if shape.len() != 2 || shape[1] != NUMBERS || shape[0] > capacity {
        let expected = format!("at most {capacity} rows of {NUMBERS} values");
        return Err(WeightsError::Array { name: name.to_owned(), expected });
    }
    let held = numbers.as_chunks::<NUMBERS>().0.iter().map(StoredTransition::from_numbers).collect();
    Ok(ReplayBuffer::restore(capacity, held, next))
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_xoshiro::Xoshiro256PlusPlus;

    fn transition(number: u8) -> StoredTransition {
        let x = f32::from(number);
        StoredTransition {
            state: [x, 0.1, 0.2, 0.3, 0.4, 0.5],
            action: [x / 7.0, -0.3],
            index: u32::from(number) + 800,
            reward: x,
            goes_on: number.is_multiple_of(2),
            next: [0.6, 0.7, 0.8, 0.9, 1.0, -x],
        }
    }

    #[test]
    fn a_file_gives_back_the_same_ring() {
        let mut replay = ReplayBuffer::new(3);
        (0..5).for_each(|number| replay.push(transition(number)));
        let mut writer = Writer::default();
        let next = save(&replay, MEMORY, &mut writer);
        let bytes = writer.finish(&"").unwrap();
        let mut again = restore(3, &Reader::new(&bytes).unwrap(), MEMORY, next).unwrap();
        for ring in [&mut replay, &mut again] {
            ring.push(transition(5));
            let mut rng = Xoshiro256PlusPlus::seed_from_u64(2);
            let mut drawn = ring.sample(60, &mut rng);
            drawn.sort_by(|a, b| a.reward.total_cmp(&b.reward));
            drawn.dedup();
            assert_eq!(drawn, [transition(3), transition(4), transition(5)]);
        }
        assert!(restore(2, &Reader::new(&bytes).unwrap(), MEMORY, 0).is_err());
    }
}
