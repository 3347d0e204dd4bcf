//! The interface between a training run and any agent: [`Learner`], its kinds, plan, settings and progress.

use std::fmt::Debug;

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

/// A new or restored agent, or why there is none.
pub type Created<E> = Result<Box<dyn Learner>, E>;

/// A kind of agent: how to create it untrained, and how to restore a saved one.
#[derive(Clone, Copy, Debug)]
pub struct AgentKind {
    /// Name on the command line and in files.
    pub name: &'static str,
    /// Description in one line, for users.
    pub title: &'static str,
    /// Returns all settings, from an object of those that differ from the agent's defaults.
    pub settings: fn(&Value) -> Result<Value, StartError>,
    /// Returns an object of settings with their current names in place of those of earlier versions. Fails if it contains both names of
    /// one setting.
    pub current_names: fn(&Value) -> Result<Value, StartError>,
    /// Creates an untrained agent for a plan on a table. The value is an object of the settings that differ from the agent's defaults.
    pub start: fn(TrainingPlan, Table, &Value) -> Created<StartError>,
    /// Restores the learner whose [`Learner::save`] filled the file and returned the note.
    pub restore: fn(&Reader<'_>, Value) -> Created<WeightsError>,
    /// Settings that apply only when weights are loaded; `--from` does not pass them on.
    pub not_inherited: &'static [&'static str],
    /// Settings that define the meaning of the networks' inputs and outputs. Weights are usable only with equal values of these.
    pub must_match: &'static [&'static str],
}

