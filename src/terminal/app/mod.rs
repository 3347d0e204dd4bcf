//! State of the program. It draws on any frame and needs no terminal.
//!
//! This module holds what all screens share; each screen has a state of its own. [`view`] draws.

pub mod bindings;
pub mod command_palette;
pub mod document;
pub mod key_context;
mod keys;
mod mouse;
mod reports;
mod settings;
mod tabs;
mod view;

pub use view::MIN_SIZE;

use std::{
    path::{Path, PathBuf},
    time::Duration,
};

use ratatui::{
    Frame,
    layout::{Rect, Size},
};

use crate::{
    drills::Session,
    storage::DataPaths,
    table::{Layout, LayoutError, Table},
    terminal::{
        Action, CalibrationAction, Capabilities, CoachAction, CommandPalette, DrillAction, Effect, Glyphs, Keys,
        MAX_GUEST_THINK_MS, Mistake, PageId, SavedSession, Seat, Settings, SettingsAction, SettingsPage, StrokeDraft,
        Subscriptions, ThemeName, Toasts, TrainingAction,
        pages::{
            Page,
            calibration::CalibrationPage,
            coach::CoachPage,
            drills::{DrillsPage, TransferredPosition},
            training::TrainingPage,
        },
        shared_table::SharedTable,
        ui::{Message, Theme},
    },
};

/// A page shown over the screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Overlay {
    /// The help: all keys.
    Help,
    /// All refusals and failures so far.
    Messages,
    /// The glossary of players' terms.
    Glossary,
}

/// Complete state of the terminal program.
#[derive(Debug)]
pub struct App {
    /// The open screen.
    pub screen: PageId,
    /// The coach's screen.
    pub coach: CoachPage,
    /// The training screen.
    pub training: TrainingPage,
    /// The drill screens.
    pub drills: DrillsPage,
    /// The settings screen.
    pub settings: SettingsPage,
    /// The calibration screen.
    pub calibration: CalibrationPage,
    /// File of a table to play on once the settings file has been read.
    pending_table: Option<PathBuf>,
    /// The settings in force.
    in_force: Settings,
    /// The screen that was open before the settings.
    before: PageId,
    /// The overlay that is open, and the index of its first visible line.
    pub overlay: Option<(Overlay, usize)>,
    /// The command palette while it is open.
    pub command_palette: Option<CommandPalette>,
    /// Refusals and failures shown as toasts, and those of earlier.
    pub toasts: Toasts,
    /// The screen's area, empty until its size is known. Used for mouse hits and for the scroll range of overlays.
    area: Rect,
    /// Whether the program captures the mouse; otherwise the terminal keeps it for its own selection.
    pub mouse: bool,
    /// What the terminal can show, under the present theme.
    pub caps: Capabilities,
    /// What the terminal can show with a theme that has colours.
    full_caps: Capabilities,
    /// The finest character set that may be used: octants only if the user asked for them.
    finest: Glyphs,
    theme: Theme,
    theme_name: ThemeName,
    /// The stroke that was typed in part when the last session ended.
    pub(super) draft_at_start: Option<StrokeDraft>,
    /// Whether the player is a guest of this machine.
    is_guest: bool,
    /// Detects what the terminal can show under given settings; if `None`, the capabilities stay as at the start.
    detect: Option<fn(&Settings) -> Capabilities>,
}

impl App {
    /// Creates the program; `seed` seeds the random layouts.
    ///
    /// # Errors
    /// Fails if the layout is not possible on the table.
    pub fn new(table: Table, layout: Layout, caps: Capabilities, seed: u64) -> Result<Self, LayoutError> {
        Ok(Self {
            screen: PageId::Coach,
            coach: CoachPage::new(table, layout, seed)?,
            training: TrainingPage::new(DataPaths::of_this_user()),
            drills: DrillsPage::new(DataPaths::of_this_user(), seed),
            settings: SettingsPage::new(DataPaths::of_this_user(), bindings::key_pages()),
            calibration: CalibrationPage::new(DataPaths::of_this_user()),
            pending_table: None,
            in_force: Settings::default(),
            before: PageId::Coach,
            overlay: None,
            command_palette: None,
            toasts: Toasts::default(),
            area: Rect::default(),
            mouse: true,
            caps,
            full_caps: caps,
            finest: caps.finest(),
            theme: Theme::new(caps.depth),
            theme_name: ThemeName::default(),
            draft_at_start: None,
            is_guest: false,
            detect: None,
        })
    }

