//! What a training run needs of an agent, whichever it is.

use std::fmt::{Debug, Display};

use serde::{Deserialize, Serialize, de::DeserializeOwned};
use serde_json::{Value, json};

use crate::{
    game::Reward,
    learning::{
        evaluation::Score,
        nn::{
            first_line,
            weights::{Reader, WeightsError, Writer},
        },
        settings::SettingError,
    },
    physics::CueInputs,
    storage::in_plain_words,
    table::{Layout, Table},
};

/// Creates an untrained agent from a plan, a table and settings.
pub type StartFn = fn(TrainingPlan, Table, &Value) -> Result<Box<dyn Learner>, StartError>;

/// Takes up a learner from a file.
pub type RestoreFn = fn(&Reader<'_>, Value) -> Result<Box<dyn Learner>, WeightsError>;

/// A kind of agent: how to create it untrained, and how to restore a saved one.
#[derive(Clone, Copy, Debug)]
pub struct AgentKind {
    /// Name on the command line and in files.
    pub name: &'static str,
    /// What it is, in one line for people.
    pub title: &'static str,
    /// All its settings, from an object of those that differ from its defaults.
    pub settings: fn(&Value) -> Result<Value, StartError>,
    /// An untrained agent for a plan on a table. The value is an object of the settings that differ from the agent's defaults.
    pub start: StartFn,
    /// The learner whose [`Learner::save`] filled the file and returned the note.
    pub restore: RestoreFn,
    /// Settings that apply only when weights are loaded; `--from` does not pass them on.
    pub not_inherited: &'static [&'static str],
    /// Settings that say what the networks' inputs and outputs mean: weights that were learnt under others mean something else.
    pub must_match: &'static [&'static str],
}