/// Why an agent cannot start.
#[derive(Debug, thiserror::Error)]
pub enum StartError {
    /// A setting is unknown, of another type or outside its range.
    #[error("the agent's settings: {0}")]
    Settings(String),
    /// candle reports an error.
    #[error("the agent cannot start: {}", first_line(.0))]
    Network(#[from] candle_core::Error),
}

/// Returns an agent's settings as a JSON object.
pub fn settings_as_object(settings: &impl Serialize) -> Value {
    // Settings are numbers, words and lists of them, which always serialize.
    note_of(settings).unwrap_or_default()
}

/// Merges `changes` into `settings` by name. A setting that is an object in the agent's defaults is merged part by part; any other
/// value is replaced as a whole.
pub fn merge_settings(settings: &mut Value, changes: &Value, defaults: &Value) {
    let Some(changes) = changes.as_object() else {
        *settings = changes.clone();
        return;
    };
    if !settings.is_object() {
        *settings = json!({});
    }
    for (name, value) in changes {
        match defaults.get(name) {
            Some(parts) if parts.is_object() => merge_settings(&mut settings[name.as_str()], value, parts),
            _ => settings[name.as_str()] = value.clone(),
        }
    }
}

/// Returns an object of settings with their current names in place of those of earlier versions, which are the serde aliases of `S`. Fails
/// if it contains both names of one setting.
pub(crate) fn current_names<S: Default + Serialize + DeserializeOwned>(object: &Value) -> Result<Value, StartError> {
    let Value::Object(given) = object else { return Ok(object.clone()) };
    let Value::Object(defaults) = settings_as_object(&S::default()) else { return Ok(object.clone()) };
    let mut settings = serde_json::Map::new();
    for (name, value) in given {
        // With an alias next to its current name, serde reports the same field twice.
        let is_alias = |(current, default): &(&String, &Value)| {
            let both = S::deserialize(json!({ current.as_str(): default, name: default }));
            both.is_err_and(|error| error.to_string() == format!("duplicate field `{current}`"))
        };
        let current = defaults.iter().find(is_alias).map_or(name, |(current, _)| current);
        if current != name && given.contains_key(current) {
            let reason = format!("{name} is the earlier name of {current}, and both are given; leave out one of them");
            return Err(StartError::Settings(reason));
        }
        settings.insert(current.clone(), value.clone());
    }
    Ok(settings.into())
}

/// Returns an agent's settings, from an object of the settings (or parts of settings) that differ from its defaults. Fails if a setting is
/// unknown or of another type, or if `validate` refuses the settings.
pub(crate) fn settings_from<S: Default + Serialize + DeserializeOwned>(
    object: &Value,
    validate: impl Fn(&S) -> Result<(), SettingError>,
) -> Result<S, StartError> {
    let (object, defaults) = (&current_names::<S>(object)?, settings_as_object(&S::default()));
    let read = |changes: &Value| {
        let mut settings = defaults.clone();
        merge_settings(&mut settings, changes, &defaults);
        S::deserialize(settings)
    };
    // Finds the accepted range of a setting: the error for a value outside the range contains it.
    let accepted = |name: &str| {
        [json!(0), json!(u32::MAX), json!([0])].into_iter().find_map(|value| {
            let settings = read(&json!({ name: value })).ok()?;
            validate(&settings).err().filter(|error| error.name == name).map(|error| error.accepted)
        })
    };
    let settings = read(object).map_err(|error| {
        // Names the setting at fault: the first that cannot be read on its own either.
        let error_of = |(name, value): (&String, &Value)| {
            let error = read(&json!({ name: value })).err()?.to_string();
            // Settings of earlier versions are accepted without effect, but the message must not offer them.
            let error = match error.split_once("expected one of ") {
                Some((start, _)) if defaults.get(name).is_none() => {
                    let known = defaults.as_object().into_iter().flat_map(serde_json::Map::keys);
                    let known: Vec<_> = known.map(|name| format!("`{name}`")).collect();
                    format!("{start}expected one of {}", known.join(", "))
                }
                _ => error,
            };
            Some(format!("{name} = {value}: {}", plain_message(&error, accepted(name))))
        };
        let named = object.as_object().and_then(|settings| settings.iter().find_map(error_of));
        StartError::Settings(named.unwrap_or_else(|| plain_message(&error.to_string(), None)))
    })?;
    validate(&settings).map_err(|error| StartError::Settings(error.to_string()))?;
    Ok(settings)
}

/// Rewrites a message of serde in plain words and adds the accepted range, if it is known.
fn plain_message(message: &str, accepted: Option<&str>) -> String {
    let message = in_plain_words(message).replace("unknown field", "unknown setting");
    let Some(range) = accepted else { return message };
    let message = message.replace("a whole number from 0 on", "a whole number");
    let with_range = |message: String, words| message.replace(words, &format!("{words}; accepted is {range}"));
    ["expected a whole number", "expected a number"].into_iter().fold(message, with_range)
}

/// Goal and length of a training; the same fields for every agent.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct TrainingPlan {
    /// The reward function.
    pub reward: Reward,
    /// Seed of all random numbers.
    pub seed: u64,
    /// Shots to play.
    pub shots: u64,
}

/// Statistics of one iteration: a rollout and its updates.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Iteration {
    /// Mean reward of the shots played, exploration included.
    pub mean_reward: f64,
    /// Mean value that the agent assigns to its own choices, in the units in which it learns: the critic's mean over the
    /// actor's actions, or the mean of the largest Q.
    pub q_value: f64,
    /// Loss of the critic or of the Q-function; 0 if the iteration made no update.
    pub critic_loss: f64,
    /// Loss of the actor, for agents that have one.
    pub actor_loss: Option<f64>,
}

/// Statistics of one update.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct UpdateStats {
    /// Loss of the critic or the Q-function before the step: mean cross entropy, nats, for `ddpg`; squared error for the thesis' agents.
    pub loss: f64,
    /// Mean value of the agent's own choices: probability of success for `ddpg`, Q for the others.
    pub value: f64,
}

/// Progress of an agent's learning.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Updates made so far.
    pub updates: u64,
    /// Current learning rate of the critic or of the Q-function.
    pub learning_rate: f64,
    /// Current strength of exploration: the probability of a shot drawn uniformly from all actions (`ddpg` also adds noise to most of
    /// its other shots), or, for `thesis-ddpg`, the standard deviation of its noise in units of half an action's range.
    pub exploration: f64,
    /// Filled share of the replay buffer; `None` for agents without one.
    pub replay_fill: Option<f64>,
}

