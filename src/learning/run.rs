//! A training run on disk: its folder, and the loop that fills it.

use std::{
    path::{Path, PathBuf},
    time::{Duration, Instant},
};

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::{
    calendar::today,
    evaluation::{HELD_OUT_SEED, Score, held_out_layouts},
    learner::{Agent, Learner, Plan, Turn},
    metrics::{self, Record},
    weights::{Reader, WeightsError, Writer},
};
use crate::{
    storage::write_atomic,
    table::{Layout, Table},
};

/// Updates between two lines of metrics.
const LOG_EVERY: u64 = 500;

/// Updates between two evaluations, each followed by a checkpoint. A multiple of [`LOG_EVERY`].
const EVALUATE_EVERY: u64 = 2_000;

/// Layouts of an evaluation: enough for a standard error of half a percent near 0.95.
const EVALUATION_LAYOUTS: usize = 2_000;

/// Why a run cannot start or go on.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// The folder already holds a run.
    #[error("{0} already holds a run; go on with it by --resume {0}, or choose another folder by --run")]
    Occupied(String),
    /// The folder holds no run.
    #[error("{0} holds no run to go on with: it has no checkpoint.safetensors")]
    Missing(String),
    /// A file of the run cannot be read or written.
    #[error("{path}: {reason}")]
    File {
        /// The file.
        path: String,
        /// What the system says.
        reason: std::io::Error,
    },
    /// The checkpoint is damaged or of another version.
    #[error("{path} is not a checkpoint that this version of carom can go on from: {reason}")]
    Checkpoint {
        /// The file.
        path: String,
        /// What is wrong.
        reason: WeightsError,
    },
    /// The networks no longer give finite numbers.
    #[error("training stopped: {0}")]
    Training(#[from] candle_core::Error),
}

/// The folder of a run.
#[derive(Clone, Debug)]
pub struct Run {
    folder: PathBuf,
}

/// What `config.json` says.
#[derive(Serialize)]
struct Config<'a> {
    agent: &'static str,
    version: &'static str,
    table: &'a Table,
    #[serde(flatten)]
    plan: Plan,
    settings: Value,
}

/// What a checkpoint says beside its arrays.
#[derive(Serialize, Deserialize)]
struct Note {
    agent: String,
    learner: Value,
}

impl Run {
    /// A new run of `learner` in `folder`, which is made where it is missing.
    ///
    /// # Errors
    /// [`RunError::Occupied`] where it holds a run already.
    pub fn create(folder: &Path, learner: &dyn Learner) -> Result<Self, RunError> {
        let run = Self { folder: folder.to_owned() };
        let config_path = run.folder.join("config.json");
        if config_path.exists() {
            return Err(RunError::Occupied(folder.display().to_string()));
        }
        let version = env!("CARGO_PKG_VERSION");
        let (plan, settings) = (learner.plan(), learner.settings());
        let config = Config { agent: learner.agent(), version, table: learner.table(), plan, settings };
        // First of all something to go on from, however early the run is killed.
        run.write_checkpoint(learner)?;
        let text = serde_json::to_string_pretty(&config).map_err(|error| file(&config_path)(error.into()))?;
        write_atomic(&config_path, text.as_bytes()).map_err(file(&config_path))?;
        Ok(run)
    }

    /// The run in `folder` and its learner as the last checkpoint left it.
    ///
    /// # Errors
    /// Where there is no whole checkpoint.
    pub fn resume(folder: &Path) -> Result<(Self, Box<dyn Learner>), RunError> {
        let run = Self { folder: folder.to_owned() };
        let path = run.checkpoint_path();
        if !path.exists() {
            return Err(RunError::Missing(folder.display().to_string()));
        }
        let bytes = std::fs::read(&path).map_err(file(&path))?;
        let damaged = |reason| RunError::Checkpoint { path: path.display().to_string(), reason };
        let restore = || {
            let reader = Reader::new(&bytes)?;
            let Note { agent, learner } = reader.note()?;
            (Agent::named(&agent).map_err(|_| WeightsError::Foreign)?.restore)(&reader, learner)
        };
        Ok((run, restore().map_err(damaged)?))
    }

