//! The latest shots on held-out layouts, to see how an agent plays.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::json;
use crate::{
    learning::learner::Learner,
    physics::CueInputs,
    storage::{self, replace},
    table::Layout,
};

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
    /// Those of a measurement of `learner` on `layouts`.
    pub(crate) fn of(learner: &dyn Learner, layouts: &[Layout]) -> candle_core::Result<Self> {
        let layouts = &layouts[..layouts.len().min(COUNT)];
        let (reward, table) = (learner.plan().reward, learner.table());
        let shots = learner.shots_on(layouts)?.into_iter().zip(layouts);
        let shots = shots.map(|(cue, &layout)| Example { layout, cue, reward: reward.of(table, &layout, &cue) });
        Ok(Self { after: learner.shots(), shots: shots.collect() })
    }

    /// Writes them for the run in `folder`.
    pub(crate) fn write(&self, folder: &Path) -> std::io::Result<()> {
        replace(&folder.join(FILE), &serde_json::to_vec(self)?)
    }

    /// Reads those of the run in `folder`.
    pub(crate) fn read(folder: &Path) -> std::io::Result<Self> {
        json::read(&folder.join(FILE), storage::LARGE)
    }
}
