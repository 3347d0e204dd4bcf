//! The latest shots on held-out layouts, for whoever wants to see how an agent plays.

use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::{physics::CueInputs, table::Layout};

/// The file's name.
pub const FILE: &str = "shots.json";

/// Shots that are kept of a measurement.
pub const COUNT: usize = 8;

/// A shot of a measurement.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Example {
    /// Where the balls lay.
    pub layout: Layout,
    /// The agent's first choice.
    pub cue: CueInputs,
    /// What it earned.
    pub reward: f64,
}

/// The content of `shots.json`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Examples {
    /// Shots practised before the measurement.
    pub after: u64,
    /// The first of its shots.
    pub shots: Vec<Example>,
}

impl Examples {
    /// Reads those of the run in `folder`.
    ///
    /// # Errors
    /// Where there are none, or something else.
    pub fn read(folder: &Path) -> std::io::Result<Self> {
        Ok(serde_json::from_slice(&std::fs::read(folder.join(FILE))?)?)
    }
}
