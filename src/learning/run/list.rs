//! The list of runs in a folder, with their progress.

use std::{
    collections::HashMap,
    io,
    path::{Path, PathBuf},
    time::{Duration, SystemTime},
};

use serde::Serialize;

use super::{
    METRICS,
    checkpoint::shots_in,
    config::{self, Config},
    contains_run,
    follow::{Condition, Followed, Follower},
    status,
};
use crate::{
    game::Reward,
    printing::{format_utc, unix_seconds},
};

/// Summary of a run, for one line of a list.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Summary {
    /// Its folder, relative to the listed folder.
    pub name: String,
    /// Its agent.
    pub agent: String,
    /// Its reward.
    pub reward: Reward,
    /// Name of its table.
    pub table: String,
    /// Its seed.
    pub seed: u64,
    /// Shots played.
    pub shots: u64,
    /// Shots planned.
    pub planned_shots: u64,
    /// Largest mean reward on held-out layouts; `None` before the first evaluation.
    pub best_reward: Option<f64>,
    /// Latest mean reward on held-out layouts.
    pub last_reward: Option<f64>,
    /// Time of the start, UTC.
    pub started: String,
    /// Time of the last change of its files, UTC.
    pub changed: String,
    /// Its condition. The time of a stalled run is left out, because it changes every second.
    pub state: Condition,
    /// Its folder.
    #[serde(skip)]
    pub folder: PathBuf,
}

/// Lists the runs in `folder` by name, including those of groups of seeds. If `folder` is a run itself, it is the only one.
///
/// # Errors
/// The errors of the file system for the folder.
pub fn runs_in(folder: &Path) -> io::Result<Listing> {
    RunsFolder::new(folder).poll()
}

/// The runs in a folder.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Listing {
    /// The runs that can be read.
    pub runs: Vec<Summary>,
    /// A message for each run that cannot be read.
    pub unreadable: Vec<String>,
}

/// The runs in a folder, for repeated listing. Each run is followed, so that its files are read only if they have changed.
#[derive(Debug)]
pub(crate) struct RunsFolder {
    folder: PathBuf,
    known: HashMap<PathBuf, (Follower, Followed)>,
}

impl RunsFolder {
    /// Creates the list of the runs in `folder`.
    pub fn new(folder: &Path) -> Self {
        Self { folder: folder.to_owned(), known: HashMap::new() }
    }

    /// Lists the runs once.
    pub fn poll(&mut self) -> io::Result<Listing> {
        let mut listing = Listing::default();
        let folders = run_folders(&self.folder)?;
        self.known.retain(|known, _| folders.iter().any(|(_, folder)| folder == known));
        for (name, folder) in folders {
            match Config::read(&folder) {
                Ok(config) => listing.runs.push(self.summary(&folder, name, config)),
                Err(error) => {
                    listing.unreadable.push(format!("{name}: {}", config::unreadable_message(&folder, &error)));
                }
            }
        }
        Ok(listing)
    }

    fn summary(&mut self, folder: &Path, name: String, config: Config) -> Summary {
        let Config { agent, plan, started, table, .. } = config;
        let new = || (Follower::new(folder), Followed::new(folder));
        let (follower, run) = self.known.entry(folder.to_owned()).or_insert_with(new);
        if let Some(update) = follower.poll() {
            run.apply(update);
        }
        let shots = match run.shots() {
            0 => shots_in(folder).unwrap_or(0),
            shots => shots,
        };
        Summary {
            name,
            agent,
            reward: plan.reward,
            table: table.name,
            seed: plan.seed,
            shots,
            planned_shots: plan.shots,
            best_reward: run.best(),
            last_reward: run.held_out(),
            changed: last_written(folder).map_or_else(|| started.clone(), |time| format_utc(unix_seconds(time))),
            started,
            state: match follower.condition_after(shots, plan.shots) {
                Condition::Stalled(_) => Condition::Stalled(Duration::ZERO),
                state => state,
            },
            folder: folder.to_owned(),
        }
    }
}

/// Returns the folder of the run in `folder`, including groups of seeds, whose files changed last.
pub fn latest_in(folder: &Path) -> Option<PathBuf> {
    run_folders(folder).ok()?.into_iter().map(|(_, run)| run).max_by_key(|run| last_written(run))
}

/// Returns the time at which the run in `folder` last wrote one of its files.
fn last_written(folder: &Path) -> Option<SystemTime> {
    let written = |name: &str| std::fs::metadata(folder.join(name)).and_then(|data| data.modified()).ok();
    [status::FILE, METRICS, config::FILE].into_iter().filter_map(written).max()
}

/// Returns the names relative to `folder` and the paths of its runs, in order, including groups of seeds; only `folder` if it is a run
/// itself.
fn run_folders(folder: &Path) -> io::Result<Vec<(String, PathBuf)>> {
    if contains_run(folder) {
        return Ok(vec![(name_of(folder), folder.to_owned())]);
    }
    let mut runs = Vec::new();
    for path in folders_in(folder)? {
        let name = name_of(&path);
        if contains_run(&path) {
            runs.push((name, path));
        } else {
            let members = folders_in(&path).unwrap_or_default().into_iter().filter(|path| contains_run(path));
            runs.extend(members.map(|member| (format!("{name}/{}", name_of(&member)), member)));
        }
    }
    Ok(runs)
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
