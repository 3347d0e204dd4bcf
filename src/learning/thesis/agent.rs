//! What the thesis' agents have in common, and the loop in which they play and learn.

use candle_core::Error;
use rand_xoshiro::Xoshiro256PlusPlus;
use serde::{Deserialize, Serialize, de::DeserializeOwned};
use serde_json::Value;

use super::{
    carom::Episode,
    environment::{Action, Environment, Observation, discrete_action},
};
use crate::learning::{
    learner::{Progress, UpdateStats},
    nn::weights::{Reader, WeightsError, Writer},
    settings::SettingError,
};

/// What an agent does.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Choice {
    /// The action.
    pub action: Action,
    /// Its number, for agents with discrete actions.
    pub index: u32,
}

impl Choice {
    /// The discrete action number `index`.
    pub fn discrete(index: u32) -> Self {
        Self { action: discrete_action(index), index }
    }
}

/// One shot as an agent learns from it.
#[derive(Clone, Copy, Debug)]
pub struct Transition {
    /// What was seen.
    pub before: Observation,
    /// What was done.
    pub choice: Choice,
    /// What it earned.
    pub reward: f64,
    /// Whether the episode goes on.
    pub goes_on: bool,
    /// What is seen now.
    pub after: Observation,
}

/// An agent's settings.
pub trait Settings: Clone + std::fmt::Debug + Default + Serialize + DeserializeOwned + Send {
    /// When an episode is over.
    fn episode(&self) -> Episode;

    /// Whether they are about points: of no use with a reward that says anything else.
    fn are_about_points(&self) -> bool {
        false
    }

    /// Checks every setting.
    ///
    /// # Errors
    /// The first one that is outside its range.
    fn validate(&self) -> Result<(), SettingError>;
}

/// One of the thesis' agents. Errors are candle's, where networks no longer give finite numbers or an array has another size, and
/// those of files that do not fit the settings.
#[expect(clippy::missing_errors_doc, reason = "said of all of them at once")]
pub trait Agent: std::fmt::Debug + Send + Sized {
    /// Name on the command line and in files.
    const NAME: &'static str;

    /// What it is, in one line for people.
    const TITLE: &'static str;

    /// Its settings.
    type Settings: Settings;

    /// An untrained agent.
    fn new(settings: Self::Settings, rng: &mut Xoshiro256PlusPlus) -> Result<Self, Error>;

    /// Its settings.
    fn settings(&self) -> &Self::Settings;

    /// How far its learning has come.
    fn progress(&self) -> Progress;

    /// What it does while it learns.
    fn explore(&mut self, seen: &Observation, rng: &mut Xoshiro256PlusPlus) -> Result<Choice, Error>;

    /// What it thinks best.
    fn best(&self, seen: &Observation) -> Result<Choice, Error>;

    /// Looks for lessons before a shot is played, which only some agents do.
    fn study(
        &mut self,
        _environment: &impl Environment,
        _seen: &Observation,
        _action: Action,
        _rng: &mut Xoshiro256PlusPlus,
    ) {
    }

    /// Remembers a shot and learns from those that it remembers; nothing as long as these are too few.
    fn learn(&mut self, transition: &Transition, rng: &mut Xoshiro256PlusPlus) -> Result<Option<UpdateStats>, Error>;

    /// Adds the arrays of its state to a file and returns everything else.
    fn save(&self, writer: &mut Writer) -> Result<Value, WeightsError>;

    /// The agent whose [`Agent::save`] filled the file and returned `note`.
    fn restore(settings: Self::Settings, reader: &Reader<'_>, note: Value) -> Result<Self, WeightsError>;

    /// Takes what it plays by, and nothing else, from such a file.
    fn load_weights(&mut self, reader: &Reader<'_>) -> Result<(), WeightsError>;
}

/// Where an agent and its environment are in their episodes.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub struct EpisodeState {
    /// Whether an episode is going on.
    running: bool,
}

impl EpisodeState {
    /// Plays a shot and learns (Algorithms 2 to 4), beginning an episode where none is going on. Returns the shot's reward and
    /// what was learnt after it.
    ///
    /// # Errors
    /// Where the networks no longer give finite numbers.
    pub fn shoot<A: Agent>(
        &mut self,
        agent: &mut A,
        environment: &mut impl Environment,
        rng: &mut Xoshiro256PlusPlus,
    ) -> Result<(f64, Option<UpdateStats>), Error> {
        if !self.running {
            environment.begin(rng);
        }
        let before = environment.observe();
        let choice = agent.explore(&before, rng)?;
        agent.study(environment, &before, choice.action, rng);
        let outcome = environment.act(choice.action);
        let (reward, goes_on, after) = (outcome.reward, !outcome.over, environment.observe());
        self.running = goes_on;
        Ok((reward, agent.learn(&Transition { before, choice, reward, goes_on, after }, rng)?))
    }
}
