//! The terminal program: screens, input and drawing.
//!
//! [`App`] holds the state and has no terminal: it receives keys, draws frames and returns an [`Effect`] for whatever has to happen
//! outside. [`run`] is the event loop around it.

mod app;
mod capabilities;
mod config;
mod effect;
mod host;
mod keymap;
mod pages;
mod plain;
mod seat;
mod shared_table;
mod shot;
mod tasks;
mod terms;
mod ui;
mod words;

use std::{
    io::{self, IsTerminal, Write},
    path::Path,
    time::SystemTime,
};

use crate::{
    coach::Coach,
    drills::store::Store,
    printing,
    storage::{self, DataPaths},
    table::{Layout, LayoutError, Table},
};

use plain::InitialState;

pub use app::{
    App, MIN_SIZE, Overlay,
    bindings::{Action, Condition},
    command_palette::{Command, CommandPalette},
    document::document as keys_document,
    key_context::KeyContext,
};
pub use capabilities::{Capabilities, Depth, Glyphs};
pub use config::{
    Change, Mistake, Settings, SettingsFile, SettingsReport, SettingsTask, draft::StrokeDraft,
    saved_session::SavedSession,
};
pub use effect::{Effect, PageId};
pub use host::has_terminal as is_there;
pub use keymap::remap::Keys;
pub use pages::{
    calibration::keys::{CalibrationAction, CalibrationCondition, CalibrationContext},
    coach::{
        AdviceState, FollowedPlayer, InfoPanel, Mode,
        keys::{CoachAction, CoachCondition},
    },
    drills::keys::{DrillAction, DrillCondition, DrillContext},
    settings::{
        SettingsPage,
        keys::{SettingsAction, SettingsCondition, SettingsContext},
    },
    training::keys::{TrainingAction, TrainingCondition, TrainingContext},
};
pub use plain::follow::follow_in_lines;
pub use seat::{MAX_GUEST_THINK_MS, Seat};
pub use shared_table::{Activity, Author, SharedShot, SharedTable, SharedTableState, sharing_players};
pub use shot::{Shot, StrokeChange, film::FilmReplay};
pub use tasks::{
    PracticeWorker,
    advice::{Advice, CoachQuery, Effort, Proposal, ShotAnalysis},
    calibration::{CalibrationReport, CalibrationTask, Evaluation, EvaluationTask, SavedEntries},
    drills::{AdviceTask, AttemptOutcome, DrillReport, DrillTask, LoadedRecords, ModelShot, PlayTask, RateStrokeTask},
    recommender::{CoachAnswer, CoachEvent, CoachJob, CoachWorker},
    reel::{Reel, ReplayShot},
    table_watcher::{FollowedTable, FollowedTableState, TableWatcher},
    training::{FollowSlot, Launch, SavePolicyTask, Subscriptions, TrainerFailure, TrainingReport},
};
pub use terms::Terms;
pub use ui::{
    geometry::Mapping,
    theme::{ThemeName, UnknownTheme},
    toasts::{Toast, Toasts},
};

