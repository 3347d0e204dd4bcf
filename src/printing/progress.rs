//! A line that tells how far a long run is.

use std::{
    fmt::Display,
    io::Write,
    time::{Duration, Instant},
};

use super::{clear_line, is_watched, redraw_line, stderr};

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
        Self { started: now, shown: now, terminal: is_watched() }
    }
}

impl ProgressLine {
    /// Shows how far the run is, unless that has just been done.
    pub fn show(&mut self, progress: impl Display) {
        if self.shown.elapsed() < if self.terminal { OFTEN } else { SELDOM } {
            return;
        }
        self.shown = Instant::now();
        let line = format!("{} s, {progress}", self.started.elapsed().as_secs());
        // A terminal that is gone is no reason to end the run.
        let _ = if self.terminal { redraw_line(line) } else { writeln!(stderr(), "{line}") };
    }

    /// Takes the line away.
    pub fn clear(&self) {
        if self.terminal {
            let _ = clear_line();
        }
    }
}