    /// The run's folder.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Where the policy is written.
    pub fn policy_path(&self) -> PathBuf {
        self.folder.join("policy.safetensors")
    }

    fn checkpoint_path(&self) -> PathBuf {
        self.folder.join("checkpoint.safetensors")
    }

    /// Trains until the task is finished, `limit` has passed or `stop` says so. `report` is given every line of
    /// metrics. The folder then holds the policy and a checkpoint from which the run can go on.
    ///
    /// # Errors
    /// Where a file cannot be written or training breaks down.
    pub fn practise(
        &self,
        learner: &mut dyn Learner,
        limit: Option<Duration>,
        stop: &dyn Fn() -> bool,
        report: &mut dyn FnMut(&Record),
    ) -> Result<Score, RunError> {
        let metrics_path = self.folder.join("metrics.jsonl");
        let last = metrics::rewind(&metrics_path, learner.shots()).map_err(file(&metrics_path))?;
        let mut clock = Clock::new(learner, last.map_or(0.0, |record| record.seconds));
        let layouts = held_out_layouts(learner.table(), EVALUATION_LAYOUTS, HELD_OUT_SEED);
        loop {
            let over = learner.is_finished() || stop() || limit.is_some_and(|limit| clock.start.elapsed() >= limit);
            let evaluate = over || learner.updates().is_multiple_of(EVALUATE_EVERY) && clock.turns > 0;
            let mut score = None;
            if evaluate {
                score = Some(self.save(learner, &layouts)?);
            }
            if clock.turns > 0 && (evaluate || learner.updates().is_multiple_of(LOG_EVERY)) {
                let record = clock.record(learner, score);
                metrics::append(&metrics_path, &record).map_err(file(&metrics_path))?;
                report(&record);
            }
            if let Some(score) = score.filter(|_| over) {
                return Ok(score);
            }
            clock.add(learner.turn()?);
        }
    }

    /// Evaluates the policy, then writes it and a checkpoint.
    fn save(&self, learner: &dyn Learner, layouts: &[Layout]) -> Result<Score, RunError> {
        let score = learner.score(layouts)?;
        let policy_path = self.policy_path();
        let refused = |reason| RunError::Checkpoint { path: policy_path.display().to_string(), reason };
        if let Some(policy) = learner.policy(score.mean_reward, &today()).map_err(refused)? {
            write_atomic(&policy_path, &policy).map_err(file(&policy_path))?;
        }
        self.write_checkpoint(learner)?;
        Ok(score)
    }

    fn write_checkpoint(&self, learner: &dyn Learner) -> Result<(), RunError> {
        let path = self.checkpoint_path();
        let bytes = || {
            let mut writer = Writer::default();
            let note = Note { agent: learner.agent().to_owned(), learner: learner.save(&mut writer)? };
            writer.finish(&note)
        };
        let bytes = bytes().map_err(|reason| RunError::Checkpoint { path: path.display().to_string(), reason })?;
        write_atomic(&path, &bytes).map_err(file(&path))
    }
}

fn file(path: &Path) -> impl FnOnce(std::io::Error) -> RunError {
    move |reason| RunError::File { path: path.display().to_string(), reason }
}

/// Means over the turns since the last line of metrics.
struct Clock {
    start: Instant,
    seconds_before: f64,
    last: (f64, u64),
    turns: u32,
    sum: Turn,
}

impl Clock {
    fn new(learner: &dyn Learner, seconds_before: f64) -> Self {
        let last = (seconds_before, learner.shots());
        Self { start: Instant::now(), seconds_before, last, turns: 0, sum: Turn::default() }
    }

