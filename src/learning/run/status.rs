//! The run status, schema of `state.json`: a small file that is replaced about once a second, for watchers.
//!
//! It is no part of what a run goes on from. Whether its process still lives the lock tells, not this file.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::json;
use crate::storage::{self, replace};

/// The file's name.
pub const FILE: &str = "state.json";

/// What a run is doing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Phase {
    /// It plays and learns.
    #[default]
    Training,
    /// It plays the held-out layouts.
    Measuring,
    /// It waits for a request to go on.
    Paused,
    /// It was told to stop, has saved, and plays the held-out layouts before it ends.
    Stopping,
    /// It has played all its shots.
    Finished,
    /// It was stopped and can go on.
    Stopped,
    /// It broke down.
    Failed,
}

impl Phase {
    /// In a word.
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

    /// Whether nothing more will come.
    pub const fn is_over(self) -> bool {
        matches!(self, Self::Finished | Self::Stopped | Self::Failed)
    }
}

/// The content of `state.json`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RunStatus {
    /// What the run is doing.
    pub phase: Phase,
    /// Shots played.
    pub shots: u64,
    /// Shots that had been played at the last line of the metrics' file; 0 in files of earlier versions.
    #[serde(default)]
    pub logged: u64,
    /// Updates made.
    pub updates: u64,
    /// Seconds of training so far, evaluations included, pauses not.
    pub seconds: f64,
    /// Shots a second over the last seconds.
    pub shots_per_second: f64,
    /// Updates a second over the last seconds.
    pub updates_per_second: f64,
    /// How strongly the agent explores, see [`Progress`](crate::learning::learner::Progress::exploration).
    pub exploration: f64,
    /// Share of the replay buffer that is filled, for agents that have one.
    #[serde(rename = "memory")]
    pub replay_fill: Option<f64>,
    /// What it earned at its last measurement on held-out layouts in this session.
    pub held_out_reward: Option<f64>,
    /// The process that trains.
    pub process: u32,
    /// The last warning, if there was one.
    pub warning: Option<String>,
    /// Why it broke down, if it did.
    pub reason: Option<String>,
}

impl RunStatus {
    /// Writes it for the run in `folder`.
    ///
    /// # Errors
    /// Whatever the file system reports.
    pub fn write(&self, folder: &Path) -> std::io::Result<()> {
        replace(&folder.join(FILE), &serde_json::to_vec(self)?)
    }

    /// Reads that of the run in `folder`.
    ///
    /// # Errors
    /// Where there is none, or something else.
    pub fn read(folder: &Path) -> std::io::Result<Self> {
        json::read(&folder.join(FILE), storage::SMALL)
    }
}