/// Why the terminal program cannot run.
#[derive(Debug, thiserror::Error)]
pub enum TerminalError {
    /// Input or output is not a terminal, or the terminal cannot draw pictures.
    #[error(
        "this is not a terminal that can show the table; use the command line instead: \
         carom recommend --layout \"-0.71,0.1825 -0.71,0 0.71,0\", or carom --plain for the coach in lines"
    )]
    NoTerminal,
    /// The same for a guest, who may use no other command.
    #[error("this is not a terminal that can show the table; connect with one: ssh -t")]
    NoTerminalOfGuest,
    /// The layout at the start is not possible.
    #[error(transparent)]
    Layout(#[from] LayoutError),
    /// Reading from or writing to the terminal failed.
    #[error("the terminal has failed: {0}")]
    Io(#[from] io::Error),
}

/// Opens the coach on `table` with the settings of the player at `seat`, until they quit. The `mistakes` about the settings are shown as
/// toasts.
///
/// # Errors
/// [`TerminalError`]: there is no terminal, or it fails.
pub fn run(table: Table, settings: &Settings, mistakes: &[Mistake], seat: Seat) -> Result<(), TerminalError> {
    require_terminal(seat.is_guest)?;
    let layout = Layout::opening(&table);
    let paths = &seat.paths;
    let app = App::new(table, layout, detect(settings), seed())?
        .with_detection(detect)
        .with_seat(&seat)
        .with_settings(settings)
        .with_notice(storage::notice(paths))
        .with_notice(seat.warning().as_deref());
    let app = with_saved_state(app, paths).with_mistakes(&paths.settings, mistakes);
    Ok(host::runner::run(app, seat.paths)?)
}

/// Restores what the user's last session saved: its state, the calibration stroke that was typed in part, and the user's own skill.
fn with_saved_state(app: App, paths: &DataPaths) -> App {
    // The drill screens report a file that cannot be read.
    let own = Store::new(paths).own_skill().unwrap_or_default();
    let last = SavedSession::load_or_rename_unreadable(&paths.last_session);
    let draft = StrokeDraft::load_or_rename_unreadable(&paths.draft);
    let [of_session, of_draft] = [last.as_ref().err().cloned(), draft.as_ref().err().cloned()];
    let mut app = app
        .with_saved_session(last.unwrap_or_default())
        .with_draft(draft.unwrap_or_default())
        .with_notice(of_session.as_deref())
        .with_notice(of_draft.as_deref());
    app.coach.own_skill = own.map(|own| own.skill);
    app
}

/// Runs the coach in plain mode, as a conversation in lines on standard input and output, for the player whose files are at `paths`.
/// Returns the number of lines that were refused.
///
/// # Errors
/// [`TerminalError`]: the layout is not possible, or input or output fails.
pub fn run_plain(table: Table, settings: &Settings, paths: &DataPaths) -> Result<usize, TerminalError> {
    let layout = Layout::opening(&table);
    let prompt = if io::stdin().is_terminal() { "> " } else { "" };
    let coach = Coach::new(table);
    let own = Store::new(paths).own_skill().unwrap_or_else(|error| {
        // Go on as if no skill were saved; the error is reported once.
        let _ = writeln!(printing::stderr(), "note: {error}");
        None
    });
    let initial = InitialState { layout, own: own.map(|own| own.skill), seed: seed() };
    Ok(plain::converse(coach, initial, settings, io::stdin().lock(), printing::stdout(), prompt)?)
}

/// Detects what the terminal can show: from the settings if set there, otherwise from the environment.
pub fn detect(settings: &Settings) -> Capabilities {
    Capabilities::detect(|name| std::env::var(name).ok(), (settings.depth, settings.glyphs))
}

/// Seed for random layouts. Any number will do, as long as it differs from one start to the next.
fn seed() -> u64 {
    SystemTime::UNIX_EPOCH.elapsed().map_or(0, |since| since.as_nanos() as u64)
}

/// Checks that there is a terminal to draw on. The error depends on whether the user is a guest, who has no other commands.
///
/// # Errors
/// [`TerminalError::NoTerminal`], [`TerminalError::NoTerminalOfGuest`].
pub fn require_terminal(is_guest: bool) -> Result<(), TerminalError> {
    match is_there() {
        true => Ok(()),
        false if is_guest => Err(TerminalError::NoTerminalOfGuest),
        false => Err(TerminalError::NoTerminal),
    }
}

/// Shows the table of another player, called `name`, who shares it in `folder`, for the player at `seat` with their settings.
///
/// # Errors
/// [`TerminalError`]: there is no terminal, or it fails.
pub fn follow(name: &str, folder: &Path, settings: &Settings, seat: Seat) -> Result<(), TerminalError> {
    require_terminal(seat.is_guest)?;
    let table = Table::default();
    let layout = Layout::opening(&table);
    let app = App::new(table, layout, detect(settings), seed())?
        .with_detection(detect)
        .with_seat(&seat)
        .with_settings(settings)
        .following(name.to_owned(), folder.to_owned());
    Ok(host::runner::run(app, seat.paths)?)
}

/// Opens the training screen, either following `run` or with a list of the runs in `list` (by default the user's).
///
/// # Errors
/// [`TerminalError`]: there is no terminal, or it fails.
pub fn watch(run: Option<&Path>, list: Option<&Path>) -> Result<(), TerminalError> {
    require_terminal(false)?;
    let (settings, mistakes) = Settings::load(&Settings::path());
    let paths = DataPaths::of_this_user();
    let app = App::watching(detect(&settings), run.map(Path::to_owned), list.map(Path::to_owned))?
        .with_detection(detect)
        .with_settings(&settings);
    // The coach can be opened from there, and then saves this session in place of the last one.
    let app = with_saved_state(app, &paths).with_mistakes(&Settings::path(), &mistakes);
    Ok(host::runner::run(app, paths)?)
}
