//! The terminal program: screens, input and drawing.
//!
//! [`App`] holds the state and knows no terminal: keys go in, pictures come out, and what it wants done outside comes
//! back as an [`Effect`]. [`run`] is the loop around it.

mod app;
mod capabilities;
mod config;
mod effect;
mod host;
mod keymap;
mod pages;
mod plain;
mod seat;
mod shot;
mod shown;
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
    storage::{self, Places},
    table::{Layout, LayoutError, Table},
};

use plain::Beginning;

pub use app::{
    App, LEAST_SIZE, Overlay,
    bindings::{Action, Condition},
    command_palette::{Command, CommandPalette},
    document::document as keys_document,
    key_context::KeyContext,
};
pub use capabilities::{Capabilities, Depth, Glyphs};
pub use config::{
    Change, Complaint, Settings, SettingsFile, SettingsReport, SettingsTask, draft::StrokeDraft,
    saved_session::SavedSession,
};
pub use effect::{Effect, PageId};
pub use host::has_terminal as is_there;
pub use keymap::remap::Keys;
pub use pages::{
    calibration::keys::{CalibrationAction, CalibrationCondition, CalibrationContext},
    coach::{
        AdviceState, Followed, InfoPanel, Mode,
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
pub use seat::{LONGEST_FOR_GUESTS, Seat};
pub use shot::{Shot, StrokeChange, film::FilmReplay};
pub use shown::{Author, Doing, ShownShot, ShownTable, Sight, all_shown};
pub use tasks::{
    PracticeWorker,
    advice::{Advice, CoachQuery, Effort, Proposal, ShotAnalysis},
    calibration::{CalibrationReport, CalibrationTask, Judged, Judging, KeptEntries},
    drills::{AdviceTask, AttemptOutcome, DrillReport, DrillTask, JudgedStroke, LoadedRecords, ModelShot, PlayTask},
    onlooker::{Onlooker, Seen, SeenTable},
    recommender::{CoachAnswer, CoachJob, CoachNews, CoachWorker},
    reel::{Reel, ReplayShot},
    training::{FollowSlot, Keeping, Launch, Subscriptions, TrainerFailure, TrainingReport},
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
    /// Input or output is no terminal, or one that shows no pictures.
    #[error(
        "this is no terminal that can show the table; use the command line instead: \
         carom recommend --layout \"-0.71,0 0.71,0 -0.71,0.1825\", or carom --plain for the coach in lines"
    )]
    NoTerminal,
    /// The same for a guest, who may do nothing else.
    #[error("this is no terminal that can show the table; connect with one: ssh -t")]
    NoTerminalOfGuest,
    /// The first layout is not possible.
    #[error(transparent)]
    Layout(#[from] LayoutError),
    /// The terminal has failed.
    #[error("the terminal has failed: {0}")]
    Io(#[from] io::Error),
}

/// Opens the coach on `table` for the player at `seat` as they want it, until they quit. The `complaints` about the settings are
/// shown.
///
/// # Errors
/// [`TerminalError`]: no terminal, or one that fails.
pub fn run(table: Table, settings: &Settings, complaints: &[Complaint], seat: Seat) -> Result<(), TerminalError> {
    need_terminal(seat.is_guest)?;
    let layout = Layout::opening(&table);
    let places = &seat.places;
    let app = App::new(table, layout, detect(settings), seed())?
        .with_detection(detect)
        .with_seat(&seat)
        .with_settings(settings)
        .with_notice(storage::notice(places))
        .with_notice(seat.warning().as_deref());
    let app = with_what_was_left(app, places).with_complaints(&places.settings, complaints);
    Ok(host::runner::run(app, seat.places)?)
}

/// The program with what the user's last session has left: where it ended, what was typed in part, and the skill.
fn with_what_was_left(app: App, places: &Places) -> App {
    // A file that cannot be read is named by the drill screens.
    let own = Store::new(places).own_skill().unwrap_or_default();
    let last = SavedSession::load_or_put_aside(&places.last);
    let draft = StrokeDraft::read_or_put_aside(&places.draft);
    let [of_session, of_draft] = [last.as_ref().err().cloned(), draft.as_ref().err().cloned()];
    let mut app = app
        .with_saved_session(last.unwrap_or_default())
        .with_draft(draft.unwrap_or_default())
        .with_notice(of_session.as_deref())
        .with_notice(of_draft.as_deref());
    app.coach.own = own.map(|own| own.skill);
    app
}

/// The coach as a conversation in lines, on the standard input and output, for the player whose files are at `places`. Returns how many
/// lines were refused.
///
/// # Errors
/// [`TerminalError`]: a layout that is not possible, or input or output that fails.
pub fn talk(table: Table, settings: &Settings, places: &Places) -> Result<usize, TerminalError> {
    let layout = Layout::opening(&table);
    let prompt = if io::stdin().is_terminal() { "> " } else { "" };
    let coach = Coach::new(table);
    let own = Store::new(places).own_skill().unwrap_or_else(|error| {
        // As if none was kept; what is wrong is said once.
        let _ = writeln!(printing::stderr(), "note: {error}");
        None
    });
    let beginning = Beginning { layout, own: own.map(|own| own.skill), seed: seed() };
    Ok(plain::converse(coach, beginning, settings, io::stdin().lock(), printing::stdout(), prompt)?)
}

/// What the terminal can show, where the user has set that or the environment lets it be guessed.
pub fn detect(settings: &Settings) -> Capabilities {
    Capabilities::detect(|name| std::env::var(name).ok(), (settings.depth, settings.glyphs))
}

/// Any number does: it only makes random layouts differ from one start to the next.
fn seed() -> u64 {
    SystemTime::UNIX_EPOCH.elapsed().map_or(0, |since| since.as_nanos() as u64)
}

/// That there is a terminal to draw on, for a guest or for whoever has other commands besides.
///
/// # Errors
/// [`TerminalError::NoTerminal`], [`TerminalError::NoTerminalOfGuest`].
pub fn need_terminal(is_guest: bool) -> Result<(), TerminalError> {
    match is_there() {
        true => Ok(()),
        false if is_guest => Err(TerminalError::NoTerminalOfGuest),
        false => Err(TerminalError::NoTerminal),
    }
}

/// The table of somebody else, who shows it in `folder` and is called `name`, on the screen, for the player at `seat` as they want
/// it.
///
/// # Errors
/// [`TerminalError`]: no terminal, or one that fails.
pub fn follow(name: &str, folder: &Path, settings: &Settings, seat: Seat) -> Result<(), TerminalError> {
    need_terminal(seat.is_guest)?;
    let table = Table::default();
    let layout = Layout::opening(&table);
    let app = App::new(table, layout, detect(settings), seed())?
        .with_detection(detect)
        .with_seat(&seat)
        .with_settings(settings)
        .following(name.to_owned(), folder.to_owned());
    Ok(host::runner::run(app, seat.places)?)
}

/// The training screen, following `run`, or with the runs in `list`, by default the user's, to choose from.
///
/// # Errors
/// [`TerminalError`]: no terminal, or one that fails.
pub fn watch(run: Option<&Path>, list: Option<&Path>) -> Result<(), TerminalError> {
    need_terminal(false)?;
    let (settings, complaints) = Settings::load(&Settings::path());
    let places = Places::of_this_user();
    let app = App::watching(detect(&settings), run.map(Path::to_owned), list.map(Path::to_owned))?
        .with_detection(detect)
        .with_settings(&settings);
    // The coach can be opened from there, and then remembers this session in the place of the last one.
    let app = with_what_was_left(app, &places).with_complaints(&Settings::path(), &complaints);
    Ok(host::runner::run(app, places)?)
}
