//! The loop that fills a run's folder.

use std::time::{Duration, Instant};

use super::metrics::{MetricsFile, Record};
use super::{METRICS, Run, RunError, Schedule, error::file};
use crate::{
    learning::{
        evaluation::{HELD_OUT_SEED, Score, held_out_layouts},
        learner::{Learner, Turn},
    },
    table::Layout,
};

/// Longest time between two checkpoints: what a power cut costs. It may depend on the clock, because nothing depends on
/// when a checkpoint is written.
const CHECKPOINT_INTERVAL: Duration = Duration::from_secs(60);

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
            exploration: Some(learner.exploration()),
            memory: learner.memory(),
            held_out_reward: score.map(|score| score.mean_reward),
            held_out_reach: score.map(|score| score.reach),
        };
        self.last = (seconds, shots);
        record
    }
}
