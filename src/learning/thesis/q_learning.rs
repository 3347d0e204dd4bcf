//! Tabular Q-learning (thesis Algorithm 2).

use std::collections::BTreeMap;

use candle_core::Error;
use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use super::{
    agent::{Agent, Choice, Settings, Transition},
    carom::Episode,
    environment::{DISCRETE_ACTIONS, Environment, Observation},
    exploration::Epsilon,
};
use crate::learning::{
    learner::{Progress, UpdateStats},
    nn::weights::{Reader, WeightsError, Writer},
    settings::{SettingError, check_positive, check_share},
};

/// Settings of [`QLearning`]. The thesis states the squares, the actions and epsilon-greedy, but no values of these settings.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct QLearningSettings {
    /// When an episode ends.
    pub episode: Episode,
    /// Fraction by which a value moves towards its target (alpha in equation 54).
    pub learning_rate: f64,
    /// Discount factor of a reward one shot later.
    #[serde(alias = "discount")]
    pub gamma: f64,
    /// Schedule of the probability of a random action.
    pub epsilon: Epsilon,
}

impl Default for QLearningSettings {
    fn default() -> Self {
        Self {
            episode: Episode::default(),
            learning_rate: 0.1,
            gamma: 0.99,
            epsilon: Epsilon { first: 1.0, last: 0.05, over: 25_000 },
        }
    }
}

impl Settings for QLearningSettings {
    fn episode(&self) -> Episode {
        self.episode
    }

    fn validate(&self) -> Result<(), SettingError> {
        self.episode.validate()?;
        check_positive("learning_rate", self.learning_rate)?;
        check_share("learning_rate", self.learning_rate)?;
        check_share("gamma", self.gamma)?;
        self.epsilon.validate()
    }
}

/// The tabular Q-learning agent. All values start at zero; the table stores only the state-action pairs that were tried.
#[derive(Debug)]
pub struct QLearning {
    settings: QLearningSettings,
    /// For each state, the actions tried in it and their values.
    table: BTreeMap<u32, Vec<(u32, f32)>>,
    shots: u64,
}

impl QLearning {
    /// Returns the action with the highest positive value in a state, and the value.
    fn best_known(&self, cell: u32) -> Option<(u32, f32)> {
        let tried = self.table.get(&cell)?;
        // Rewards are not negative, so an action without a positive value is no better than an untried one.
        tried.iter().filter(|(_, value)| *value > 0.0).copied().max_by(|a, b| a.1.total_cmp(&b.1))
    }

    fn value_mut(&mut self, cell: u32, index: u32) -> &mut f32 {
        let tried = self.table.entry(cell).or_default();
        let position = tried.iter().position(|(known, _)| *known == index).unwrap_or_else(|| {
            tried.push((index, 0.0));
            tried.len() - 1
        });
        &mut tried[position].1
    }
}

impl Agent for QLearning {
    const NAME: &'static str = "q-learning";
    const TITLE: &'static str = "the thesis' Q-learning with a table of squares";
    type Settings = QLearningSettings;

    fn new(settings: QLearningSettings, _rng: &mut Xoshiro256PlusPlus) -> Result<Self, Error> {
        Ok(Self { settings, table: BTreeMap::new(), shots: 0 })
    }

    fn settings(&self) -> &QLearningSettings {
        &self.settings
    }

    fn progress(&self) -> Progress {
        Progress {
            updates: self.shots,
            learning_rate: self.settings.learning_rate,
            exploration: self.settings.epsilon.after(self.shots),
            replay_fill: None,
        }
    }

    fn explore(&mut self, game: &impl Environment, rng: &mut Xoshiro256PlusPlus) -> Result<Choice, Error> {
        let is_random = rng.random_bool(self.settings.epsilon.after(self.shots));
        let index = if is_random { None } else { self.best_known(game.observe().cell).map(|(index, _)| index) };
        // Without a positive value all actions are equal: the choice is random.
        Ok(Choice::discrete(index.unwrap_or_else(|| rng.random_range(0..DISCRETE_ACTIONS))))
    }

    fn best(&self, seen: &Observation) -> Result<Choice, Error> {
        // Without a positive value the choice is random, but always the same for one state.
        let random = || Xoshiro256PlusPlus::seed_from_u64(u64::from(seen.cell)).random_range(0..DISCRETE_ACTIONS);
        Ok(Choice::discrete(self.best_known(seen.cell).map_or_else(random, |(index, _)| index)))
    }

    fn learn(&mut self, transition: &Transition, _rng: &mut Xoshiro256PlusPlus) -> Result<Option<UpdateStats>, Error> {
        let highest = |cell| self.best_known(cell).map_or(0.0, |(_, value)| f64::from(value));
        let value = highest(transition.before.cell);
        let next = if transition.continues { highest(transition.after.cell) } else { 0.0 };
        let target = transition.reward + self.settings.gamma * next;
        let rate = self.settings.learning_rate;
        let known = self.value_mut(transition.before.cell, transition.choice.index);
        let error = target - f64::from(*known);
        *known += (rate * error) as f32;
        self.shots += 1;
        Ok(Some(UpdateStats { loss: error * error, value }))
    }

    fn save(&self, writer: &mut Writer) -> Result<Value, WeightsError> {
        let entries = || self.table.iter().flat_map(|(cell, tried)| tried.iter().map(move |entry| (*cell, *entry)));
        // Indices of states and actions are below 2^24, so `f32` represents them exactly.
        let numbers: Vec<f32> =
            entries().flat_map(|(cell, (index, value))| [cell as f32, index as f32, value]).collect();
        writer.add("table", &[numbers.len() / 3, 3], &numbers);
        Ok(json!({ "shots": self.shots }))
    }

    fn restore(settings: QLearningSettings, reader: &Reader<'_>, note: Value) -> Result<Self, WeightsError> {
        let shots = note["shots"].as_u64().ok_or(WeightsError::Metadata)?;
        let mut agent = Self { settings, table: BTreeMap::new(), shots };
        agent.load_weights(reader)?;
        Ok(agent)
    }

    fn load_weights(&mut self, reader: &Reader<'_>) -> Result<(), WeightsError> {
        let (_, numbers) = reader.array("table")?;
        let mut table: BTreeMap<u32, Vec<(u32, f32)>> = BTreeMap::new();
        for [cell, index, value] in numbers.as_chunks::<3>().0 {
            table.entry(*cell as u32).or_default().push((*index as u32, *value));
        }
        self.table = table;
        Ok(())
    }
}
