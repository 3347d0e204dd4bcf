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
#[derive(Serialize)]
struct RunResult {
    agent: &'static str,
    reward: Reward,
    seed: u64,
    /// Shots played: those of the last iteration beyond the plan included.
    shots: u64,
    table: String,
    updates: u64,
    /// Mean reward on the held-out layouts, without exploration: what is to be made large.
    held_out_reward: f64,
    /// Share of those layouts in which any proposal earns at least 1.
    held_out_reach: f64,
    version: &'static str,
}

/// Writes for the run in `folder` what its `learner` has come to with this last measurement.
pub fn write(folder: &Path, learner: &dyn Learner, score: Score) -> Result<(), RunError> {
    let TrainingPlan { reward, seed, .. } = learner.plan();
    let result = RunResult {
        agent: learner.agent(),
        reward,
        seed,
        shots: learner.shots(),
        table: learner.table().name.clone(),
        updates: learner.progress().updates,
        held_out_reward: score.mean_reward,
        held_out_reach: score.best_of_k,
        version: VERSION,
    };
    json::write(&folder.join(FILE), &result)
}
