//! Deep Q-learning (thesis Algorithm 3, Tables 2 and 3).

use candle_core::{Device, Error, Tensor};
use candle_nn::{Module, Optimizer};
use rand::RngExt;
use rand_xoshiro::Xoshiro256PlusPlus;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::{
    agent::{Agent, Choice, Settings, Transition},
    carom::Episode,
    environment::{DISCRETE_ACTIONS, Environment, Observation, STATES},
    exploration::Epsilon,
    replay::{self, Batch, REPLAY_BUFFER},
};
use crate::learning::{
    learner::{Progress, UpdateStats, note_of},
    nn::{
        adam::{Adam, AdamConfig},
        mlp::Mlp,
        number,
        squared_error::squared_error,
        weights::{Reader, WeightsError, Writer},
    },
    replay::ReplayBuffer,
    settings::{SettingError, check_batch, check_count, check_layers, check_positive, check_share},
};

/// Settings of [`Dqn`]: Tables 2 and 3; the thesis does not state epsilon.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct DqnSettings {
    /// When an episode ends.
    pub episode: Episode,
    /// Units of the hidden layers.
    pub layers: Vec<usize>,
    /// Adam's learning rate.
    pub learning_rate: f64,
    /// Updates between two copies to the target network.
    #[serde(alias = "target_every")]
    pub target_update_interval: u32,
    /// Capacity of the replay buffer, in transitions.
    #[serde(alias = "memory")]
    pub buffer_size: usize,
    /// Discount factor of a reward one shot later.
    #[serde(alias = "discount")]
    pub gamma: f64,
    /// Transitions in the minibatch of an update.
    #[serde(alias = "batch")]
    pub batch_size: usize,
    /// Shots before the first update.
    #[serde(alias = "warm_up")]
    pub learning_starts: usize,
    /// Schedule of the probability of a random action.
    pub epsilon: Epsilon,
}

impl Default for DqnSettings {
    fn default() -> Self {
        Self {
            episode: Episode::default(),
            layers: vec![16; 3],
            learning_rate: 1e-3,
            target_update_interval: 10_000,
            buffer_size: 50_000,
            gamma: 0.99,
            batch_size: 32,
            learning_starts: 100,
            epsilon: Epsilon { first: 1.0, last: 0.1, over: 100_000 },
        }
    }
}

impl Settings for DqnSettings {
    fn episode(&self) -> Episode {
        self.episode
    }

    fn validate(&self) -> Result<(), SettingError> {
        self.episode.validate()?;
        check_layers("layers", &self.layers)?;
        check_positive("learning_rate", self.learning_rate)?;
        check_count("target_update_interval", self.target_update_interval as usize)?;
        check_count("buffer_size", self.buffer_size)?;
        check_share("gamma", self.gamma)?;
        check_batch("batch_size", self.batch_size)?;
        self.epsilon.validate()
    }
}

/// The deep Q-learning agent.
#[derive(Debug)]
pub struct Dqn {
    settings: DqnSettings,
    online: Mlp,
    target: Mlp,
    optimiser: Adam,
    replay: ReplayBuffer<Transition>,
    shots: u64,
}

#[derive(Serialize, Deserialize)]
struct DqnState {
    shots: u64,
    updates: u32,
    next: usize,
}

impl DqnSettings {
    const fn adam(&self) -> AdamConfig {
        AdamConfig { learning_rate: self.learning_rate, max_grad_norm: f64::INFINITY }
    }

    fn sizes(&self) -> Vec<usize> {
        [&[STATES], self.layers.as_slice(), &[DISCRETE_ACTIONS as usize]].concat()
    }
}

