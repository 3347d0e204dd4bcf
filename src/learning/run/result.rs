//! What a finished run has come to, for programs that compare runs.

use std::path::Path;

use serde::Serialize;

use super::{error::RunError, json};
use crate::{
    game::Reward,
    learning::{
        evaluation::Score,
        learner::{Learner, TrainingPlan},
    },
    printing::VERSION,
};

/// The file's name in a run's folder; it is there once the run is finished, and taken away when it goes on.
pub const FILE: &str = "result.json";

/// The content of the file.
#[derive(Debug, Serialize)]
pub struct RunResult {
    /// The agent's name.
    pub agent: String,
    /// What earned a reward.
    pub reward: Reward,
    /// Seed of everything random.
    pub seed: u64,
    /// Shots played: those of the last iteration beyond the plan included.
    pub shots: u64,
    /// Name of the table.
    pub table: String,
    /// Updates made.
    pub updates: u64,
    /// Mean reward on the held-out layouts, without exploration: what is to be made large.
    pub held_out_reward: f64,
    /// Share of those layouts in which any proposal earns at least 1.
    #[serde(rename = "held_out_reach")]
    pub best_of_k: f64,
    /// Version of carom.
    pub version: String,
}

impl RunResult {
    /// What `learner` has come to with this last measurement.
    pub fn of(learner: &dyn Learner, score: Score) -> Self {
        let TrainingPlan { reward, seed, .. } = learner.plan();
        Self {
            agent: learner.agent().to_owned(),
            reward,
            seed,
            shots: learner.shots(),
            table: learner.table().name.clone(),
            updates: learner.progress().updates,
            held_out_reward: score.mean_reward,
            best_of_k: score.best_of_k,
            version: VERSION.to_owned(),
        }
    }

    /// Writes it for the run in `folder`.
    ///
    /// # Errors
    /// Whatever the file system reports.
    pub fn write(&self, folder: &Path) -> Result<(), RunError> {
        json::write(&folder.join(FILE), self)
    }
}