    fn add(&mut self, turn: Turn) {
        self.turns += 1;
        self.sum.mean_reward += turn.mean_reward;
        self.sum.critic_loss += turn.critic_loss;
        self.sum.q_value += turn.q_value;
        if let Some(loss) = turn.actor_loss {
            *self.sum.actor_loss.get_or_insert_default() += loss;
        }
    }

    fn record(&mut self, learner: &dyn Learner, score: Option<Score>) -> Record {
        let seconds = self.seconds_before + self.start.elapsed().as_secs_f64();
        let (shots, turns) = (learner.shots(), f64::from(self.turns));
        let record = Record {
            shots,
            seconds,
            shots_per_second: (shots - self.last.1) as f64 / (seconds - self.last.0).max(1e-9),
            updates: learner.updates(),
            learning_rate: learner.learning_rate(),
            critic_loss: self.sum.critic_loss / turns,
            actor_loss: self.sum.actor_loss.map(|sum| sum / turns),
            q_value: self.sum.q_value / turns,
            practice_reward: self.sum.mean_reward / turns,
            held_out_reward: score.map(|score| score.mean_reward),
            held_out_reach: score.map(|score| score.reach),
        };
        (self.last, self.turns, self.sum) = ((seconds, shots), 0, Turn::default());
        record
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::learning::{
        policy::Policy,
        trainer::{Trainer, tests::small_task},
    };
    use std::{cell::Cell, fs};

    fn small_run(folder: &Path) -> (Run, Box<dyn Learner>) {
        let learner = Trainer::new(small_task(), Table::default()).unwrap();
        (Run::create(folder, &learner).unwrap(), Box::new(learner))
    }

    #[test]
    fn a_run_leaves_its_configuration_metrics_checkpoint_and_policy() {
        let folder = tempfile::tempdir().unwrap();
        let (run, mut trainer) = small_run(folder.path());
        let mut lines = 0;
        let score = run.practise(trainer.as_mut(), None, &|| false, &mut |_| lines += 1).unwrap();
        assert_eq!(lines, 1);
        let policy = Policy::load(&run.policy_path()).unwrap();
        assert_eq!(policy.origin().held_out_reward, score.mean_reward);
        let config = fs::read_to_string(folder.path().join("config.json")).unwrap();
        assert!(config.contains("\"seed\": 5") && config.contains("\"reward\": \"r1\""));
        let again = Run::create(folder.path(), trainer.as_ref()).unwrap_err();
        assert!(again.to_string().contains("--resume"));
    }

    #[test]
    fn a_stopped_run_goes_on_to_the_same_weights() {
        let weights = |stop_after: Option<u32>| {
            let folder = tempfile::tempdir().unwrap();
            let (run, mut trainer) = small_run(folder.path());
            let asked = Cell::new(0);
            let stop = || {
                asked.set(asked.get() + 1);
                stop_after.is_some_and(|after| asked.get() > after)
            };
            run.practise(trainer.as_mut(), None, &stop, &mut |_| {}).unwrap();
            if stop_after.is_some() {
                assert!(!trainer.is_finished());
                let (run, mut trainer) = Run::resume(folder.path()).unwrap();
                run.practise(trainer.as_mut(), None, &|| false, &mut |_| {}).unwrap();
                assert!(trainer.is_finished());
            }
            (fs::read(run.policy_path()).unwrap(), fs::read(run.checkpoint_path()).unwrap())
        };
        assert!(weights(None) == weights(Some(4)));
    }

    #[test]
    fn a_folder_without_a_whole_checkpoint_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let missing = Run::resume(folder.path()).unwrap_err().to_string();
        assert!(missing.contains("checkpoint.safetensors"));
        fs::write(folder.path().join("checkpoint.safetensors"), b"half").unwrap();
        assert!(Run::resume(folder.path()).unwrap_err().to_string().contains("not a checkpoint"));
    }
}
