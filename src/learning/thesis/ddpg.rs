//! The thesis' deep deterministic policy gradient (Algorithm 4, Table 4) with the networks of its reference 20, the
//! example that comes with keras-rl.

use candle_core::{Device, Error, Tensor};
use rand_xoshiro::Xoshiro256PlusPlus;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::{
    actor_critic::{ActorCritic, Layers, Rates},
    agent::{Agent, Choice, Settings, Transition, UpdateStats},
    carom::Episode,
    environment::{Action, Observation, STATES},
    exploration::OrnsteinUhlenbeck,
    q_learning::check_episode,
    replay::{ReplayBuffer, StoredTransition},
};
use crate::learning::settings::{
    SettingError, check, check_batch, check_count, check_layers, check_positive, check_share,
};
use crate::learning::{
    learner::note_of,
    nn::weights::{Reader, WeightsError, Writer},
};

/// Settings of [`PlainDdpg`]: Table 4; what the thesis leaves open is as in keras-rl's example.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct PlainDdpgSettings {
    /// When an episode is over.
    pub episode: Episode,
    /// Units of the actor's hidden layers; its output is linear.
    pub actor_layers: Vec<usize>,
    /// Units of the critic's hidden layers; it sees state and action together.
    pub critic_layers: Vec<usize>,
    /// Adam's learning rate.
    pub learning_rate: f64,
    /// Part k of the target networks that a soft update keeps (equation 59).
    pub keep: f64,
    /// Longest gradient that is not shortened.
    pub gradient_clip: f64,
    /// Transitions remembered.
    pub memory: usize,
    /// What a reward one shot later is worth now.
    pub discount: f64,
    /// Transitions an update learns from.
    pub batch: usize,
    /// Shots before the first update.
    pub warm_up: usize,
    /// Noise on the actions.
    pub noise: OrnsteinUhlenbeck,
    /// Whether the noise begins at nought with every episode, as in keras-rl. With one shot an episode that leaves
    /// white noise of a standard deviation of `sigma sqrt(dt)`.
    pub noise_restarts: bool,
}

impl Default for PlainDdpgSettings {
    fn default() -> Self {
        Self {
            episode: Episode::default(),
            actor_layers: vec![16; 3],
            critic_layers: vec![32; 3],
            learning_rate: 1e-3,
            keep: 0.999,
            gradient_clip: 1.0,
            memory: 50_000,
            discount: 0.99,
            batch: 32,
            warm_up: 100,
            noise: OrnsteinUhlenbeck { theta: 0.15, sigma: 0.3, dt: 0.01 },
            noise_restarts: true,
        }
    }
}

impl Settings for PlainDdpgSettings {
    fn episode(&self) -> Episode {
        self.episode
    }

    fn learning_rate(&self) -> f64 {
        self.learning_rate
    }

    fn validate(&self) -> Result<(), SettingError> {
        check_episode(self.episode)?;
        check_layers("actor_layers", &self.actor_layers)?;
        check_layers("critic_layers", &self.critic_layers)?;
        check_positive("learning_rate", self.learning_rate)?;
        check_share("keep", self.keep)?;
        check_positive("gradient_clip", self.gradient_clip)?;
        check_count("memory", self.memory)?;
        check_share("discount", self.discount)?;
        check_batch("batch", self.batch)?;
        check_share("noise.dt", self.noise.dt)?;
        let kept = self.noise.theta * self.noise.dt;
        check("noise.theta", self.noise.theta, (0.0..2.0).contains(&kept), "0 to 2 / dt")?;
        check("noise.sigma", self.noise.sigma, (0.0..=1e3).contains(&self.noise.sigma), "0 to 1000")
    }
}

impl PlainDdpgSettings {
    fn layers(&self) -> Layers {
        Layers { actor: self.actor_layers.clone(), critic: self.critic_layers.clone() }
    }

    fn rates(&self) -> Rates {
        let Self { learning_rate, keep, gradient_clip, .. } = *self;
        Rates { learning_rate, keep, gradient_clip }
    }
}

