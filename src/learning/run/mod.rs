//! A training run on disk: its folder, and the order in which its files are written.
//!
//! A run can be killed at any moment. The order of writing guarantees a complete state to resume from: first the
//! policy, then the lines of metrics, last the checkpoint. A resumed run repeats everything after the checkpoint, bit for bit.
//! Slow steps come after the checkpoint: for a stopped run the evaluation and the policy, for a finished run the calibrated policy.
//! The result of a finished run is written last; until it exists, resuming the run writes the policy again.

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
    training::{Ending, Limits, Report},
};
use self::{
    checkpoint::{Checkpoints, Loaded, State},
    error::file,
    metrics::{MetricsFile, Record},
};
use crate::{
    learning::{evaluation::Score, learner::Learner},
    storage::{self, Lock, remove_if_exists, remove_partial_files, write_atomic},
};

/// File name of the metrics in a run's folder.
pub const METRICS: &str = "metrics.jsonl";

/// File name of the policy in a run's folder.
pub const POLICY: &str = "policy.safetensors";

/// File name of the result. The file is written when the run is finished, and removed if an unfinished run resumes.
const RESULT: &str = "result.json";

/// Key in the result: mean reward on the held-out layouts, without exploration; the objective to maximise.
const REWARD: &str = "held_out_reward";

/// Key in the result: share of those layouts on which any proposal earns 1 or more (best-of-k success).
const BEST_OF_K: &str = "held_out_reach";

/// All files that a run writes into its folder, the lock last.
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

/// Returns the configuration of the run in `folder`; if the file cannot be read, from the checkpoint, which contains the same values.
pub fn config_of(folder: &Path) -> Option<Config> {
    let of_checkpoint = || {
        let (_, Loaded { learner, state, .. }) = Checkpoints::open(folder).ok()?;
        Some(Config::of(learner.as_ref(), state.schedule, state.from))
    };
    Config::read(folder).ok().or_else(of_checkpoint)
}

