//! Practice through the real binary: sessions, scores, positions, and their safety when something goes wrong.

mod data_safety;
mod positions;
mod scores;
mod sides;

use serde_json::Value;

/// Returns the lines of this kind.
fn of_kind<'a>(lines: &'a [Value], kind: &str) -> Vec<&'a Value> {
    lines.iter().filter(|line| line["kind"] == kind).collect()
}
