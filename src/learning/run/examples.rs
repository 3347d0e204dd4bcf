//! Example shots of the latest evaluation on held-out layouts, which show how an agent plays.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::json;
use crate::{
    learning::learner::Learner,
    physics::CueInputs,
    storage::{self, write_atomic_unsynced},
    table::Layout,
};

/// File name of the examples.
pub const FILE: &str = "shots.json";

/// Number of shots that are stored per evaluation.
pub const COUNT: usize = 8;

/// A shot of an evaluation.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Example {
    /// Positions of the balls before the shot.
    pub layout: Layout,
    /// The agent's first choice.
    pub cue: CueInputs,
    /// Reward of the shot.
    pub reward: f64,
}

/// The content of `shots.json`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Examples {
    /// Training shots played before the evaluation.
    pub after: u64,
    /// The first shots of the evaluation.
    pub shots: Vec<Example>,
}

impl Examples {
    /// Plays the first of `layouts` with `learner` and returns these shots.
    pub(crate) fn of(learner: &dyn Learner, layouts: &[Layout]) -> candle_core::Result<Self> {
        let layouts = &layouts[..layouts.len().min(COUNT)];
        let (reward, table) = (learner.plan().reward, learner.table());
        let shots = learner.choose_shots(layouts)?.into_iter().zip(layouts);
        let shots = shots.map(|(cue, &layout)| Example {
            layout,
            cue,
            reward: reward.of_playable(table, &layout, &cue, u32::MAX),
        });
        Ok(Self { after: learner.shots(), shots: shots.collect() })
    }

    /// Writes the examples of the run in `folder`.
    pub(crate) fn write(&self, folder: &Path) -> std::io::Result<()> {
        write_atomic_unsynced(&folder.join(FILE), &serde_json::to_vec(self)?)
    }

    /// Reads the examples of the run in `folder`.
    pub(crate) fn read(folder: &Path) -> std::io::Result<Self> {
        json::read(&folder.join(FILE), storage::MAX_LARGE_FILE)
    }
}
