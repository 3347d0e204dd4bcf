//! Shots on held-out layouts, recorded to be replayed.

use crate::{
    learning::run::examples::{Example, Examples},
    table::Table,
    terminal::Shot,
};

/// A set of shots, recorded.
#[derive(Debug)]
pub struct Reel {
    /// Shots practised before the measurement that they are of.
    pub after: u64,
    /// The shots.
    pub shots: Vec<ReplayShot>,
}

/// A shot of a set.
#[derive(Debug)]
pub struct ReplayShot {
    /// What was measured.
    pub example: Example,
    /// What happens in it; none where it cannot be played.
    pub shot: Option<Shot>,
}

impl Reel {
    /// Records a set on `table`. That may take seconds where balls press each other for long: not for the screen's thread.
    pub fn record(examples: &Examples, table: &Table) -> Self {
        let record = |example: &Example| {
            let Example { layout, cue, reward } = *example;
            ReplayShot { example: *example, shot: Shot::new(table, &layout, cue, reward >= 1.0, "").ok() }
        };
        Self { after: examples.after, shots: examples.shots.iter().map(record).collect() }
    }

    /// Whether `other` was recorded from the same shots.
    pub fn is_of(&self, other: &Self) -> bool {
        let [examples, others] = [self, other].map(|reel| reel.shots.iter().map(|shot| &shot.example));
        self.after == other.after && examples.eq(others)
    }
}
