//! Events of the program: input, signals, and reports of background tasks.

use crossterm::event::Event as TerminalEvent;

use crate::{
    platform::Signal,
    terminal::{CalibrationReport, CoachAnswer, DrillReport, FollowedTableState, SettingsReport, TrainingReport},
};

/// An event that the screen has to handle.
#[derive(Debug)]
pub enum Event {
    /// A key press, a resize or another event of the terminal.
    Input(TerminalEvent),
    /// The terminal's input has ended.
    InputEnded,
    /// A signal.
    Signal(Signal),
    /// An answer of the coach.
    Answer(CoachAnswer),
    /// A report from the training page's background tasks.
    Training(TrainingReport),
    /// A change of another player's table.
    FollowedTable(FollowedTableState),
    /// A report from a task of the drill screens.
    Drill(DrillReport),
    /// A report from a task of the settings.
    Settings(SettingsReport),
    /// A report from a task of the calibration page.
    Calibration(CalibrationReport),
}
