//! What runs there are, and how far they have come.

use std::{
    io,
    path::{Path, PathBuf},
    time::SystemTime,
};

use serde::Serialize;

use super::metrics;
use super::{
    METRICS,
    checkpoint::shots_in,
    config::{self, Config},
    holds_checkpoints, standing,
};
use crate::{game::Reward, learning::calendar::moment, storage::Lock};

/// Whether a run is at work.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Stage {
    /// A process is training it.
    Running,
    /// All shots have been played.
    Finished,
    /// It can go on.
    Interrupted,
}

impl Stage {
    /// In a word.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Running => "running",
            Self::Finished => "finished",
            Self::Interrupted => "interrupted",
        }
    }
}

/// A run in a line.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Summary {
    /// Its folder below the one that was listed.
    pub name: String,
    /// Its agent.
    pub agent: String,
    /// What it is rewarded for.
    pub reward: Reward,
    /// Name of its table.
    pub table: String,
    /// Its seed.
    pub seed: u64,
    /// Shots played, as of its last checkpoint.
    pub shots: u64,
    /// Shots planned.
    pub planned_shots: u64,
    /// Largest mean reward on held-out layouts; none before the first measurement.
    pub best_reward: Option<f64>,
    /// The last one.
    pub last_reward: Option<f64>,
    /// When it was started, UTC.
    pub started: String,
    /// When it last wrote something, UTC.
    pub changed: String,
    /// Whether it is at work.
    pub state: Stage,
}

/// The runs in `folder`, those of a group of seeds included, by name. A folder that is a run itself is the only one.
///
/// # Errors
/// Whatever the file system reports of the folder. A run that cannot be read is left out.
pub fn runs_in(folder: &Path) -> io::Result<Vec<Summary>> {
    if let Some(summary) = summary(folder, &name_of(folder)) {
        return Ok(vec![summary]);
    }
    let mut runs = Vec::new();
    for path in folders_in(folder)? {
        let name = name_of(&path);
        if let Some(summary) = summary(&path, &name) {
            runs.push(summary);
            continue;
        }
        let members = folders_in(&path).unwrap_or_default();
        runs.extend(members.iter().filter_map(|member| summary(member, &format!("{name}/{}", name_of(member)))));
    }
    Ok(runs)
}

/// The folder of the run in `folder`, groups of seeds included, that was the last to write something.
pub fn latest_in(folder: &Path) -> Option<PathBuf> {
    let inner = |folder: &Path| folders_in(folder).unwrap_or_default();
    let (runs, others): (Vec<_>, Vec<_>) = inner(folder).into_iter().partition(|path| holds_checkpoints(path));
    let members = others.iter().flat_map(|group| inner(group)).filter(|path| holds_checkpoints(path));
    runs.into_iter().chain(members).max_by_key(|run| last_written(run))
}

/// When the run in `folder` last wrote one of its files.
fn last_written(folder: &Path) -> Option<SystemTime> {
    let written = |name: &str| std::fs::metadata(folder.join(name)).and_then(|data| data.modified()).ok();
    [standing::FILE, METRICS, config::FILE].into_iter().filter_map(written).max()
}

fn folders_in(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let entries = std::fs::read_dir(folder)?.map(|entry| entry.map(|entry| entry.path()));
    let mut folders = entries.collect::<io::Result<Vec<_>>>()?;
    folders.retain(|path| path.is_dir());
    folders.sort();
    Ok(folders)
}

fn name_of(path: &Path) -> String {
    let path = path.canonicalize().unwrap_or_else(|_| path.to_owned());
    path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default()
}

fn summary(folder: &Path, name: &str) -> Option<Summary> {
    if !holds_checkpoints(folder) {
        return None;
    }
    let Config { agent, plan, started, table, .. } = Config::read(folder).ok()?;
    let metrics_path = folder.join(METRICS);
    let lines = metrics::read(&metrics_path).unwrap_or_default();
    let shots = shots_in(folder).or_else(|| lines.last().map(|line| line.shots)).unwrap_or(0);
    let rewards = || lines.iter().filter_map(|line| line.held_out_reward);
    let changed = std::fs::metadata(&metrics_path).or_else(|_| std::fs::metadata(folder));
    let state = if Lock::is_held(folder) {
        Stage::Running
    } else if shots >= plan.shots {
        Stage::Finished
    } else {
        Stage::Interrupted
    };
    Some(Summary {
        name: name.to_owned(),
        agent,
        reward: plan.reward,
        table: table.name,
        seed: plan.seed,
        shots,
        planned_shots: plan.shots,
        best_reward: rewards().max_by(f64::total_cmp),
        last_reward: rewards().next_back(),
        changed: changed.and_then(|data| data.modified()).map_or_else(|_| started.clone(), moment),
        started,
        state,
    })
}