/// The agent.
#[derive(Debug)]
pub struct PlainDdpg {
    settings: PlainDdpgSettings,
    networks: ActorCritic,
    replay: ReplayBuffer,
    noise: Action,
    shots: u64,
}

#[derive(Serialize, Deserialize)]
struct PlainDdpgState {
    shots: u64,
    updates: u32,
    next: usize,
    noise: Action,
}

impl PlainDdpg {
    fn update(&mut self, rng: &mut Xoshiro256PlusPlus) -> Result<UpdateStats, Error> {
        self.networks.update(&self.replay.batch(self.settings.batch, self.settings.discount, rng)?)
    }
}

impl Agent for PlainDdpg {
    const NAME: &'static str = "thesis-ddpg";
    const TITLE: &'static str = "the thesis' deep deterministic policy gradient";
    type Settings = PlainDdpgSettings;

    fn new(settings: PlainDdpgSettings, rng: &mut Xoshiro256PlusPlus) -> Result<Self, Error> {
        let networks = ActorCritic::random(&settings.layers(), settings.rates(), rng)?;
        let replay = ReplayBuffer::new(settings.memory);
        Ok(Self { settings, networks, replay, noise: Action::default(), shots: 0 })
    }

    fn settings(&self) -> &PlainDdpgSettings {
        &self.settings
    }

    fn updates(&self) -> u64 {
        u64::from(self.networks.updates())
    }

    fn exploration(&self) -> f64 {
        self.settings.noise.deviation(self.settings.noise_restarts)
    }

    fn replay_fill(&self) -> Option<f64> {
        Some(self.replay.fill())
    }

    fn explore(&mut self, seen: &Observation, rng: &mut Xoshiro256PlusPlus) -> Result<Choice, Error> {
        self.noise = self.settings.noise.step(self.noise, rng);
        let mut choice = self.best(seen)?;
        for (value, noise) in choice.action.iter_mut().zip(self.noise) {
            *value += noise;
        }
        Ok(choice)
    }

    fn best(&self, seen: &Observation) -> Result<Choice, Error> {
        let state = Tensor::from_slice(&seen.state, (1, STATES), &Device::Cpu)?;
        let action = self.networks.act(&state)?.flatten_all()?.to_vec1::<f32>()?;
        Ok(Choice { action: std::array::from_fn(|index| action[index]), index: 0 })
    }

    fn learn(&mut self, transition: &Transition, rng: &mut Xoshiro256PlusPlus) -> Result<Option<UpdateStats>, Error> {
        self.replay.push(StoredTransition::of(transition));
        if self.settings.noise_restarts && !transition.goes_on {
            self.noise = Action::default();
        }
        self.shots += 1;
        if self.shots <= self.settings.warm_up as u64 { Ok(None) } else { self.update(rng).map(Some) }
    }

    fn save(&self, writer: &mut Writer) -> Result<Value, WeightsError> {
        let values = self.networks.values()?;
        writer.add("networks", &[values.len()], &values);
        let Self { shots, noise, .. } = *self;
        note_of(&PlainDdpgState { shots, noise, updates: self.networks.updates(), next: self.replay.save(writer) })
    }

    fn restore(settings: PlainDdpgSettings, reader: &Reader<'_>, note: Value) -> Result<Self, WeightsError> {
        let PlainDdpgState { shots, updates, next, noise } =
            serde_json::from_value(note).map_err(|_| WeightsError::Foreign)?;
        let (_, values) = reader.array("networks")?;
        let networks = ActorCritic::from_values(&settings.layers(), settings.rates(), &values, updates)?;
        let replay = ReplayBuffer::restore(settings.memory, reader, next)?;
        Ok(Self { settings, networks, replay, noise, shots })
    }

    /// The learning networks become both the learning ones and the targets; the optimisers start again.
    fn load_weights(&mut self, reader: &Reader<'_>) -> Result<(), WeightsError> {
        let (_, values) = reader.array("networks")?;
        self.networks = ActorCritic::from_weights(&self.settings.layers(), self.settings.rates(), &values)?;
        Ok(())
    }
}
