//! What `config.json` says of a run.

use std::{fmt::Display, path::Path};

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::{error::RunError, json};
use crate::{
    game::Reward,
    learning::learner::{Learner, TrainingPlan},
    printing::{SOURCE, VERSION, now},
    storage,
    table::Table,
};

/// The file's name.
pub const FILE: &str = "config.json";

/// When a run reports and is measured, in shots: it must not depend on the clock, or a run that was interrupted would
/// give other lines.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Schedule {
    /// Shots between two lines of metrics.
    pub log_every: u64,
    /// Shots between two measurements on held-out layouts, each with a line and a checkpoint.
    pub evaluate_every: u64,
    /// Layouts of a measurement.
    pub evaluation_layouts: usize,
}

/// Fewest shots between two measurements by default: with fewer, a short run would do little but measure itself.
const FEWEST_SHOTS: u64 = 10_000;

/// Lines of metrics for each measurement: a run of an hour has news every one or two seconds.
const LINES: u64 = 50;

/// Layouts of a measurement by default: enough for a standard error of half a percent near 0.95.
const LAYOUTS: usize = 2_000;

impl Schedule {
    /// What suits a run of so many shots: 50 measurements.
    pub fn for_shots(shots: u64) -> Self {
        Self::new((shots / 50).max(FEWEST_SHOTS), LAYOUTS)
    }

    /// Measures every so many shots on so many layouts.
    pub fn new(evaluate_every: u64, evaluation_layouts: usize) -> Self {
        Self { log_every: (evaluate_every / LINES).max(1), evaluate_every: evaluate_every.max(1), evaluation_layouts }
    }
}

/// Whose weights a run started from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Provenance {
    /// The run or the policy, as it was given.
    pub path: String,
    /// Its agent.
    pub agent: String,
    /// Name of its table.
    pub table: String,
    /// Its reward.
    pub reward: Reward,
    /// Its seed.
    pub seed: u64,
    /// Shots that it had practised.
    pub shots: u64,
}

/// The content of `config.json`: for people and for [`super::list`]. A run goes on from its checkpoint alone.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Config {
    /// The agent's name.
    pub agent: String,
    /// Reward, seed and number of shots.
    #[serde(flatten)]
    pub plan: TrainingPlan,
    /// When it was started, UTC.
    pub started: String,
    /// Version of carom that started it.
    pub version: String,
    /// What `git describe` says of the source of that carom; none where it was not built from a checkout.
    pub source: Option<String>,
    /// Whose weights it started from.
    pub from: Option<Provenance>,
    /// When it reports and is measured.
    pub schedule: Schedule,
    /// The agent's settings.
    pub settings: Value,
    /// The table.
    pub table: Table,
}

impl Config {
    /// That of a run that starts now.
    pub fn of(learner: &dyn Learner, schedule: Schedule, from: Option<Provenance>) -> Self {
        Self {
            agent: learner.agent().to_owned(),
            plan: learner.plan(),
            started: now(),
            version: VERSION.to_owned(),
            source: SOURCE.map(str::to_owned),
            from,
            schedule,
            settings: learner.settings(),
            table: learner.table().clone(),
        }
    }

    /// Reads that of the run in `folder`.
    ///
    /// # Errors
    /// Where there is none, or something else.
    pub fn read(folder: &Path) -> std::io::Result<Self> {
        json::read(&folder.join(FILE), storage::SMALL)
    }

    /// Writes it for the run in `folder`.
    pub(super) fn write(&self, folder: &Path) -> Result<(), RunError> {
        json::write(&folder.join(FILE), self)
    }

    /// The version of the carom that started the run, where it is newer than this one.
    pub fn newer_version(&self) -> Option<&str> {
        (numbers(&self.version) > numbers(VERSION)).then_some(self.version.as_str())
    }

    /// A sentence where this is not the carom that started the run.
    pub fn other_program(&self) -> Option<String> {
        let name =
            |version: &str, source: Option<&str>| format!("carom {version} ({})", source.unwrap_or("no checkout"));
        let (theirs, ours) = (name(&self.version, self.source.as_deref()), name(VERSION, SOURCE));
        (theirs != ours).then(|| {
            format!("the run was started by {theirs}, and this is {ours}: it may end in other weights than there")
        })
    }

    /// The day on which it was started, UTC, as 2026-11-20.
    pub fn day(&self) -> &str {
        self.started.get(..10).unwrap_or(&self.started)
    }
}

/// Letters of a table's name in that of a folder.
const LONGEST_TABLE: usize = 40;

/// Default name of a new run's folder: names sort by the `moment` of the start, as `timestamp` gives it.
pub fn run_name(moment: &str, agent: &str, table: &str, reward: Reward, seed: impl Display) -> String {
    let plain = |letter: char| if letter.is_alphanumeric() { letter } else { '_' };
    // A named table has no folder.
    let table: String = table.chars().map(plain).take(LONGEST_TABLE).collect();
    format!("{moment}-{agent}-{table}-{reward}-{seed}")
}

/// A sentence on the configuration in `folder`, which cannot be read for this reason.
pub fn unreadable(folder: &Path, reason: &std::io::Error) -> String {
    let version = || {
        let config: Value = json::read(&folder.join(FILE), storage::SMALL).ok()?;
        let version = config.get("version")?.as_str()?.to_owned();
        (version != VERSION).then_some(version)
    };
    match version() {
        Some(version) => format!("{FILE} is of carom {version} and cannot be read by carom {VERSION}"),
        None => format!("{FILE} cannot be read ({reason})"),
    }
}

/// The numbers of a version, to be compared.
fn numbers(version: &str) -> Vec<u64> {
    version.split(['.', '-', '+']).map_while(|part| part.parse().ok()).collect()
}
