//! The configuration of a run, `config.json`.

use std::{fmt::Display, path::Path};

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::{error::RunError, json};
use crate::{
    game::Reward,
    learning::learner::{Learner, TrainingPlan},
    printing::{COMMIT, VERSION, now},
    storage,
    table::Table,
};

/// File name of the configuration.
pub const FILE: &str = "config.json";

/// When a run writes metrics and evaluates itself, in shots. It must not depend on the clock, or an interrupted run would
/// write other lines.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Schedule {
    /// Shots between two lines of metrics.
    pub log_every: u64,
    /// Shots between two evaluations on held-out layouts, each with a line of metrics and a checkpoint.
    pub evaluate_every: u64,
    /// Layouts per evaluation.
    pub evaluation_layouts: usize,
}

/// Smallest default number of shots between two evaluations: with fewer, a short run would mostly evaluate itself.
const MIN_SHOTS: u64 = 10_000;

/// Lines of metrics per evaluation: a run of an hour writes one every one or two seconds.
const LINES: u64 = 50;

impl Schedule {
    /// Returns the default of `evaluate_every` for a run of `shots` shots: 50 evaluations, or fewer if the run is short.
    pub fn default_interval(shots: u64) -> u64 {
        (shots / 50).max(MIN_SHOTS)
    }

    /// Returns the schedule that evaluates every `evaluate_every` shots on `evaluation_layouts` layouts.
    pub fn new(evaluate_every: u64, evaluation_layouts: usize) -> Self {
        Self { log_every: (evaluate_every / LINES).max(1), evaluate_every: evaluate_every.max(1), evaluation_layouts }
    }
}

/// The run or policy whose weights a run started from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Provenance {
    /// Path or name of the run or the policy, as the user gave it.
    pub path: String,
    /// Its agent.
    pub agent: String,
    /// Name of its table.
    pub table: String,
    /// Its reward.
    pub reward: Reward,
    /// Its seed.
    pub seed: u64,
    /// Shots played in its training.
    pub shots: u64,
}

/// The content of `config.json`, for users and for [`super::list`]. Resuming a run needs only its checkpoint.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Config {
    /// The agent's name.
    pub agent: String,
    /// Reward, seed and number of shots.
    #[serde(flatten)]
    pub plan: TrainingPlan,
    /// Time of the start, UTC.
    pub started: String,
    /// Version of carom that started it.
    pub version: String,
    /// Output of `git describe` for the source of that carom; `None` if it was not built from a checkout.
    pub source: Option<String>,
    /// Origin of the weights that it started from.
    pub from: Option<Provenance>,
    /// When it writes metrics and evaluates itself.
    pub schedule: Schedule,
    /// The agent's settings.
    pub settings: Value,
    /// The table.
    pub table: Table,
}

impl Config {
    /// Creates the configuration of a run that starts now.
    pub fn of(learner: &dyn Learner, schedule: Schedule, from: Option<Provenance>) -> Self {
        Self {
            agent: learner.agent().to_owned(),
            plan: learner.plan(),
            started: now(),
            version: VERSION.to_owned(),
            source: COMMIT.map(str::to_owned),
            from,
            schedule,
            settings: learner.settings(),
            table: learner.table().clone(),
        }
    }

    /// Reads the configuration of the run in `folder`.
    pub(crate) fn read(folder: &Path) -> std::io::Result<Self> {
        json::read(&folder.join(FILE), storage::MAX_SMALL_FILE)
    }

    /// Writes the configuration of the run in `folder`.
    pub(super) fn write(&self, folder: &Path) -> Result<(), RunError> {
        json::write(&folder.join(FILE), self)
    }

    /// Returns the version of carom that started the run if it is newer than this one.
    pub fn newer_version(&self) -> Option<&str> {
        (numbers(&self.version) > numbers(VERSION)).then_some(self.version.as_str())
    }

    /// Returns a warning if another version or build of carom started the run.
    pub fn other_program(&self) -> Option<String> {
        let name =
            |version: &str, source: Option<&str>| format!("carom {version} ({})", source.unwrap_or("no checkout"));
        let (theirs, ours) = (name(&self.version, self.source.as_deref()), name(VERSION, COMMIT));
        (theirs != ours)
            .then(|| format!("the run was started by {theirs}, and this is {ours}: the final weights may differ"))
    }
}

/// Largest number of characters of a table's name in a folder's name.
const MAX_TABLE_NAME: usize = 40;

/// Returns the default name of a new run's folder. Names sort by the `moment` of the start, in the format of `timestamp`.
pub fn run_name(moment: &str, agent: &str, table: &str, reward: Reward, seed: impl Display) -> String {
    let plain = |letter: char| if letter.is_alphanumeric() { letter } else { '_' };
    // A table's name may contain characters that a folder's name must not, such as path separators.
    let table: String = table.chars().map(plain).take(MAX_TABLE_NAME).collect();
    format!("{moment}-{agent}-{table}-{reward}-{seed}")
}

/// Returns the message about a configuration in `folder` that cannot be read for this reason.
pub fn unreadable_message(folder: &Path, reason: &std::io::Error) -> String {
    let version = || {
        let config: Value = json::read(&folder.join(FILE), storage::MAX_SMALL_FILE).ok()?;
        let version = config.get("version")?.as_str()?.to_owned();
        (version != VERSION).then_some(version)
    };
    match version() {
        Some(version) => format!("{FILE} was written by carom {version} and cannot be read by carom {VERSION}"),
        None => format!("{FILE} cannot be read ({reason})"),
    }
}

/// Parses the numbers of a version, for comparison.
fn numbers(version: &str) -> Vec<u64> {
    version.split(['.', '-', '+']).map_while(|part| part.parse().ok()).collect()
}