/// An agent in training. Its behaviour depends on nothing but its own state: saved between any two iterations and restored, it
/// continues bit for bit as if it had not been interrupted. Errors are those of candle, safetensors and serde.
#[expect(clippy::missing_errors_doc, reason = "the trait's documentation states the errors of all methods")]
pub trait Learner: Debug + Send {
    /// The agent's [`AgentKind::name`].
    fn agent(&self) -> &'static str;

    /// Goal and length of the training.
    fn plan(&self) -> TrainingPlan;

    /// The table on which the agent plays.
    fn table(&self) -> &Table;

    /// All settings, in the form of [`AgentKind::settings`].
    fn settings(&self) -> Value;

    /// Shots played so far.
    fn shots(&self) -> u64;

    /// Progress of the learning.
    fn progress(&self) -> Progress;

    /// Whether all shots of the plan have been played.
    fn is_finished(&self) -> bool {
        self.shots() >= self.plan().shots
    }

    /// Plays at least one shot and learns. Fails if the networks no longer return finite numbers.
    fn iterate(&mut self) -> candle_core::Result<Iteration>;

    /// Plays one shot on every layout without exploration and returns the score. Does not change the agent's state, its random
    /// number generator included.
    fn score(&self, layouts: &[Layout]) -> candle_core::Result<Score>;

    /// Returns the shots that [`Learner::score`] plays on the layouts.
    fn choose_shots(&self, layouts: &[Layout]) -> candle_core::Result<Vec<CueInputs>>;

    /// Returns the bytes of a policy file; `None` for agents whose policy the coach cannot use. `held_out_reward` is the measured mean
    /// reward on held-out layouts, `date` the day on which the run started. For a finished run the calibration may take minutes:
    /// `go_on` is called repeatedly meanwhile, and the result is `None` once it returns `false`.
    fn policy(
        &self,
        _held_out_reward: f64,
        _date: &str,
        _go_on: &mut dyn FnMut() -> bool,
    ) -> Result<Option<Vec<u8>>, WeightsError> {
        Ok(None)
    }

    /// Adds the arrays of the whole state to a file and returns the rest of the state as a note (`note_of`).
    fn save(&self, writer: &mut Writer) -> Result<Value, WeightsError>;

    /// Loads only the weights, from a file that [`Learner::save`] filled or from a policy file, of the same kind of agent. If the
    /// weights are missing or of other sizes, the agent stays unchanged.
    fn load_weights(&mut self, weights: &Reader<'_>) -> Result<(), WeightsError>;
}

/// Serializes `note`, with its numbers as short as in a file (`f32` as well as `f64`).
pub(crate) fn note_of(note: &impl Serialize) -> Result<Value, WeightsError> {
    let text = serde_json::to_string(note).map_err(safetensors::SafeTensorError::from)?;
    Ok(serde_json::from_str(&text).map_err(safetensors::SafeTensorError::from)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_of_a_setting_are_merged_for_every_agent() {
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
            assert_eq!(defaults, (kind.settings)(&json!({})).unwrap(), "{agent}");
            assert_eq!(settings(&changed), changed, "{agent}");
            assert_eq!((kind.settings)(&changes).unwrap(), changed, "{agent}");
        }
    }

    #[test]
    fn settings_that_are_no_objects_are_replaced_whole() {
        let defaults = json!({"episode": "one-shot", "noise": {"theta": 1, "sigma": 2}});
        let mut settings = json!({"episode": {"shots": 20}, "noise": {"theta": 3}});
        merge_settings(&mut settings, &json!({"episode": {"until-miss": 5}, "noise": {"sigma": 4}}), &defaults);
        assert_eq!(settings, json!({"episode": {"until-miss": 5}, "noise": {"theta": 3, "sigma": 4}}));
    }
}
