//! A training run on disk: its folder, and the order in which it is written.
//!
//! A run can be killed at any moment. The order of writing sees to it that what it goes on from is complete: first the
//! policy, then the lines of metrics, last the checkpoint; whatever is younger than the checkpoint is done again,
//! to the same bits. What takes long comes after the checkpoint: the measurement and the policy of a run that is stopped, and of one
//! that is finished the policy, which is calibrated. Its result comes last of all, and until that is there its policy is written again.

mod checkpoint;
mod config;
mod error;
mod event_file;
pub mod examples;
pub mod follow;
mod heartbeat;
pub mod history;
mod json;
pub mod list;
pub mod metrics;
mod number;
pub(crate) mod origin;
pub mod quantity;
pub mod request;
pub(crate) mod seeds;
pub mod status;
mod training;

use std::{
    io::ErrorKind,
    path::{Path, PathBuf},
};

pub(crate) use self::checkpoint::Accumulator;
pub use self::{
    checkpoint::agent_of_checkpoint,
    config::{Config, Provenance, Schedule, run_name},
    error::RunError,
    training::{Ending, Limits, Watcher},
};
use self::{
    checkpoint::{Checkpoints, Loaded, State},
    error::file,
    metrics::MetricsFile,
};
use crate::{
    learning::{evaluation::Score, learner::Learner},
    storage::{self, Lock, remove_partial_files, write_atomic},
};

/// The metrics' file in a run's folder.
pub const METRICS: &str = "metrics.jsonl";

/// The policy's file in a run's folder.
pub const POLICY: &str = "policy.safetensors";

/// What a run has come to: it is there once the run is finished, and taken away when it goes on.
const RESULT: &str = "result.json";

/// Mean reward on the held-out layouts there, without exploration: what is to be made large.
const REWARD: &str = "held_out_reward";

/// Share of those layouts there in which any proposal earns at least 1.
const BEST_OF_K: &str = "held_out_reach";

/// All that a run writes into its folder, the lock last.
const FILES: [&str; 11] = [
    config::FILE,
    METRICS,
    event_file::FILE,
    RESULT,
    POLICY,
    checkpoint::CURRENT,
    checkpoint::PREVIOUS,
    examples::FILE,
    status::FILE,
    request::FILE,
    Lock::FILE,
];

/// What the run in `folder` was started with; where it cannot be read, its checkpoint has the same values.
pub fn config_of(folder: &Path) -> Option<Config> {
    let of_checkpoint = || {
        let (_, Loaded { learner, state, .. }) = Checkpoints::open(folder).ok()?;
        Some(Config::of(learner.as_ref(), state.schedule, state.from))
    };
    Config::read(folder).ok().or_else(of_checkpoint)
}

/// A run and its folder, which is this process' own as long as the run lives.
#[derive(Debug)]
pub struct Run {
    folder: PathBuf,
    config: Config,
    learner: Box<dyn Learner>,
    state: State,
    checkpoints: Checkpoints,
    _lock: Lock,
}

impl Run {
    /// A new run of `learner` in `folder`, which is made where it is missing.
    ///
    /// # Errors
    /// [`RunError::Occupied`] where it holds a run already, [`RunError::NoFolder`] where it is a file.
    pub fn create(
        folder: &Path,
        learner: Box<dyn Learner>,
        schedule: Schedule,
        from: Option<Provenance>,
    ) -> Result<Self, RunError> {
        make_folder(folder)?;
        let lock = lock(folder)?;
        refuse_taken(folder, None)?;
        let config = Config::of(learner.as_ref(), schedule, from.clone());
        let state = State { schedule, from, accumulator: Accumulator::default() };
        let checkpoints = Checkpoints::new(folder);
        let mut run = Self { folder: folder.to_owned(), config, learner, state, checkpoints, _lock: lock };
        // First of all something to go on from, however early the run is killed.
        run.write_checkpoint()?;
        run.config.write(folder)?;
        Ok(run)
    }

    /// The run in `folder` as its last whole checkpoint left it, and sentences about what may make
    /// it another run than the one that was interrupted: the last checkpoint is damaged, or this is another carom; also where the
    /// last line of its metrics was cut off, which is then left out, and where lines are missing.
    ///
    /// # Errors
    /// Where there is no whole checkpoint, or another process works in the folder.
    pub fn resume(folder: &Path) -> Result<(Self, Vec<String>), RunError> {
        if !holds_checkpoints(folder) {
            return Err(RunError::Missing(folder.display().to_string()));
        }
        let lock = lock(folder)?;
        let (checkpoints, loaded) = Checkpoints::open(folder)?;
        let mut notices: Vec<String> = loaded.notice().into_iter().collect();
        let Loaded { learner, state, .. } = loaded;
        notices.extend(metrics::notices(&folder.join(METRICS), learner.shots(), state.schedule.log_every));
        let config = Config::read(folder).or_else(|error| {
            let config = Config::of(learner.as_ref(), state.schedule, state.from.clone());
            if error.kind() == ErrorKind::NotFound {
                // It was killed before it had one, or it was removed.
                config.write(folder)?;
            } else {
                // It may still tell somebody when and by which version the run was started.
                let unreadable = config::unreadable(folder, &error);
                notices
                    .push(format!("{unreadable} and stays as it is; the run goes on without it, from its checkpoint"));
            }
            Ok::<_, RunError>(config)
        })?;
        if !learner.is_finished() {
            notices.extend(config.other_program());
            // What an earlier process said of itself holds no more, now that one goes on.
            let _ = std::fs::remove_file(folder.join(status::FILE));
        }
        let folder = folder.to_owned();
        Ok((Self { folder, config, learner, state, checkpoints, _lock: lock }, notices))
    }