/// A run and its folder. The folder is locked for this process as long as the value exists.
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
    /// Creates a run of `learner` in `folder`, and the folder if it is missing.
    ///
    /// # Errors
    /// [`RunError::Occupied`] if the folder already contains a run, [`RunError::NoFolder`] if it is a file.
    pub fn create(
        folder: &Path,
        learner: Box<dyn Learner>,
        schedule: Schedule,
        from: Option<Provenance>,
    ) -> Result<Self, RunError> {
        make_folder(folder)?;
        let lock = lock(folder)?;
        check_unoccupied(folder, None)?;
        let config = Config::of(learner.as_ref(), schedule, from.clone());
        let state = State { schedule, from, accumulator: Accumulator::default() };
        let checkpoints = Checkpoints::new(folder);
        let mut run = Self { folder: folder.to_owned(), config, learner, state, checkpoints, _lock: lock };
        // The checkpoint comes first, so that the run can be resumed however early it is killed.
        run.write_checkpoint()?;
        run.config.write(folder)?;
        Ok(run)
    }

    /// Resumes the run in `folder` from its newest intact checkpoint. Also returns warnings about differences from the interrupted run: a
    /// damaged current checkpoint, another version of carom, an incomplete last line of metrics (which is left out), or missing lines.
    ///
    /// # Errors
    /// Fails if there is no intact checkpoint, or if another process works in the folder.
    pub fn resume(folder: &Path) -> Result<(Self, Vec<String>), RunError> {
        if !contains_run(folder) {
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
                // The run was killed before it was written, or the file was removed.
                config.write(folder)?;
            } else {
                // The file is kept, because a user may still find in it when and by which version the run was started.
                let unreadable = config::unreadable_message(folder, &error);
                notices
                    .push(format!("{unreadable} and stays as it is; the run goes on without it, from its checkpoint"));
            }
            Ok::<_, RunError>(config)
        })?;
        if !learner.is_finished() {
            notices.extend(config.other_program());
            // The status of the earlier process is obsolete.
            let _ = std::fs::remove_file(folder.join(status::FILE));
        }
        let folder = folder.to_owned();
        Ok((Self { folder, config, learner, state, checkpoints, _lock: lock }, notices))
    }

    /// Returns the result of a finished run; `None` if it is not finished or its result cannot be read.
    pub fn result(&self) -> Option<Score> {
        let result: serde_json::Value = json::read(&self.folder.join(RESULT), storage::MAX_SMALL_FILE).ok()?;
        let number = |name: &str| result.get(name)?.as_f64();
        let score = Score { mean_reward: number(REWARD)?, best_of_k: number(BEST_OF_K)? };
        self.learner.is_finished().then_some(score)
    }

    /// Returns the last line of metrics, if there is one. That of a finished run has its result.
    ///
    /// # Errors
    /// Fails if the file cannot be read.
    pub fn last_line(&self) -> Result<Option<Record>, RunError> {
        let path = self.folder.join(METRICS);
        Ok(metrics::read(&path).map_err(file(&path))?.pop())
    }

    /// The run's folder.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// The learner.
    pub fn learner(&self) -> &dyn Learner {
        self.learner.as_ref()
    }

    /// Returns the path of the policy file, which exists only for agents whose policy the coach can use.
    pub fn policy_path(&self) -> PathBuf {
        self.folder.join(POLICY)
    }

    /// Writes the policy of an unfinished run, the pending lines of metrics and the checkpoint, in this order.
    fn save(&mut self, metrics: &mut MetricsFile, score: Option<Score>) -> Result<(), RunError> {
        if let Some(score) = score.filter(|_| !self.learner.is_finished()) {
            self.write_policy(score, &mut || true)?;
        }
        metrics.sync().map_err(file(&self.folder.join(METRICS)))?;
        self.write_checkpoint()
    }

    /// Writes the policy, unless `go_on` returns `false` before it is complete.
    fn write_policy(&self, score: Score, go_on: &mut dyn FnMut() -> bool) -> Result<(), RunError> {
        let path = self.policy_path();
        let started = &self.config.started;
        match self.learner.policy(score.mean_reward, started.get(..10).unwrap_or(started), go_on)? {
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

/// Whether `folder` contains a run, that is, a checkpoint to resume from.
pub fn contains_run(folder: &Path) -> bool {
    [checkpoint::CURRENT, checkpoint::PREVIOUS].iter().any(|name| folder.join(name).exists())
}

/// Deletes a run: removes the files that it has written into its folder, and the folder if it is then empty. Fails if there is no run, or if
/// another process works on it.
pub(crate) fn discard(folder: &Path) -> Result<(), RunError> {
    if !contains_run(folder) {
        return Err(RunError::Missing(folder.display().to_string()));
    }
    let _lock = lock(folder)?;
    for name in FILES {
        let path = folder.join(name);
        remove_if_exists(&path).map_err(file(&path))?;
    }
    // Fails if the folder contains other files, which must stay.
    let _ = std::fs::remove_dir(folder);
    Ok(())
}

/// Creates a folder if it is missing.
fn make_folder(folder: &Path) -> Result<(), RunError> {
    // Finds a file in place of the folder or of one of its parents.
    if let Some(file) = folder.ancestors().find(|path| path.exists() && !path.is_dir()) {
        return Err(RunError::NoFolder(file.display().to_string()));
    }
    std::fs::create_dir_all(folder).map_err(file(folder))
}

/// Refuses a folder that contains a run or any file other than `own`, because a new run could overwrite files.
fn check_unoccupied(folder: &Path, own: Option<&str>) -> Result<(), RunError> {
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

/// Locks a folder, and removes partially written files of a previous process that was killed.
fn lock(folder: &Path) -> Result<Lock, RunError> {
    let busy = || RunError::Busy(folder.display().to_string());
    let lock = Lock::try_acquire(folder).map_err(file(&folder.join("lock")))?.ok_or_else(busy)?;
    remove_partial_files(folder).map_err(file(folder))?;
    Ok(lock)
}

#[cfg(test)]
mod tests;
