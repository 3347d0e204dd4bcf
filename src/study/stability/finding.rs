//! A shot that does something that it should not: what a sweep finds.

use serde::Serialize;

use super::{Figures, Shot, Violation};
use crate::table::{PRESETS, Table};

/// A shot that does something that it should not; as JSON a question that `carom simulate --batch` reads, where the table is a bundled one.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Finding {
    /// The table's name.
    pub preset: String,
    /// The table itself, where none is bundled by this name.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub table: Option<Table>,
    /// The shot.
    #[serde(flatten)]
    pub shot: Shot,
    /// What is wrong, in words.
    pub what: String,
    /// Its violations.
    pub violations: Vec<Violation>,
    /// Events that it needs.
    pub events: usize,
    /// Pieces of course that it needs.
    pub steps: usize,
    /// Time that it took, ms: where that was too much, the least of several attempts if they were affordable.
    pub ms: f64,
}

impl Finding {
    /// A shot that breaks something.
    pub fn new(table: &Table, shot: &Shot, measured: &Figures, violations: Vec<Violation>) -> Self {
        let words: Vec<String> = violations.iter().map(ToString::to_string).collect();
        Self {
            preset: table.name.clone(),
            table: (!PRESETS.contains(&table.name.as_str())).then(|| table.clone()),
            shot: *shot,
            what: words.join("; "),
            violations,
            events: measured.events,
            steps: measured.steps,
            ms: 1e3 * measured.seconds,
        }
    }
}
