//! A training run on disk: its folder, and the loop that fills it.
//!
//! A run can be killed at any moment. The order of writing sees to it that what it goes on from is complete: first the
//! policy, then the lines of metrics, last the checkpoint; whatever is younger than the checkpoint is done again,
//! to the same bits.

mod checkpoint;
mod checksum;
mod config;
mod error;
pub mod list;
pub mod origin;
pub mod seeds;
mod tally;

use std::{
    path::{Path, PathBuf},
    time::{Duration, Instant},
};

use self::{
    checkpoint::{Checkpoints, Loaded, State},
    error::file,
    tally::Tally,
};
pub use self::{
    config::{Config, Schedule, Start},
    error::{OriginError, RunError},
};
use super::{
    evaluation::{HELD_OUT_SEED, Score, held_out_layouts},
    learner::{Learner, Turn},
    metrics::{MetricsFile, Record},
};
use crate::{
    storage::{Lock, remove_partial_files, write_atomic},
    table::Layout,
};

/// The metrics' file in a run's folder.
pub const METRICS: &str = "metrics.jsonl";

/// The policy's file in a run's folder.
pub const POLICY: &str = "policy.safetensors";

/// Longest time between two checkpoints: what a power cut costs. It may depend on the clock, because nothing depends on
/// when a checkpoint is written.
const CHECKPOINT_INTERVAL: Duration = Duration::from_secs(60);

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

/// Who follows a run.
pub trait Watcher {
    /// A line of metrics.
    fn line(&mut self, record: &Record);

    /// Something went wrong, and training goes on.
    fn warn(&mut self, sentence: &str);
}

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ending {
    /// What it earns on the held-out layouts.
    pub score: Score,
    /// Whether all shots have been played.
    pub finished: bool,
}

impl Run {
    /// A new run of `learner` in `folder`, which is made where it is missing.
    ///
    /// # Errors
    /// [`RunError::Occupied`] where it holds a run already.
    pub fn create(
        folder: &Path,
        learner: Box<dyn Learner>,
        schedule: Schedule,
        from: Option<Start>,
    ) -> Result<Self, RunError> {
        std::fs::create_dir_all(folder).map_err(file(folder))?;
        let lock = lock(folder)?;
        if [config::FILE, checkpoint::CURRENT, checkpoint::PREVIOUS].iter().any(|name| folder.join(name).exists()) {
            return Err(RunError::Occupied(folder.display().to_string()));
        }
        let config = Config::of(learner.as_ref(), schedule, from.clone());
        let state = State { schedule, from, tally: Tally::default() };
        let checkpoints = Checkpoints::new(folder);
        let mut run = Self { folder: folder.to_owned(), config, learner, state, checkpoints, _lock: lock };
        // First of all something to go on from, however early the run is killed.
        run.write_checkpoint()?;
        run.config.write(folder)?;
        Ok(run)
    }

    /// The run in `folder` as its last whole checkpoint left it, and a sentence where that is not the last one.
    ///
    /// # Errors
    /// Where there is no whole checkpoint, or another process works in the folder.
    pub fn resume(folder: &Path) -> Result<(Self, Option<String>), RunError> {
        if !holds_checkpoints(folder) {
            return Err(RunError::Missing(folder.display().to_string()));
        }
        let lock = lock(folder)?;
        remove_partial_files(folder).map_err(file(folder))?;
        let (checkpoints, Loaded { learner, state, fallback, .. }) = Checkpoints::open(folder)?;
        let notice = fallback
            .map(|damage| format!("{damage}; going on from {}, after {} shots", checkpoint::PREVIOUS, learner.shots()));
        let config = Config::read(folder).or_else(|_| {
            // It was killed before it had one, or somebody took it away: the checkpoint knows what it said.
            let config = Config::of(learner.as_ref(), state.schedule, state.from.clone());
            config.write(folder).map(|()| config)
        })?;
        let folder = folder.to_owned();
        Ok((Self { folder, config, learner, state, checkpoints, _lock: lock }, notice))
    }

    /// The run's folder.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Who learns.
    pub fn learner(&self) -> &dyn Learner {
        self.learner.as_ref()
    }

    /// What its configuration says.
    pub const fn config(&self) -> &Config {
        &self.config
    }

    /// Where the policy is written, if the agent has one that the coach can use.
    pub fn policy_path(&self) -> PathBuf {
        self.folder.join(POLICY)
    }

