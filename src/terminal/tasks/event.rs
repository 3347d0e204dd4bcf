//! Everything that happens to the program: input, signals, and what has come of its tasks.

use crossterm::event::Event as TerminalEvent;

use crate::{
    platform::Signal,
    terminal::{CalibrationReport, CoachAnswer, DrillReport, Seen, SettingsReport, TrainingReport},
};

/// Something that the screen has to deal with.
#[derive(Debug)]
pub enum Event {
    /// A key, a resize or another report of the terminal.
    Input(TerminalEvent),
    /// The terminal gives no input any more.
    InputEnded,
    /// A signal.
    Signal(Signal),
    /// The coach has answered.
    Answer(CoachAnswer),
    /// A report from the training page's background tasks.
    Training(TrainingReport),
    /// Something else is seen of somebody else's table.
    Shown(Seen),
    /// Something has come of a task of the drill screens.
    Drill(DrillReport),
    /// Something has come of a task of the settings.
    Settings(SettingsReport),
    /// Something has come of a task of the calibration's page.
    Calibration(CalibrationReport),
}
