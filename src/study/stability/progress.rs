//! A line that tells how far a long run is.

use std::{
    io::Write,
    sync::atomic::{AtomicBool, Ordering},
    time::{Duration, Instant},
};

use super::{Plan, Progress, Row, rows};
use crate::printing;

/// Time between two lines where nobody sits before them.
const SELDOM: Duration = Duration::from_secs(60);

/// Time between two on a terminal, where one replaces the other.
const OFTEN: Duration = Duration::from_millis(200);

/// Writes progress to the standard error output: one line that changes on a terminal, else a line a minute.
#[derive(Debug)]
pub struct ProgressLine {
    started: Instant,
    shown: Instant,
    terminal: bool,
}

impl Default for ProgressLine {
    fn default() -> Self {
        let now = Instant::now();
        Self { started: now, shown: now, terminal: printing::is_watched() }
    }
}

impl ProgressLine {
    /// Shows how far `what` is, unless that has just been done.
    pub fn show(&mut self, what: &str, progress: Progress) {
        if self.shown.elapsed() < if self.terminal { OFTEN } else { SELDOM } {
            return;
        }
        self.shown = Instant::now();
        let Progress { done, of, findings } = progress;
        let seconds = self.started.elapsed().as_secs();
        let line = format!("{seconds} s, {what}: {done} of {of} shots, {findings} findings");
        // A terminal that is gone is no reason to end the run.
        let _ = if self.terminal { printing::redraw_line(line) } else { writeln!(printing::stderr(), "{line}") };
    }

    /// Takes the line away.
    pub fn clear(&self) {
        if self.terminal {
            let _ = printing::clear_line();
        }
    }
}

/// All rows of the stability table, with a [`ProgressLine`]. Setting `stop` from elsewhere ends the run: the row at work is
/// then the last.
pub fn rows_with_progress(plan: &Plan, stop: &AtomicBool) -> Vec<Row> {
    let mut line = ProgressLine::default();
    let rows = rows(plan, |name, progress, _| {
        line.show(name, progress);
        !stop.load(Ordering::Relaxed)
    });
    line.clear();
    rows
}