    /// Trains until the plan is finished, `limit` has passed or `stop` says so. The folder then holds a checkpoint from
    /// which the run can go on. A checkpoint on the way that cannot be written is told to the watcher, and the next one
    /// tried.
    ///
    /// # Errors
    /// Where training breaks down, or where the last checkpoint cannot be written.
    pub fn practise(
        &mut self,
        limit: Option<Duration>,
        stop: &dyn Fn() -> bool,
        watcher: &mut dyn Watcher,
    ) -> Result<Ending, RunError> {
        let path = self.folder.join(METRICS);
        let (mut metrics, last) = MetricsFile::open(&path, self.learner.shots()).map_err(file(&path))?;
        let layouts = held_out_layouts(self.learner.table(), self.state.schedule.evaluation_layouts, HELD_OUT_SEED);
        if self.learner.is_finished() {
            let score = self.learner.score(&layouts)?;
            if !self.policy_path().exists() {
                self.write_policy(score)?;
            }
            return Ok(Ending { score, finished: true });
        }
        let mut clock = Clock::new(self.learner.shots(), last.map_or(0.0, |record| record.seconds));
        let mut saved = Instant::now();
        loop {
            if stop() || limit.is_some_and(|limit| clock.start.elapsed() >= limit) {
                let score = self.learner.score(&layouts)?;
                self.save(&mut metrics, Some(score)).map_err(|reason| self.unsaved(reason))?;
                return Ok(Ending { score, finished: false });
            }
            let finished = self.turn(&mut metrics, &mut clock, &layouts, watcher)?;
            let score = finished.score;
            if score.is_some() || saved.elapsed() >= CHECKPOINT_INTERVAL {
                let done = self.save(&mut metrics, score);
                saved = Instant::now();
                match (done, score.filter(|_| finished.all)) {
                    (Ok(()), Some(score)) => return Ok(Ending { score, finished: true }),
                    (Ok(()), None) => {}
                    (Err(reason), Some(_)) => return Err(self.unsaved(reason)),
                    (Err(reason), None) => watcher.warn(&format!(
                        "the checkpoint after {} shots could not be written: {reason}; the one before is whole, and \
                         training goes on to the next",
                        self.learner.shots()
                    )),
                }
            }
        }
    }

    /// One turn, and the line of metrics that is due after it.
    fn turn(
        &mut self,
        metrics: &mut MetricsFile,
        clock: &mut Clock,
        layouts: &[Layout],
        watcher: &mut dyn Watcher,
    ) -> Result<Reached, RunError> {
        let Schedule { log_every, evaluate_every, .. } = self.state.schedule;
        let before = self.learner.shots();
        let turn = self.learner.turn()?;
        let shots = self.learner.shots();
        if !self.state.tally.add(&turn) {
            return Err(RunError::NotFinite { shots });
        }
        let all = self.learner.is_finished();
        let passed = |every: u64| before / every != shots / every;
        let score = if all || passed(evaluate_every) { Some(self.learner.score(layouts)?) } else { None };
        if score.is_some() || passed(log_every) {
            let record = clock.record(self.learner.as_ref(), self.state.tally.take(), score);
            metrics.push(&record);
            watcher.line(&record);
            // Until there is room it waits in memory. No checkpoint is written before it is.
            let _ = metrics.flush();
        }
        Ok(Reached { score, all })
    }

    /// Writes the policy, the lines that wait and the checkpoint, in this order.
    fn save(&mut self, metrics: &mut MetricsFile, score: Option<Score>) -> Result<(), RunError> {
        if let Some(score) = score {
            self.write_policy(score)?;
        }
        metrics.sync().map_err(file(&self.folder.join(METRICS)))?;
        self.write_checkpoint()
    }

    fn write_policy(&self, score: Score) -> Result<(), RunError> {
        let path = self.policy_path();
        match self.learner.policy(score.mean_reward, self.config.day())? {
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

fn lock(folder: &Path) -> Result<Lock, RunError> {
    let busy = || RunError::Busy(folder.display().to_string());
    Lock::take(folder).map_err(file(&folder.join("lock")))?.ok_or_else(busy)
}

/// Where a turn has led.
struct Reached {
    /// The measurement, where one was due.
    score: Option<Score>,
    /// Whether all shots have been played.
    all: bool,
}

/// The time that training takes.
struct Clock {
    start: Instant,
    /// Seconds of the sessions before.
    before: f64,
    /// Seconds and shots of the last line, or of the start.
    last: (f64, u64),
}

impl Clock {
    fn new(shots: u64, before: f64) -> Self {
        Self { start: Instant::now(), before, last: (before, shots) }
    }

    fn record(&mut self, learner: &dyn Learner, means: Turn, score: Option<Score>) -> Record {
        let seconds = self.before + self.start.elapsed().as_secs_f64();
        let shots = learner.shots();
        let record = Record {
            shots,
            seconds,
            shots_per_second: (shots - self.last.1) as f64 / (seconds - self.last.0).max(1e-9),
            updates: learner.updates(),
            learning_rate: learner.learning_rate(),
            critic_loss: means.critic_loss,
            actor_loss: means.actor_loss,
            q_value: means.q_value,
            practice_reward: means.mean_reward,
            held_out_reward: score.map(|score| score.mean_reward),
            held_out_reach: score.map(|score| score.reach),
        };
        self.last = (seconds, shots);
        record
    }
}

#[cfg(test)]
mod tests;