    /// Creates the program with the training screen open: following a run, or showing the list of runs in `list`, by default the user's.
    /// Leaving its first page ends the program.
    ///
    /// # Errors
    /// None in practice: the opening position is possible on the default table.
    pub fn watching(caps: Capabilities, run: Option<PathBuf>, list: Option<PathBuf>) -> Result<Self, LayoutError> {
        let table = Table::default();
        let layout = Layout::opening(&table);
        let mut app = Self::new(table, layout, caps, 0)?;
        app.screen = PageId::Training;
        app.training.open_as_only_page(run, list);
        Ok(app)
    }

    /// Sets where the player's files are.
    #[must_use]
    pub fn with_paths(mut self, paths: DataPaths) -> Self {
        self.training.folder.clone_from(&paths.runs);
        self.drills.places = paths.clone();
        self.settings.places = paths.clone();
        self.calibration = CalibrationPage::new(paths.clone());
        self.training.places = paths;
        self
    }

    /// Sets the player at the terminal.
    #[must_use]
    pub fn with_seat(self, seat: &Seat) -> Self {
        let mut app = self.with_paths(seat.paths.clone());
        app.is_guest = seat.is_guest;
        app.coach.player.clone_from(&seat.player);
        app.training.is_guest = seat.is_guest;
        if seat.is_guest {
            app.coach.limit_thinking_time(Duration::from_millis(MAX_GUEST_THINK_MS));
        }
        app
    }

    /// Shows only the table of another player, who shares it in `folder`.
    #[must_use]
    pub fn following(mut self, name: String, folder: PathBuf) -> Self {
        self.coach.follow(name, folder);
        self
    }

    /// Applies the user's settings.
    #[must_use]
    pub fn with_settings(mut self, settings: &Settings) -> Self {
        self.coach.apply_settings(settings);
        self.drills.apply_settings(settings);
        self.calibration.units = settings.units;
        self.settings.settings = settings.clone();
        self.in_force = settings.clone();
        self.mouse = settings.mouse;
        self.choose_theme(settings.theme);
        self
    }

    /// Sets `detect`, which is called again whenever the display settings change.
    #[must_use]
    pub fn with_detection(mut self, detect: fn(&Settings) -> Capabilities) -> Self {
        self.detect = Some(detect);
        self
    }

    /// Offers to continue where the last session ended.
    #[must_use]
    pub fn with_saved_session(mut self, last: Option<SavedSession>) -> Self {
        self.coach.restore_last_session(last);
        self
    }

    /// Restores the calibration stroke that was typed in part when the last session ended.
    #[must_use]
    pub fn with_draft(mut self, draft: Option<StrokeDraft>) -> Self {
        let Some(draft) = draft else { return self };
        let left = StrokeDraft { is_announced: false, ..draft.clone() };
        let is_announced = draft.is_announced;
        if let Some(test) = self.calibration.restore_draft(draft) {
            self.draft_at_start = Some(left);
            if !is_announced {
                let sentence = format!("a stroke of {test} that was typed in part is kept: F7 goes on with it");
                // Cleared by the next key, like an answer: otherwise it would cover the form that it offers.
                self.toasts.push(sentence, true);
            }
        }
        self
    }

    /// Returns the stroke that is typed in part, for the next session. It is announced again if anything was typed since the last start.
    pub fn draft(&self) -> Option<StrokeDraft> {
        let draft = self.calibration.draft()?;
        let is_announced = self.draft_at_start.as_ref() == Some(&draft);
        Some(StrokeDraft { is_announced, ..draft })
    }

    /// Returns the state that the next session can continue from; `None` if there is nothing worth keeping.
    pub fn saved_session(&self) -> Option<SavedSession> {
        // Exams, games and matches are offered even if the user did other things after them.
        let is_open = |session: &&Session| self.screen == PageId::Drills || session.is_exam();
        self.coach.saved_session(self.drills.unfinished().filter(is_open), self.drills.open_game())
    }

