//! What a training run needs of an agent, whichever it is.

use std::fmt::{Debug, Display};

use serde::{Deserialize, Serialize, de::DeserializeOwned};
use serde_json::Value;

use crate::{
    game::Reward,
    learning::{
        evaluation::Score,
        nn::weights::{Reader, WeightsError, Writer},
        settings::SettingError,
    },
    physics::CueInputs,
    table::{Layout, Table},
};

/// Creates an untrained agent from a plan, a table and settings.
pub type Start = fn(TrainingPlan, Table, &Value) -> Result<Box<dyn Learner>, StartError>;

/// Takes up a learner from a file.
pub type Restore = fn(&Reader<'_>, Value) -> Result<Box<dyn Learner>, WeightsError>;

/// A kind of agent: how to create it untrained, and how to restore a saved one.
#[derive(Clone, Copy, Debug)]
pub struct AgentKind {
    /// Name on the command line and in files.
    pub name: &'static str,
    /// What it is, in one line for people.
    pub title: &'static str,
    /// An untrained agent for a plan on a table. The value is an object of the settings that differ from the agent's defaults.
    pub start: Start,
    /// The learner whose [`Learner::save`] filled the file and returned the note.
    pub restore: Restore,
    /// Settings that apply only when weights are loaded; `--from` does not pass them on.
    pub of_one_start: &'static [&'static str],
}

/// Why an agent cannot start.
#[derive(Debug, thiserror::Error)]
pub enum StartError {
    /// A setting is unknown, of another type or outside its range.
    #[error("the agent's settings: {0}")]
    Settings(String),
    /// candle refuses.
    #[error("the agent cannot start: {0}")]
    Network(#[from] candle_core::Error),
}

impl StartError {
    /// Settings that are refused for this reason.
    pub fn settings(reason: impl Display) -> Self {
        Self::Settings(reason.to_string())
    }
}

/// An agent's settings, from an object of those that differ from its defaults.
///
/// # Errors
/// Where one is unknown or of another type, or `validate` refuses them.
pub fn settings_from<S: DeserializeOwned>(
    object: &Value,
    validate: impl FnOnce(&S) -> Result<(), SettingError>,
) -> Result<S, StartError> {
    let settings = S::deserialize(object).map_err(|error| {
        // Which of them it is, where one alone cannot be read either.
        let alone = |(name, value): (&String, &Value)| {
            let error = S::deserialize(serde_json::json!({ name: value })).err()?;
            Some(format!("{name} = {value}: {error}"))
        };
        let named = object.as_object().and_then(|settings| settings.iter().find_map(alone));
        StartError::settings(in_plain_words(named.unwrap_or_else(|| error.to_string())))
    })?;
    validate(&settings).map_err(StartError::settings)?;
    Ok(settings)
}

/// A message of serde with the types that it expects in words.
fn in_plain_words(message: String) -> String {
    let types = [("expected usize", "expected a whole number from 0 on"), ("expected f64", "expected a number")];
    types.iter().fold(message, |message, (name, words)| message.replace(name, words))
}

/// What is to be learnt, and how long; the same for every agent.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct TrainingPlan {
    /// What earns a reward.
    pub reward: Reward,
    /// Seed of everything random.
    pub seed: u64,
    /// Shots to play.
    pub shots: u64,
}

/// What one iteration, rollout and update, did.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Iteration {
    /// Mean reward of the shots played, exploration included.
    pub mean_reward: f64,
    /// Mean value that the agent gives its own choices, in the units in which it learns: the critic's mean of the
    /// actor's actions, or the mean of the largest Q.
    pub q_value: f64,
    /// Loss of whatever judges actions; 0 where the iteration made no update.
    pub critic_loss: f64,
    /// Loss of the actor, for agents that have one.
    pub actor_loss: Option<f64>,
}

/// How far an agent's learning has come.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Updates made so far.
    pub updates: u64,
    /// Learning rate now, of whatever judges actions.
    pub learning_rate: f64,
    /// How strongly it explores now: the probability of a shot that is drawn uniformly from all actions (`ddpg` adds noise to most of
    /// its other shots, too), or, for `thesis-ddpg`, the standard deviation of its noise in units of half an action's range.
    pub exploration: f64,
    /// Share of its replay buffer that is filled, where it has one.
    pub replay_fill: Option<f64>,
}

/// An agent that trains. It can be saved between any two iterations and goes on bit for bit as if it had not been: what it
/// does depends on nothing but its own state.
pub trait Learner: Debug + Send {
    /// Its [`AgentKind::name`].
    fn agent(&self) -> &'static str;

    /// What it learns.
    fn plan(&self) -> TrainingPlan;

    /// Where it plays.
    fn table(&self) -> &Table;

    /// All its settings, as an object that [`AgentKind::start`] takes.
    fn settings(&self) -> Value;

    /// Shots played so far.
    fn shots(&self) -> u64;

    /// How far its learning has come.
    fn progress(&self) -> Progress;

    /// Whether all shots of the plan have been played.
    fn is_finished(&self) -> bool {
        self.shots() >= self.plan().shots
    }

    /// Plays at least one shot and learns.
    ///
    /// # Errors
    /// Where the networks no longer give finite numbers.
    fn iterate(&mut self) -> candle_core::Result<Iteration>;

    /// Plays one shot on every layout as well as it can, without exploration. Its own state, the random numbers to come
    /// included, stays as it is.
    ///
    /// # Errors
    /// Whatever candle reports.
    fn score(&self, layouts: &[Layout]) -> candle_core::Result<Score>;

    /// Its shots on the layouts, as [`Learner::score`] plays them.
    ///
    /// # Errors
    /// Whatever candle reports.
    fn shots_on(&self, layouts: &[Layout]) -> candle_core::Result<Vec<CueInputs>>;

    /// The bytes of a policy file, for agents whose policy the coach can use. `held_out_reward` is what it has been
    /// measured to earn, `date` the day on which the run was started.
    ///
    /// # Errors
    /// Whatever candle or safetensors reports.
    fn policy(&self, held_out_reward: f64, date: &str) -> Result<Option<Vec<u8>>, WeightsError>;

    /// Adds the arrays of its whole state to a file and returns everything else ([`note_of`]).
    ///
    /// # Errors
    /// Whatever candle or serde reports.
    fn save(&self, writer: &mut Writer) -> Result<Value, WeightsError>;

    /// Takes the weights, and nothing but the weights, from a file that [`Learner::save`] filled, or a policy file, of
    /// the same kind of agent.
    ///
    /// # Errors
    /// Where the file has no such weights, or some of other sizes: the learner is then unchanged.
    fn load_weights(&mut self, weights: &Reader<'_>) -> Result<(), WeightsError>;
}

/// What serde makes of `note`, its numbers written as shortly as they are in a file (`f32` as well as `f64`).
///
/// # Errors
/// Whatever serde reports.
pub fn note_of(note: &impl Serialize) -> Result<Value, WeightsError> {
    let text = serde_json::to_string(note).map_err(safetensors::SafeTensorError::from)?;
    Ok(serde_json::from_str(&text).map_err(safetensors::SafeTensorError::from)?)
}
