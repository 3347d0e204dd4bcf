//! Replays: recorded shots on held-out layouts.

use crate::{
    learning::run::examples::{Example, Examples},
    table::Table,
    terminal::Shot,
};

/// A set of recorded shots.
#[derive(Debug)]
pub struct Reel {
    /// Training shots played before the measurement of this set.
    pub after: u64,
    /// The shots.
    pub shots: Vec<ReplayShot>,
}

/// A shot of the set.
#[derive(Debug)]
pub struct ReplayShot {
    /// The measured shot.
    pub example: Example,
    /// The recording; `None` if the shot cannot be simulated.
    pub shot: Option<Shot>,
}

impl Reel {
    /// Simulates a set on `table`. This may take seconds if balls press on each other for long, so it must not run on the screen's thread.
    pub fn record(examples: &Examples, table: &Table) -> Self {
        let record = |example: &Example| {
            let Example { layout, cue, reward } = *example;
            ReplayShot { example: *example, shot: Shot::new(table, &layout, cue, reward >= 1.0, "").ok() }
        };
        Self { after: examples.after, shots: examples.shots.iter().map(record).collect() }
    }

    /// Whether `other` contains the same shots.
    pub fn has_same_shots(&self, other: &Self) -> bool {
        let [examples, others] = [self, other].map(|reel| reel.shots.iter().map(|shot| &shot.example));
        self.after == other.after && examples.eq(others)
    }
}