    /// Shows what has changed since the user's last session.
    #[must_use]
    pub fn with_notice(mut self, notice: Option<&str>) -> Self {
        self.toasts.push_first(notice.map(str::to_owned).as_slice());
        self
    }

    /// Shows what is wrong with the settings.
    #[must_use]
    pub fn with_mistakes(mut self, file: &Path, mistakes: &[Mistake]) -> Self {
        self.toasts.push_first(&Mistake::sentences(file, mistakes));
        self
    }

    /// Performs an action of an enabled binding.
    pub fn update(&mut self, action: Action) -> Option<Effect> {
        match action {
            Action::Quit => return Some(Effect::Quit),
            Action::Suspend => return Some(Effect::Suspend),
            Action::OpenHelp => self.open_overlay(Overlay::Help),
            Action::OpenMessages => self.open_overlay(Overlay::Messages),
            Action::OpenGlossary => self.open_overlay(Overlay::Glossary),
            Action::OpenMatch => {
                let opened = self.open(PageId::Drills);
                let coach = &mut self.coach;
                return Effect::both(opened, self.drills.open_match(|| coach.take_open_match()));
            }
            Action::CloseOverlay => self.close_overlay(),
            Action::ScrollOverlay(lines) => {
                self.overlay = self.overlay.map(|(page, top)| {
                    let end = view::overlay_end(self, page, self.area);
                    (page, top.min(end).saturating_add_signed(lines).min(end))
                });
            }
            Action::NextGlyphs => self.next_glyphs(),
            Action::NextTheme => self.next_theme(),
            Action::Open(screen) => return self.open(screen),
            Action::Answer(yes) => return self.update(self.answer(yes)),
            Action::Coach(CoachAction::OpenDrills) => return self.open(PageId::Drills),
            Action::Coach(CoachAction::OpenTraining) => return self.open(PageId::Training),
            Action::Coach(CoachAction::OpenFilms) => {
                let effect = self.open(PageId::Drills);
                self.drills.open_films();
                return effect;
            }
            Action::OpenPalette => self.command_palette = Some(CommandPalette::default()),
            Action::ClosePalette => self.command_palette = None,
            Action::ChooseCommand => return self.choose_command(),
            Action::PaletteLine(lines) => self.move_palette_mark(lines),
            Action::Coach(CoachAction::Resume) => return self.resume(),
            Action::Coach(action) => {
                return match self.coach.update(action) {
                    // The drills may not know the folder of the positions yet; the first task loads it.
                    Some(Effect::Drill(tasks)) => {
                        Some(Effect::Drill(std::iter::once(self.drills.load()).chain(tasks).collect()))
                    }
                    effect => effect,
                };
            }
            Action::Drill(action) => {
                let effect = self.drills.update(action);
                let balls = self.drills.position_for_coach.take();
                if let Some(exam) = self.drills.unfinished_exam.take()
                    && self.coach.keep_exam(exam)
                {
                    let words = "the exam is kept; c on the coach's page (F2) goes on with it after what else was left";
                    self.drills.message = Some(Message::plain(words));
                }
                if balls.is_some() || self.drills.is_closed() {
                    self.open(PageId::Coach);
                }
                if let Some(TransferredPosition { table, layout, rule, cue_ball }) = balls {
                    self.coach.set_position(&table, layout, rule, cue_ball);
                }
                return effect;
            }
            Action::Training(action) => {
                let effect = self.training.update(action);
                if self.training.is_closed() {
                    return if self.training.is_only_page { Some(Effect::Quit) } else { self.open(PageId::Coach) };
                }
                return effect;
            }
            Action::Calibration(action) => {
                let effect = self.calibration.update(action);
                if self.calibration.is_closed {
                    return self.open(PageId::Coach);
                }
                return match self.calibration.table_to_use.take() {
                    Some(path) => Some(self.use_table(path)),
                    None => effect,
                };
            }
            Action::Settings(action) => {
                let effect = self.settings.update(action);
                if self.settings.is_closed {
                    return self.open(self.before);
                }
                self.apply_changed_settings();
                return effect;
            }
        }
        None
    }

