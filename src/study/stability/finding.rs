//! A shot in the units in which a person would write it, and a finding of a sweep: a shot that violates an invariant.

use serde::{Deserialize, Serialize};

use super::{Figures, Violation};
use crate::{
    physics::CueDegrees,
    table::{Layout, PRESETS, Table},
};

/// A layout and a stroke. A failure can be reproduced exactly from them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Shot {
    /// Initial positions of the balls.
    pub layout: Layout,
    /// The stroke.
    pub cue: CueDegrees,
}

/// A shot with violations. Its JSON is a question that `carom simulate --batch` reads if the table is a bundled one.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Finding {
    /// The table's name.
    pub preset: String,
    /// The table itself, `None` if it is bundled under this name.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub table: Option<Table>,
    /// The shot.
    #[serde(flatten)]
    pub shot: Shot,
    /// Description of the violations.
    #[serde(rename = "what")]
    pub description: String,
    /// The violations.
    pub violations: Vec<Violation>,
    /// Number of events.
    pub events: usize,
    /// Number of pieces of the balls' courses.
    pub steps: usize,
    /// Computing time, ms; for slow shots the minimum of several attempts if these were affordable.
    pub ms: f64,
}

impl Finding {
    /// Creates a finding.
    pub fn new(table: &Table, shot: &Shot, measured: &Figures, violations: Vec<Violation>) -> Self {
        let words: Vec<String> = violations.iter().map(ToString::to_string).collect();
        Self {
            preset: table.name.clone(),
            table: (!PRESETS.contains(&table.name.as_str())).then(|| table.clone()),
            shot: *shot,
            description: words.join("; "),
            violations,
            events: measured.events,
            steps: measured.steps,
            ms: 1e3 * measured.seconds,
        }
    }
}
