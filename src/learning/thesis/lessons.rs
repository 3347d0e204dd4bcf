//! Shots that make a point, from which the plain actor learns beside its own: seen in hindsight (thesis 6.1.1) or
//! demonstrated (6.1.2). Each kind has a memory of its own and a share of every batch.

use rand::{Rng, RngExt};
use rand_xoshiro::Xoshiro256PlusPlus;
use serde::{Deserialize, Serialize};

use super::{
    ddpg::PlainDdpgSettings,
    environment::{Action, Environment, Observation, State},
    replay::{self, StoredTransition},
};
use crate::learning::{
    nn::weights::{Reader, WeightsError, Writer},
    replay::ReplayBuffer,
};

/// The memories of both kinds, in the order of their [`NAMES`].
#[derive(Debug)]
pub struct Lessons {
    memories: [ReplayBuffer<StoredTransition>; 2],
    layouts: u64,
}

/// What a checkpoint says of them beside arrays.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct LessonsState {
    next: [usize; 2],
    layouts: u64,
}

/// Names of the memories in a checkpoint.
const NAMES: [&str; 2] = ["hindsight", "demonstrations"];

impl Lessons {
    /// Empty memories for `capacity` lessons each.
    pub fn new(capacity: usize) -> Self {
        Self { memories: NAMES.map(|_| ReplayBuffer::new(capacity)), layouts: 0 }
    }

    /// Looks for lessons before `action` is played: where it would have made the point, and what makes it here.
    pub fn seek(
        &mut self,
        settings: &PlainDdpgSettings,
        environment: &impl Environment,
        seen: &Observation,
        action: Action,
        rng: &mut Xoshiro256PlusPlus,
    ) {
        let [hindsight, demonstrations] = &mut self.memories;
        if settings.hindsight > 0.0 {
            for state in environment.in_hindsight(action, rng) {
                hindsight.push(lesson(state, action));
            }
        }
        if settings.demonstrations > 0.0 && self.layouts < settings.demonstration_layouts {
            self.layouts += 1;
            for _ in 0..settings.demonstration_tries {
                let tried: Action = std::array::from_fn(|_| rng.random_range(-1.0..=1.0));
                if environment.would_earn(tried) >= 1.0 {
                    demonstrations.push(lesson(seen.state, tried));
                }
            }
        }
    }

    /// So many lessons of each kind, drawn uniformly; none of a kind of which there is none yet.
    pub fn sample(&self, rows: [usize; 2], rng: &mut (impl Rng + ?Sized)) -> Vec<StoredTransition> {
        self.memories.iter().zip(rows).flat_map(|(memory, rows)| memory.sample(rows, rng)).collect()
    }

    /// Adds both memories to a file and returns everything else.
    pub fn save(&self, writer: &mut Writer) -> LessonsState {
        let next = [0, 1].map(|kind| replay::save(&self.memories[kind], NAMES[kind], writer));
        LessonsState { next, layouts: self.layouts }
    }

    /// The memories that [`Lessons::save`] wrote.
    pub fn restore(capacity: usize, reader: &Reader<'_>, state: LessonsState) -> Result<Self, WeightsError> {
        let memory = |kind: usize| replay::restore(capacity, reader, NAMES[kind], state.next[kind]);
        Ok(Self { memories: [memory(0)?, memory(1)?], layouts: state.layouts })
    }
}

/// A shot that makes the point. Actions out of range are carried out as the nearest inside, so that is what is learnt.
fn lesson(state: State, action: Action) -> StoredTransition {
    let action = action.map(|value| value.clamp(-1.0, 1.0));
    StoredTransition { state, action, index: 0, reward: 1.0, goes_on: false, next: state }
}