    /// The exam that is still open on the drill screens, if it is the next to resume.
    pub(super) fn exam_to_show(&self) -> Option<&Session> {
        self.drills.unfinished().filter(|open| open.is_exam() && self.coach.resumes_open(open))
    }

    /// Resumes the exam or the session that was left.
    fn resume(&mut self) -> Option<Effect> {
        if let Some(exam) = self.exam_to_show().cloned() {
            self.coach.note_resumed(&exam);
            let effect = self.open(PageId::Drills);
            self.drills.show_session();
            return effect;
        }
        let practice = self.coach.resume()?;
        self.switch_to(PageId::Drills);
        let effect = self.drills.resume(practice, self.coach.query.skill);
        // An exam that was open before waits until all others have been continued.
        self.coach.keep_interrupted_exam(self.drills.unfinished_exam.take());
        Some(effect)
    }

    /// The action that answers the open page's question.
    const fn answer(&self, yes: bool) -> Action {
        match self.screen {
            PageId::Coach => Action::Coach(CoachAction::Answer(yes)),
            PageId::Training => Action::Training(TrainingAction::Answer(yes)),
            PageId::Drills => Action::Drill(DrillAction::Answer(yes)),
            PageId::Settings => Action::Settings(SettingsAction::Answer(yes)),
            PageId::Calibration => Action::Calibration(CalibrationAction::Answer(yes)),
        }
    }

    /// Returns what to poll for the open page; reports go to [`App::receive_training`] and `CoachPage::see`.
    pub fn subscriptions(&self) -> Subscriptions {
        if let Some(followed) = self.coach.followed() {
            return Subscriptions { followed_table: Some(followed.folder.clone()), ..Subscriptions::default() };
        }
        if self.screen == PageId::Training { self.training.subscriptions() } else { Subscriptions::default() }
    }

    /// Returns the view of the coach's table that others may see, while the player shares it.
    pub fn shared_table(&self) -> Option<SharedTable> {
        self.coach.shared_table(self.screen == PageId::Coach)
    }

    /// Stops sharing the table because its view could not be written, and shows `sentence`.
    pub fn sharing_failed(&mut self, sentence: String) {
        self.coach.stop_sharing();
        self.report_failure(sentence);
    }

    /// Advances all animations by `seconds`.
    pub fn tick(&mut self, seconds: f64) {
        self.toasts.tick(seconds);
        if !self.is_covered() {
            self.page_mut().tick(seconds);
        }
    }

    /// Seconds until the next frame; `None` while nothing is animated.
    pub fn frame_interval(&self) -> Option<f64> {
        self.page().frame_interval().filter(|_| !self.is_covered())
    }

    /// Whether an overlay or the command palette covers the page. The page's animations then pause, so that the user misses nothing.
    pub(super) const fn is_covered(&self) -> bool {
        self.overlay.is_some() || self.command_palette.is_some()
    }

    /// Sets the size of the terminal.
    pub const fn resize(&mut self, size: Size) {
        self.area = Rect::new(0, 0, size.width, size.height);
    }

    /// Draws the screen.
    pub fn draw(&self, frame: &mut Frame) {
        view::draw(self, frame.area(), frame.buffer_mut());
    }

    /// The open page.
    pub fn page(&self) -> &dyn Page {
        match self.screen {
            PageId::Coach => &self.coach,
            PageId::Training => &self.training,
            PageId::Drills => &self.drills,
            PageId::Settings => &self.settings,
            PageId::Calibration => &self.calibration,
        }
    }

    pub(super) fn page_mut(&mut self) -> &mut dyn Page {
        match self.screen {
            PageId::Coach => &mut self.coach,
            PageId::Training => &mut self.training,
            PageId::Drills => &mut self.drills,
            PageId::Settings => &mut self.settings,
            PageId::Calibration => &mut self.calibration,
        }
    }

    /// The user's own key bindings.
    pub const fn keys(&self) -> &Keys {
        &self.settings.settings.keys
    }

    /// The colours for the open page.
    pub fn theme(&self) -> Theme {
        self.theme.with_cue_ball(self.page().cue_ball())
    }
}
