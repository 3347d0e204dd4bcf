//! The time that training takes, pauses left out.

use std::time::{Duration, Instant};

use super::metrics::Record;
use crate::learning::{
    evaluation::Score,
    learner::{Iteration, Learner},
};

/// The time that training takes.
#[derive(Debug)]
pub struct Clock {
    start: Instant,
    /// Seconds of the sessions before.
    before: f64,
    /// Time that passed in pauses.
    paused: Duration,
    /// Seconds and shots of the last line, or of the start.
    last: (f64, u64),
}

impl Clock {
    /// Starts now, for a run that has played so many shots in so many seconds.
    pub fn new(shots: u64, before: f64) -> Self {
        Self { start: Instant::now(), before, paused: Duration::ZERO, last: (before, shots) }
    }

    /// Time since the start.
    pub fn session(&self) -> Duration {
        self.start.elapsed().saturating_sub(self.paused)
    }

    /// Seconds of training in all.
    pub fn seconds(&self) -> f64 {
        self.before + self.session().as_secs_f64()
    }

    /// Leaves a pause out that began at `begin` and ends now.
    pub fn leave_out(&mut self, begin: Instant) {
        self.paused += begin.elapsed();
    }

    /// The line that is due now, `measuring` seconds after the last shot: a speed that fell with each measurement would say
    /// nothing of either.
    pub fn record(&mut self, learner: &dyn Learner, means: Iteration, score: Option<Score>, measuring: f64) -> Record {
        let seconds = self.seconds();
        let (shots, progress) = (learner.shots(), learner.progress());
        let record = Record {
            shots,
            seconds,
            shots_per_second: (shots - self.last.1) as f64 / (seconds - measuring - self.last.0).max(1e-9),
            updates: progress.updates,
            learning_rate: progress.learning_rate,
            critic_loss: means.critic_loss,
            actor_loss: means.actor_loss,
            q_value: means.q_value,
            rollout_reward: means.mean_reward,
            exploration: Some(progress.exploration),
            replay_fill: progress.replay_fill,
            held_out_reward: score.map(|score| score.mean_reward),
            best_of_k: score.map(|score| score.best_of_k),
        };
        self.last = (seconds, shots);
        record
    }
}
