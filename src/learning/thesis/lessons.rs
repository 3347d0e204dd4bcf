//! Lessons: shots that make the point, from which the plain actor learns in addition to its own shots. They come from hindsight
//! relabelling (thesis 6.1.1) or from demonstrations (6.1.2). Each kind has its own replay buffer and a share of every minibatch.

use rand::{Rng, RngExt};
use rand_xoshiro::Xoshiro256PlusPlus;
use serde::{Deserialize, Serialize};

use super::{
    agent::{Choice, Transition},
    ddpg::PlainDdpgSettings,
    environment::{Action, Environment, Observation},
    replay,
};
use crate::learning::{
    nn::weights::{Reader, WeightsError, Writer},
    replay::ReplayBuffer,
};

/// The replay buffers of both kinds of lessons, in the order of their [`NAMES`].
#[derive(Debug)]
pub struct Lessons {
    buffers: [ReplayBuffer<Transition>; 2],
    /// Layouts on which demonstrations have been sought.
    layouts: u64,
}

/// The lessons' part of a checkpoint's note, next to its arrays.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct LessonsState {
    next: [usize; 2],
    layouts: u64,
}

/// Names of the buffers in a checkpoint.
const NAMES: [&str; 2] = ["hindsight", "demonstrations"];

impl Lessons {
    /// Creates empty buffers for `capacity` lessons each.
    pub fn new(capacity: usize) -> Self {
        Self { buffers: NAMES.map(|_| ReplayBuffer::new(capacity)), layouts: 0 }
    }

    /// Looks for lessons before `action` is played: states in which `action` makes the point (hindsight), and random actions that make
    /// it in the present state (demonstrations).
    pub fn collect(
        &mut self,
        settings: &PlainDdpgSettings,
        environment: &impl Environment,
        seen: &Observation,
        action: Action,
        rng: &mut Xoshiro256PlusPlus,
    ) {
        let [hindsight, demonstrations] = &mut self.buffers;
        if settings.hindsight > 0.0 {
            for state in environment.hindsight_states(action, rng) {
                hindsight.push(lesson(Observation { state, cell: 0 }, action));
            }
        }
        if settings.demonstrations > 0.0 && self.layouts < settings.demonstration_layouts {
            self.layouts += 1;
            for _ in 0..settings.demonstration_tries {
                let tried: Action = std::array::from_fn(|_| rng.random_range(-1.0..=1.0));
                if environment.reward_for(tried) >= 1.0 {
                    demonstrations.push(lesson(*seen, tried));
                }
            }
        }
    }

    /// Draws `rows` lessons of each kind uniformly; none of a kind whose buffer is empty.
    pub fn sample(&self, rows: [usize; 2], rng: &mut (impl Rng + ?Sized)) -> Vec<Transition> {
        self.buffers.iter().zip(rows).flat_map(|(buffer, rows)| buffer.sample(rows, rng)).collect()
    }

    /// Adds both buffers to a file and returns the rest of the state.
    pub fn save(&self, writer: &mut Writer) -> LessonsState {
        let next = [0, 1].map(|kind| replay::save(&self.buffers[kind], NAMES[kind], writer));
        LessonsState { next, layouts: self.layouts }
    }

    /// Restores the buffers that [`Lessons::save`] wrote.
    pub fn restore(capacity: usize, reader: &Reader<'_>, state: LessonsState) -> Result<Self, WeightsError> {
        let buffer = |kind: usize| replay::restore(capacity, reader, NAMES[kind], state.next[kind]);
        Ok(Self { buffers: [buffer(0)?, buffer(1)?], layouts: state.layouts })
    }
}

/// Returns a lesson: a shot that makes the point. The game clamps actions to their range, so the lesson contains the clamped action.
fn lesson(seen: Observation, action: Action) -> Transition {
    let choice = Choice { action: action.map(|value| value.clamp(-1.0, 1.0)), index: 0 };
    Transition { before: seen, choice, reward: 1.0, continues: false, after: seen }
}