    /// What it has come to, where it has played all its shots and said so.
    pub fn result(&self) -> Option<Score> {
        let result: serde_json::Value = json::read(&self.folder.join(RESULT), storage::SMALL).ok()?;
        let number = |name: &str| result.get(name)?.as_f64();
        let score = Score { mean_reward: number(REWARD)?, best_of_k: number(BEST_OF_K)? };
        self.learner.is_finished().then_some(score)
    }

    /// The run's folder.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Who learns.
    pub fn learner(&self) -> &dyn Learner {
        self.learner.as_ref()
    }

    /// Where the policy is written, if the agent has one that the coach can use.
    pub fn policy_path(&self) -> PathBuf {
        self.folder.join(POLICY)
    }

    /// Writes the policy of a run that goes on, the lines that wait and the checkpoint, in this order.
    fn save(&mut self, metrics: &mut MetricsFile, score: Option<Score>) -> Result<(), RunError> {
        if let Some(score) = score.filter(|_| !self.learner.is_finished()) {
            self.write_policy(score, &mut || true)?;
        }
        metrics.sync().map_err(file(&self.folder.join(METRICS)))?;
        self.write_checkpoint()
    }

    /// Writes the policy, unless `go_on` says no before it is there.
    fn write_policy(&self, score: Score, go_on: &mut dyn FnMut() -> bool) -> Result<(), RunError> {
        let path = self.policy_path();
        match self.learner.policy(score.mean_reward, self.config.day(), go_on)? {
            Some(bytes) => write_atomic(&path, &bytes).map_err(file(&path)),
            None => Ok(()),
        }
    }

    fn write_checkpoint(&mut self) -> Result<(), RunError> {
        let bytes = checkpoint::bytes(self.learner.as_ref(), &self.state)?;
        self.checkpoints.write(&bytes).map_err(file(&self.folder.join(checkpoint::CURRENT)))
    }

    fn unsaved(&self, reason: RunError) -> RunError {
        let folder = self.folder.display().to_string();
        RunError::Unsaved { shots: self.learner.shots(), reason: Box::new(reason), folder }
    }
}

/// Whether `folder` holds a run: something to go on from.
pub fn holds_checkpoints(folder: &Path) -> bool {
    [checkpoint::CURRENT, checkpoint::PREVIOUS].iter().any(|name| folder.join(name).exists())
}

/// Ends a run that shall not be kept: removes what it has written into its folder, and the folder if nothing else is in
/// it.
///
/// # Errors
/// [`RunError::Missing`], [`RunError::Busy`], or whatever the file system reports.
pub fn discard(folder: &Path) -> Result<(), RunError> {
    if !holds_checkpoints(folder) {
        return Err(RunError::Missing(folder.display().to_string()));
    }
    let _lock = lock(folder)?;
    for name in FILES {
        match std::fs::remove_file(folder.join(name)) {
            Err(error) if error.kind() != ErrorKind::NotFound => return Err(file(&folder.join(name))(error)),
            _ => {}
        }
    }
    // Somebody may have put something else there, which is not ours to remove.
    let _ = std::fs::remove_dir(folder);
    Ok(())
}

/// Makes a folder where it is missing.
fn make_folder(folder: &Path) -> Result<(), RunError> {
    // Also above it: a file there cannot hold it.
    if let Some(in_the_way) = folder.ancestors().find(|path| path.exists() && !path.is_dir()) {
        return Err(RunError::NoFolder(in_the_way.display().to_string()));
    }
    std::fs::create_dir_all(folder).map_err(file(folder))
}

/// Refuses a folder in which anything but `own` is: a run, or files that no run has written. A run would write over some of them.
fn refuse_taken(folder: &Path, own: Option<&str>) -> Result<(), RunError> {
    let name = || folder.display().to_string();
    let holds = |file: &&str| folder.join(file).exists();
    if [config::FILE, checkpoint::CURRENT, checkpoint::PREVIOUS].iter().any(holds) || seeds::is_group(folder) {
        return Err(RunError::Occupied(name()));
    }
    for entry in std::fs::read_dir(folder).map_err(file(folder))? {
        let entry = entry.map_err(file(folder))?.file_name();
        if entry != Lock::FILE && own.is_none_or(|own| entry != *own) {
            return Err(RunError::Foreign { folder: name(), entry: entry.to_string_lossy().into_owned() });
        }
    }
    Ok(())
}

/// Takes possession of a folder, and clears away what was being written there when the last owner was killed.
fn lock(folder: &Path) -> Result<Lock, RunError> {
    let busy = || RunError::Busy(folder.display().to_string());
    let lock = Lock::take(folder).map_err(file(&folder.join("lock")))?.ok_or_else(busy)?;
    remove_partial_files(folder).map_err(file(folder))?;
    Ok(lock)
}

#[cfg(test)]
mod tests;
