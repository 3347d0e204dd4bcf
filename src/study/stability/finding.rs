//! A shot that does something that it should not: what a sweep finds.

use serde::Serialize;

use super::{Figures, Shot, Violation, trace::BREAK_AFTER_SECONDS};
use crate::table::Table;

/// A shot that has not even had an event for so long hangs, s.
pub const HANG: f64 = 3.0 * BREAK_AFTER_SECONDS;

/// A shot that does something that it should not.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Finding {
    /// The table's name.
    pub table: String,
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
            table: table.name.clone(),
            shot: *shot,
            what: words.join("; "),
            violations,
            events: measured.events,
            steps: measured.steps,
            ms: 1e3 * measured.seconds,
        }
    }

    /// A shot that has kept a thread busy for too long, seconds on end, and still does.
    pub fn hang(table: &Table, shot: &Shot) -> Self {
        let figures = Figures { seconds: f64::INFINITY, ..Figures::default() };
        let what = format!("hang: no end after {HANG} s");
        Self { what, ..Self::new(table, shot, &figures, vec![Violation::Unfinished]) }
    }
}
