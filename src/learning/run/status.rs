//! The run status, schema of `state.json`: a small file for watchers, replaced about once a second.
//!
//! Resuming a run does not need it. The lock, not this file, shows whether the run's process still exists.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::json;
use crate::storage::{self, write_atomic_unsynced};

/// File name of the status.
pub const FILE: &str = "state.json";

/// Current activity of a run, or how it ended.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Phase {
    /// It plays and learns.
    #[default]
    Training,
    /// It plays the held-out layouts.
    Measuring,
    /// It waits for a request to resume.
    Paused,
    /// After a request to stop it has saved, and plays the held-out layouts before it ends.
    Stopping,
    /// It has played all its shots.
    Finished,
    /// It was stopped and can be resumed.
    Stopped,
    /// It ended with an error.
    Failed,
}

impl Phase {
    /// Returns the phase in one word.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Training => "training",
            Self::Measuring => "measuring",
            Self::Paused => "paused",
            Self::Stopping => "stopping",
            Self::Finished => "finished",
            Self::Stopped => "stopped",
            Self::Failed => "failed",
        }
    }

    /// Whether the run has ended.
    pub const fn is_over(self) -> bool {
        matches!(self, Self::Finished | Self::Stopped | Self::Failed)
    }
}

/// The content of `state.json`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RunStatus {
    /// Current activity.
    pub phase: Phase,
    /// Shots played.
    pub shots: u64,
    /// Shots played at the last line of the metrics file; 0 in files of earlier versions.
    #[serde(default)]
    pub logged: u64,
    /// Updates made.
    pub updates: u64,
    /// Seconds of training so far, with evaluations, without pauses.
    pub seconds: f64,
    /// Shots per second over the last seconds.
    pub shots_per_second: f64,
    /// Updates per second over the last seconds.
    pub updates_per_second: f64,
    /// Strength of the exploration, see [`Progress`](crate::learning::learner::Progress::exploration).
    pub exploration: f64,
    /// Filled share of the replay buffer, for agents that have one.
    #[serde(rename = "memory")]
    pub replay_fill: Option<f64>,
    /// Mean reward of the last evaluation on held-out layouts in this session.
    pub held_out_reward: Option<f64>,
    /// Id of the training process.
    pub process: u32,
    /// The last warning, if there was one.
    pub warning: Option<String>,
    /// The error, if the run ended with one.
    pub reason: Option<String>,
}

impl RunStatus {
    /// Writes the status of the run in `folder`.
    ///
    /// # Errors
    /// The errors of the file system.
    pub fn write(&self, folder: &Path) -> std::io::Result<()> {
        write_atomic_unsynced(&folder.join(FILE), &serde_json::to_vec(self)?)
    }

    /// Reads the status of the run in `folder`.
    ///
    /// # Errors
    /// Fails if the file is missing or is not a status.
    pub fn read(folder: &Path) -> std::io::Result<Self> {
        json::read(&folder.join(FILE), storage::MAX_SMALL_FILE)
    }
}
