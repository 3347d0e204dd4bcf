//! The stability table with a line that tells how far it is.

use std::sync::atomic::{AtomicBool, Ordering};

use super::{Plan, Row, rows};
use crate::printing::ProgressLine;

/// All rows of the stability table, with a [`ProgressLine`]. Setting `stop` from elsewhere ends the run: the row at work is
/// then the last.
pub fn rows_with_progress(plan: &Plan, stop: &AtomicBool) -> Vec<Row> {
    let mut line = ProgressLine::default();
    let rows = rows(plan, |name, progress, _| {
        line.show(format_args!("{name}: {progress}"));
        !stop.load(Ordering::Relaxed)
    });
    line.clear();
    rows
}