/// Why an agent cannot start.
#[derive(Debug, thiserror::Error)]
pub enum StartError {
    /// A setting is unknown, of another type or outside its range.
    #[error("the agent's settings: {0}")]
    Settings(String),
    /// candle refuses.
    #[error("the agent cannot start: {}", first_line(.0))]
    Network(#[from] candle_core::Error),
}

impl StartError {
    /// Settings that are refused for this reason.
    pub fn settings(reason: impl Display) -> Self {
        Self::Settings(reason.to_string())
    }
}

/// An agent's settings as an object.
pub fn settings_as_object(settings: &impl Serialize) -> Value {
    // They are numbers, words and lists of them: they can be written.
    note_of(settings).unwrap_or_default()
}

/// Puts `changes` in the place of the values of the same names. Where an agent's defaults have an object, only the parts of it that
/// are named change, and the others stay.
pub fn lay_over(settings: &mut Value, changes: &Value, defaults: &Value) {
    let Some(changes) = changes.as_object() else {
        *settings = changes.clone();
        return;
    };
    if !settings.is_object() {
        *settings = Value::Object(serde_json::Map::new());
    }
    for (name, value) in changes {
        match defaults.get(name) {
            Some(parts) if parts.is_object() => lay_over(&mut settings[name.as_str()], value, parts),
            _ => settings[name.as_str()] = value.clone(),
        }
    }
}

/// An agent's settings, from an object of those that differ from its defaults; of a setting that has parts, of the parts that differ.
///
/// # Errors
/// Where one is unknown or of another type, or `validate` refuses them.
pub fn settings_from<S: Default + Serialize + DeserializeOwned>(
    object: &Value,
    validate: impl Fn(&S) -> Result<(), SettingError>,
) -> Result<S, StartError> {
    let defaults = settings_as_object(&S::default());
    let read = |changes: &Value| {
        let mut settings = defaults.clone();
        lay_over(&mut settings, changes, &defaults);
        S::deserialize(settings)
    };
    // A value that is refused tells what would be accepted in its place.
    let accepted = |name: &str| {
        [json!(0), json!(u32::MAX), json!([0])].into_iter().find_map(|value| {
            let settings = read(&json!({ name: value })).ok()?;
            validate(&settings).err()?.accepted_for(name)
        })
    };
    let settings = read(object).map_err(|error| {
        // Which of them it is, where one alone cannot be read either.
        let alone = |(name, value): (&String, &Value)| {
            let error = read(&json!({ name: value })).err()?.to_string();
            // Settings of earlier versions are read where they mean nothing, and are offered to nobody.
            let error = match error.split_once("expected one of ") {
                Some((what, _)) if defaults.get(name).is_none() => {
                    format!("{what}expected one of {}", names(&defaults))
                }
                _ => error,
            };
            Some(format!("{name} = {value}: {}", told(&error, accepted(name))))
        };
        let named = object.as_object().and_then(|settings| settings.iter().find_map(alone));
        StartError::settings(named.unwrap_or_else(|| told(&error.to_string(), None)))
    })?;
    validate(&settings).map_err(StartError::settings)?;
    Ok(settings)
}

/// The names in an object.
fn names(object: &Value) -> String {
    let names = object.as_object().into_iter().flat_map(serde_json::Map::keys);
    names.map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")
}

/// A message of serde in plain words, with what is accepted where that is known.
fn told(message: &str, accepted: Option<&str>) -> String {
    let message = in_plain_words(message).replace("unknown field", "unknown setting");
    let Some(range) = accepted else { return message };
    let message = message.replace("a whole number from 0 on", "a whole number");
    ["expected a whole number", "expected a number"]
        .iter()
        .fold(message, |message, words| message.replace(words, &format!("{words}; accepted is {range}")))
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

/// What one update reports.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct UpdateStats {
    /// Loss of the critic or the Q-function before the step: mean cross entropy, nats, for `ddpg`; squared error for the thesis' agents.
    pub loss: f64,
    /// Mean value of the agent's own choices: probability of success for `ddpg`, Q for the others.
    pub value: f64,
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
/// does depends on nothing but its own state. Errors are candle's, safetensors' and serde's.
#[expect(clippy::missing_errors_doc, reason = "said of all of them at once")]
pub trait Learner: Debug + Send {
    /// Its [`AgentKind::name`].
    fn agent(&self) -> &'static str;

    /// What it learns.
    fn plan(&self) -> TrainingPlan;

    /// Where it plays.
    fn table(&self) -> &Table;

    /// All its settings, as [`AgentKind::settings`] gives them.
    fn settings(&self) -> Value;

    /// Shots played so far.
    fn shots(&self) -> u64;

    /// How far its learning has come.
    fn progress(&self) -> Progress;

    /// Whether all shots of the plan have been played.
    fn is_finished(&self) -> bool {
        self.shots() >= self.plan().shots
    }

    /// Plays at least one shot and learns. Fails where the networks no longer give finite numbers.
    fn iterate(&mut self) -> candle_core::Result<Iteration>;

    /// Plays one shot on every layout as well as it can, without exploration. Its own state, the random numbers to come
    /// included, stays as it is.
    fn score(&self, layouts: &[Layout]) -> candle_core::Result<Score>;

    /// Its shots on the layouts, as [`Learner::score`] plays them.
    fn shots_on(&self, layouts: &[Layout]) -> candle_core::Result<Vec<CueInputs>>;

    /// The bytes of a policy file, for agents whose policy the coach can use. `held_out_reward` is what it has been
    /// measured to earn, `date` the day on which the run was started. That of a finished run may take minutes of calibration: meanwhile
    /// `go_on` is asked again and again, and once it says no there are no bytes either.
    fn policy(
        &self,
        _held_out_reward: f64,
        _date: &str,
        _go_on: &mut dyn FnMut() -> bool,
    ) -> Result<Option<Vec<u8>>, WeightsError> {
        Ok(None)
    }

    /// Adds the arrays of its whole state to a file and returns everything else (`note_of`).
    fn save(&self, writer: &mut Writer) -> Result<Value, WeightsError>;

    /// Takes the weights, and nothing but the weights, from a file that [`Learner::save`] filled, or a policy file, of
    /// the same kind of agent. Where the file has no such weights, or some of other sizes, it stays as it is.
    fn load_weights(&mut self, weights: &Reader<'_>) -> Result<(), WeightsError>;
}

/// What serde makes of `note`, its numbers written as shortly as they are in a file (`f32` as well as `f64`).
pub(crate) fn note_of(note: &impl Serialize) -> Result<Value, WeightsError> {
    let text = serde_json::to_string(note).map_err(safetensors::SafeTensorError::from)?;
    Ok(serde_json::from_str(&text).map_err(safetensors::SafeTensorError::from)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_of_a_setting_are_laid_over_the_others_for_every_agent() {
        for (agent, changes, part, other) in [
            ("ddpg", json!({"exploration": {"uniform": 0.05}}), "/exploration/uniform", "/exploration/noise"),
            ("q-learning", json!({"epsilon": {"first": 0.5}}), "/epsilon/first", "/epsilon/over"),
            ("dqn", json!({"epsilon": {"last": 0.5}}), "/epsilon/last", "/epsilon/first"),
            ("thesis-ddpg", json!({"noise": {"sigma": 1.0}}), "/noise/sigma", "/noise/theta"),
        ] {
            let kind = AgentKind::named(agent).unwrap();
            let plan = TrainingPlan { reward: Reward::R1, seed: 1, shots: 1 };
            let settings = |changes: &Value| (kind.start)(plan, Table::default(), changes).unwrap().settings();
            let (changed, defaults) = (settings(&changes), settings(&json!({})));
            assert_eq!(changed.pointer(part), changes.pointer(part), "{agent}");
            assert_eq!(changed.pointer(other), defaults.pointer(other), "{agent}");
            assert_eq!(
                (defaults, settings(&changed)),
                ((kind.settings)(&json!({})).unwrap(), changed.clone()),
                "{agent}"
            );
            assert_eq!((kind.settings)(&changes).unwrap(), changed, "{agent}");
        }
    }

    #[test]
    fn what_is_one_word_or_another_is_replaced_as_a_whole() {
        let defaults = json!({"episode": "one-shot", "noise": {"theta": 1, "sigma": 2}});
        let mut settings = json!({"episode": {"shots": 20}, "noise": {"theta": 3}});
        lay_over(&mut settings, &json!({"episode": {"until-miss": 5}, "noise": {"sigma": 4}}), &defaults);
        assert_eq!(settings, json!({"episode": {"until-miss": 5}, "noise": {"theta": 3, "sigma": 4}}));
    }
}
