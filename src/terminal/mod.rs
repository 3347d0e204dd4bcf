//! The terminal program: screens, input and drawing.
//!
//! [`App`] holds the state and knows no terminal: keys go in, pictures come out, and what it wants done outside comes
//! back as an [`Effect`]. [`run`] is the loop around it.

mod advice;
mod app;
mod canvas;
mod chart;
mod chord;
mod coach;
mod drills;
mod errands;
mod finder;
mod geometry;
mod history;
mod inbox;
mod input;
mod keymap;
mod last;
mod log;
mod look;
mod pace;
mod painter;
mod placing;
mod plain;
mod playback;
mod recommender;
mod runner;
mod screens;
mod session;
mod settings;
mod sgr;
mod shot;
mod signals;
mod spin;
mod sprites;
mod status;
mod theme;
mod toasts;
mod training;
mod widgets;
mod words;

use std::{
    io::{self, IsTerminal},
    path::Path,
    time::SystemTime,
};

use crate::{
    coach::Coach,
    drills::store::Store,
    learning::PolicyError,
    printing,
    storage::Places,
    table::{Layout, LayoutError, Table},
};

pub use advice::{Advice, Effort, Proposal, Study, Tutor};
pub use app::{App, Effect, Mode, Overlay, Screen};
pub use coach::{Advised, View};
pub use drills::{DrillReport, Errand, Loaded, Outcome, Position, Stroke, Taught};
pub use errands::PracticeWorker;
pub use finder::{Command, Finder};
pub use geometry::Mapping;
pub use keymap::{
    Action, CoachAction, CoachWhen, DrillAction, DrillPlace, DrillWhen, FinderAction, Place, SettingsAction,
    SettingsPlace, SettingsWhen, TrainingAction, TrainingWhen, When, document as keys_document,
};
pub use last::Last;
pub use look::{Depth, Glyphs, Look};
pub use recommender::{Answer, CoachNews, CoachWorker, Job};
pub use settings::{Change, Complaint, Keys, Settings, SettingsErrand, SettingsFile, SettingsReport, SettingsScreen};
pub use shot::Shot;
pub use theme::{Palette, UnknownPalette};
pub use toasts::{Toast, Toasts};
pub use training::{Failure, Keeping, Kept, Launch, Reel, Report, Scene, Slot, Wanted};

/// Why the terminal program cannot run.
#[derive(Debug, thiserror::Error)]
pub enum TerminalError {
    /// Input or output is no terminal, or one that shows no pictures.
    #[error(
        "this is no terminal that can show the table; use the command line instead: \
         carom recommend --layout \"-0.71,0 0.71,0 -0.71,0.1825\", or carom --plain for the coach in lines"
    )]
    NoTerminal,
    /// The first layout is not possible.
    #[error(transparent)]
    Layout(#[from] LayoutError),
    /// The bundled weights are damaged.
    #[error(transparent)]
    Policy(#[from] PolicyError),
    /// The terminal has failed.
    #[error("the terminal has failed: {0}")]
    Io(#[from] io::Error),
}

/// Opens the coach on `table` as the user wants it, until the player quits. The `complaints` about the settings are told.
///
/// # Errors
/// [`TerminalError`]: no terminal, or one that fails.
pub fn run(table: Table, settings: &Settings, complaints: &[Complaint]) -> Result<(), TerminalError> {
    let layout = Layout::opening(&table);
    if !is_there() {
        return Err(TerminalError::NoTerminal);
    }
    let places = Places::of_this_user();
    // A file that cannot be read is named by the drill screens.
    let own = Store::new(&places).own_skill().unwrap_or_default();
    let app = App::new(table, layout, detect(settings), seed())?
        .with_detection(detect)
        .with_settings(settings)
        .with_last(Last::load(&places.last))
        .with_own_skill(own.map(|own| own.skill))
        .with_complaints(&Settings::path(), complaints);
    Ok(runner::run(app, places)?)
}

/// The coach as a conversation in lines, on the standard input and output.
///
/// # Errors
/// [`TerminalError`]: a layout that is not possible, damaged weights, or input or output that fails.
pub fn talk(table: Table, settings: &Settings) -> Result<(), TerminalError> {
    let layout = Layout::opening(&table);
    let prompt = if io::stdin().is_terminal() { "> " } else { "" };
    let coach = Coach::new(table)?;
    Ok(plain::converse(coach, layout, settings, seed(), io::stdin().lock(), printing::stdout(), prompt)?)
}

/// What the terminal can show.
fn detect(settings: &Settings) -> Look {
    Look::detect(|name| std::env::var(name).ok(), settings)
}

/// Any number does: it only makes random layouts differ from one start to the next.
fn seed() -> u64 {
    SystemTime::UNIX_EPOCH.elapsed().map_or(0, |since| since.as_nanos() as u64)
}

/// Whether there is a terminal on both sides that can show pictures.
pub fn is_there() -> bool {
    session::has_terminal()
}

/// The training screen, following `run`, or with the runs in `list`, by default the user's, to choose from.
///
/// # Errors
/// [`TerminalError`]: no terminal, or one that fails.
pub fn watch(run: Option<&Path>, list: Option<&Path>) -> Result<(), TerminalError> {
    if !is_there() {
        return Err(TerminalError::NoTerminal);
    }
    let (settings, complaints) = Settings::load(&Settings::path());
    let app = App::watching(detect(&settings), run.map(Path::to_owned), list.map(Path::to_owned))?
        .with_detection(detect)
        .with_settings(&settings)
        .with_complaints(&Settings::path(), &complaints);
    Ok(runner::run(app, Places::of_this_user())?)
}