impl Dqn {
    /// Makes one update with a minibatch from the replay buffer.
    fn update(&mut self, rng: &mut Xoshiro256PlusPlus) -> Result<UpdateStats, Error> {
        let batch = Batch::new(&self.replay.sample(self.settings.batch_size, rng), self.settings.gamma)?;
        let targets = batch.targets(|states| self.target.forward_frozen(states)?.max_keepdim(1))?;
        let values = self.online.forward(&batch.states)?;
        let loss = squared_error(&values.gather(&batch.indices, 1)?, &targets)?;
        self.optimiser.backward_step(&loss)?;
        let value = values.detach().max(1)?.mean_all()?;
        if self.optimiser.steps().is_multiple_of(self.settings.target_update_interval) {
            self.target = self.online.duplicate()?;
        }
        Ok(UpdateStats { loss: number(&loss)?, value: number(&value)? })
    }
}

impl Agent for Dqn {
    const NAME: &'static str = "dqn";
    const TITLE: &'static str = "the thesis' deep Q-learning";
    type Settings = DqnSettings;

    fn new(settings: DqnSettings, rng: &mut Xoshiro256PlusPlus) -> Result<Self, Error> {
        let sizes = settings.sizes();
        let online = Mlp::glorot(&sizes, rng)?;
        Ok(Self {
            target: online.duplicate()?,
            optimiser: Adam::new(vec![online.parameters().clone()], settings.adam())?,
            replay: ReplayBuffer::new(settings.buffer_size),
            online,
            settings,
            shots: 0,
        })
    }

    fn settings(&self) -> &DqnSettings {
        &self.settings
    }

    fn progress(&self) -> Progress {
        Progress {
            updates: u64::from(self.optimiser.steps()),
            learning_rate: self.settings.learning_rate,
            exploration: self.settings.epsilon.after(self.shots),
            replay_fill: Some(self.replay.fill_fraction()),
        }
    }

    fn explore(&mut self, game: &impl Environment, rng: &mut Xoshiro256PlusPlus) -> Result<Choice, Error> {
        if rng.random_bool(self.settings.epsilon.after(self.shots)) {
            return Ok(Choice::discrete(rng.random_range(0..DISCRETE_ACTIONS)));
        }
        self.best(&game.observe())
    }

    fn best(&self, seen: &Observation) -> Result<Choice, Error> {
        let state = Tensor::from_slice(&seen.state, (1, STATES), &Device::Cpu)?;
        Ok(Choice::discrete(self.online.forward_frozen(&state)?.flatten_all()?.argmax(0)?.to_scalar()?))
    }

    fn learn(&mut self, transition: &Transition, rng: &mut Xoshiro256PlusPlus) -> Result<Option<UpdateStats>, Error> {
        self.replay.push(*transition);
        self.shots += 1;
        if self.shots <= self.settings.learning_starts as u64 { Ok(None) } else { self.update(rng).map(Some) }
    }

    fn save(&self, writer: &mut Writer) -> Result<Value, WeightsError> {
        writer.add_network("online", &self.online)?;
        writer.add_network("target", &self.target)?;
        writer.add_optimiser("", &self.optimiser)?;
        let next = replay::save(&self.replay, REPLAY_BUFFER, writer);
        note_of(&DqnState { shots: self.shots, updates: self.optimiser.steps(), next })
    }

    fn restore(settings: DqnSettings, reader: &Reader<'_>, note: Value) -> Result<Self, WeightsError> {
        let DqnState { shots, updates, next } = serde_json::from_value(note).map_err(|_| WeightsError::Metadata)?;
        let online = reader.network("online", &settings.sizes())?;
        Ok(Self {
            target: reader.network("target", &settings.sizes())?,
            optimiser: reader.optimiser("", &online, settings.adam(), updates)?,
            replay: replay::restore(settings.buffer_size, reader, REPLAY_BUFFER, next)?,
            online,
            settings,
            shots,
        })
    }

    fn load_weights(&mut self, reader: &Reader<'_>) -> Result<(), WeightsError> {
        let online = reader.network("online", &self.settings.sizes())?;
        self.target = online.duplicate()?;
        self.optimiser = Adam::new(vec![online.parameters().clone()], self.settings.adam())?;
        self.online = online;
        Ok(())
    }
}
