//! A progress line for long runs.

use std::{
    fmt::Display,
    io::Write,
    time::{Duration, Instant},
};

use super::{clear_line, is_stderr_terminal, redraw_line, stderr};

/// Time between two lines if the output is not a terminal.
const LINE_INTERVAL: Duration = Duration::from_secs(60);

/// Time between two updates on a terminal, where each replaces the one before.
const REDRAW_INTERVAL: Duration = Duration::from_millis(200);

/// Writes progress to the standard error: one line that is updated on a terminal, otherwise one line per minute.
#[derive(Debug)]
pub struct ProgressLine {
    started: Instant,
    shown: Instant,
    terminal: bool,
}

impl Default for ProgressLine {
    fn default() -> Self {
        let now = Instant::now();
        Self { started: now, shown: now, terminal: is_stderr_terminal() }
    }
}

impl ProgressLine {
    /// Shows the progress, unless it was shown very recently.
    pub fn show(&mut self, progress: impl Display) {
        if self.shown.elapsed() < if self.terminal { REDRAW_INTERVAL } else { LINE_INTERVAL } {
            return;
        }
        self.shown = Instant::now();
        let line = format!("{} s, {progress}", self.started.elapsed().as_secs());
        // A closed terminal is no reason to end the run.
        let _ = if self.terminal { redraw_line(line) } else { writeln!(stderr(), "{line}") };
    }

    /// Removes the line.
    pub fn clear(&self) {
        if self.terminal {
            let _ = clear_line();
        }
    }
}
