//! The state of the program; it draws on any frame and needs no terminal.
//!
//! What its screens share is here; each screen has a state of its own. [`view`] is what drawing reads.

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

pub use view::SMALLEST as LEAST_SIZE;

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
    storage::Places,
    table::{Layout, LayoutError, Table},
    terminal::{
        Action, CalibrationAction, Capabilities, CoachAction, CommandPalette, Complaint, DrillAction, Effect, Glyphs,
        Keys, LONGEST_FOR_GUESTS, PageId, SavedSession, Seat, Settings, SettingsAction, SettingsPage, StrokeDraft,
        Subscriptions, ThemeName, Toasts, TrainingAction,
        pages::{
            Page,
            calibration::CalibrationPage,
            coach::CoachPage,
            drills::{Balls, DrillsPage},
            training::TrainingPage,
        },
        shown::ShownTable,
        ui::Theme,
    },
};

/// A page that lies over the screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Overlay {
    /// Every key.
    Help,
    /// What was refused or has failed so far.
    Messages,
    /// What the words of players mean.
    Glossary,
}

/// The whole state of the terminal program.
#[derive(Debug)]
pub struct App {
    /// Which screen is shown.
    pub screen: PageId,
    /// The coach's screen.
    pub coach: CoachPage,
    /// The training screen.
    pub training: TrainingPage,
    /// The drill screens.
    pub drills: DrillsPage,
    /// The settings' screen.
    pub settings: SettingsPage,
    /// The calibration's page.
    pub calibration: CalibrationPage,
    /// The file of a table that is to be played on as soon as the settings' file was read.
    pending_table: Option<PathBuf>,
    /// The settings that hold.
    in_force: Settings,
    /// The screen before the settings.
    before: PageId,
    /// The page that lies over the screen, and its first line.
    pub overlay: Option<(Overlay, u16)>,
    /// The command palette while it is open.
    pub command_palette: Option<CommandPalette>,
    /// Refusals and failures, for as long as they are shown, and those before.
    pub toasts: Toasts,
    /// The screen, nothing before its size is known: where the mouse points, and how far the help can be scrolled.
    area: Rect,
    /// Whether the mouse is wanted; otherwise the terminal keeps it for its own selection.
    pub mouse: bool,
    /// What the terminal can show.
    pub caps: Capabilities,
    /// What it can show with any theme that has colours.
    full_caps: Capabilities,
    /// The finest characters to draw with: octants only where they were asked for.
    finest: Glyphs,
    theme: Theme,
    theme_name: ThemeName,
    /// The stroke that was typed in part when the last session ended.
    pub(super) draft_at_start: Option<StrokeDraft>,
    /// Whether the player is a guest of this machine.
    is_guest: bool,
    /// Finds out what the terminal can show under some settings; without it that stays as at the start.
    detect: Option<fn(&Settings) -> Capabilities>,
}

impl App {
    /// The program at its start; `seed` decides about random layouts.
    ///
    /// # Errors
    /// A layout that is not possible on the table.
    pub fn new(table: Table, layout: Layout, caps: Capabilities, seed: u64) -> Result<Self, LayoutError> {
        Ok(Self {
            screen: PageId::Coach,
            coach: CoachPage::new(table, layout, seed)?,
            training: TrainingPage::new(Places::of_this_user()),
            drills: DrillsPage::new(Places::of_this_user(), seed),
            settings: SettingsPage::new(Places::of_this_user(), bindings::key_pages()),
            calibration: CalibrationPage::new(Places::of_this_user()),
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

    /// The program that opens with the training screen: with a run, or with the list of those in `list`, by default the
    /// user's. Going back from its first page ends the program.
    ///
    /// # Errors
    /// None with the default table, whose opening position is possible.
    pub fn watching(caps: Capabilities, run: Option<PathBuf>, list: Option<PathBuf>) -> Result<Self, LayoutError> {
        let table = Table::default();
        let layout = Layout::opening(&table);
        let mut app = Self::new(table, layout, caps, 0)?;
        app.screen = PageId::Training;
        app.training.open_alone(run, list);
        Ok(app)
    }

    /// The same program with the player's files elsewhere.
    #[must_use]
    pub fn with_places(mut self, places: Places) -> Self {
        self.training.folder.clone_from(&places.runs);
        self.drills.places = places.clone();
        self.settings.places = places.clone();
        self.calibration = CalibrationPage::new(places.clone());
        self.training.places = places;
        self
    }

    /// The same program for the player who sits there.
    #[must_use]
    pub fn with_seat(self, seat: &Seat) -> Self {
        let mut app = self.with_places(seat.places.clone());
        app.is_guest = seat.is_guest;
        app.coach.player.clone_from(&seat.player);
        app.training.is_guest = seat.is_guest;
        if seat.is_guest {
            app.coach.think_at_most(Duration::from_millis(LONGEST_FOR_GUESTS));
        }
        app
    }

    /// The same program that shows the table of somebody else, who shows it in `folder`, and nothing else.
    #[must_use]
    pub fn following(mut self, name: String, folder: PathBuf) -> Self {
        self.coach.follow(name, folder);
        self
    }

    /// The same program as the user wants it.
    #[must_use]
    pub fn with_settings(mut self, settings: &Settings) -> Self {
        self.coach.take_settings(settings);
        self.drills.take_settings(settings);
        self.calibration.units = settings.units;
        self.settings.settings = settings.clone();
        self.in_force = settings.clone();
        self.mouse = settings.mouse;
        self.choose_theme(settings.theme);
        self
    }

    /// The same program, which asks `detect` what the terminal can show whenever that is set otherwise.
    #[must_use]
    pub fn with_detection(mut self, detect: fn(&Settings) -> Capabilities) -> Self {
        self.detect = Some(detect);
        self
    }

    /// The same program with the way back to where the last session ended.
    #[must_use]
    pub fn with_saved_session(mut self, last: Option<SavedSession>) -> Self {
        self.coach.offer(last);
        self
    }

    /// The same program with the stroke of a calibration that was typed in part when the last session ended.
    #[must_use]
    pub fn with_draft(mut self, draft: Option<StrokeDraft>) -> Self {
        let Some(draft) = draft else { return self };
        let left = StrokeDraft { is_told: false, ..draft.clone() };
        let is_told = draft.is_told;
        if let Some(test) = self.calibration.go_on_with(draft) {
            self.draft_at_start = Some(left);
            if !is_told {
                let sentence = format!("a stroke of {test} that was typed in part is kept: F7 goes on with it");
                // It goes with the next key, as an answer does: it would lie on the form that it offers.
                self.toasts.push(sentence, true);
            }
        }
        self
    }

    /// The stroke that is typed in part, for the next session; it is told of again where anything has been typed since the last start.
    pub fn draft(&self) -> Option<StrokeDraft> {
        let draft = self.calibration.draft()?;
        let is_told = self.draft_at_start.as_ref() == Some(&draft);
        Some(StrokeDraft { is_told, ..draft })
    }

    /// What the next session may go on from; `None` where nothing has been done that is worth it.
    pub fn saved_session(&self) -> Option<SavedSession> {
        // An exam, a game and a match are gone on with whatever was done after them.
        let is_open = |session: &&Session| self.screen == PageId::Drills || session.is_exam();
        self.coach.saved_session(self.drills.unfinished().filter(is_open), self.drills.open_game())
    }

    /// Says what has changed since the user was here before.
    #[must_use]
    pub fn with_notice(mut self, notice: Option<&str>) -> Self {
        self.toasts.push_first(notice.map(str::to_owned).as_slice());
        self
    }

    /// Says that something is wrong with the settings.
    #[must_use]
    pub fn with_complaints(mut self, file: &Path, complaints: &[Complaint]) -> Self {
        self.toasts.push_first(&Complaint::sentences(file, complaints));
        self
    }

    /// Does what an enabled binding asks for.
    pub fn update(&mut self, action: Action) -> Option<Effect> {
        match action {
            Action::Quit => return Some(Effect::Quit),
            Action::Suspend => return Some(Effect::Suspend),
            Action::OpenHelp => self.lay_over(Overlay::Help),
            Action::OpenMessages => self.lay_over(Overlay::Messages),
            Action::OpenGlossary => self.lay_over(Overlay::Glossary),
            Action::OpenMatch => {
                let opened = self.open(PageId::Drills);
                let coach = &mut self.coach;
                return Effect::both(opened, self.drills.open_match(|| coach.take_match()));
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
            Action::Coach(CoachAction::Resume) if self.goes_on_with_open_exam() => {
                let effect = self.open(PageId::Drills);
                self.drills.show_session();
                return effect;
            }
            Action::Coach(CoachAction::Resume) => {
                let practice = self.coach.resume()?;
                self.turn_to(PageId::Drills);
                let effect = self.drills.resume(practice, self.coach.query.skill);
                // One that was open waits until all others were gone on with.
                self.coach.left_exams.splice(0..0, self.drills.left_exam.take());
                return Some(effect);
            }
            Action::Coach(action) => {
                return match self.coach.update(action) {
                    // The folder of the positions may not be known yet: it comes with the task that reads it.
                    Some(Effect::Drill(tasks)) => {
                        Some(Effect::Drill(std::iter::once(self.drills.load()).chain(tasks).collect()))
                    }
                    effect => effect,
                };
            }
            Action::Drill(action) => {
                let effect = self.drills.update(action);
                let balls = self.drills.for_coach.take();
                self.coach.left_exams.extend(self.drills.left_exam.take());
                if balls.is_some() || self.drills.is_left() {
                    self.open(PageId::Coach);
                }
                if let Some(Balls { table, layout, rule, cue_ball }) = balls {
                    self.coach.take_position(&table, layout, rule, cue_ball);
                }
                return effect;
            }
            Action::Training(action) => {
                let effect = self.training.update(action);
                if self.training.is_left() {
                    return self.leave_training();
                }
                return effect;
            }
            Action::Calibration(action) => {
                let effect = self.calibration.update(action);
                if self.calibration.is_left {
                    return self.open(PageId::Coach);
                }
                return match self.calibration.for_use.take() {
                    Some(path) => Some(self.use_table(path)),
                    None => effect,
                };
            }
            Action::Settings(action) => {
                let effect = self.settings.update(action);
                if self.settings.is_left {
                    return self.open(self.before);
                }
                self.take_changes();
                return effect;
            }
        }
        None
    }

    /// Whether what waits to be gone on with is an exam that is still open in the drills.
    pub(super) fn goes_on_with_open_exam(&self) -> bool {
        self.coach.left_exams.is_empty() && self.drills.has_open_exam()
    }

    /// The answer to the open page's question.
    const fn answer(&self, yes: bool) -> Action {
        match self.screen {
            PageId::Coach => Action::Coach(CoachAction::Answer(yes)),
            PageId::Training => Action::Training(TrainingAction::Answer(yes)),
            PageId::Drills => Action::Drill(DrillAction::Answer(yes)),
            PageId::Settings => Action::Settings(SettingsAction::Answer(yes)),
            PageId::Calibration => Action::Calibration(CalibrationAction::Answer(yes)),
        }
    }

    /// What is polled for the page that is open; reports go to [`App::receive_training`] and `CoachPage::see`.
    pub fn subscriptions(&self) -> Subscriptions {
        if let Some(followed) = self.coach.followed() {
            return Subscriptions { shown: Some(followed.folder.clone()), ..Subscriptions::default() };
        }
        if self.screen == PageId::Training { self.training.subscriptions() } else { Subscriptions::default() }
    }

    /// What others may see of the coach's table, while the player allows it.
    pub fn shown_table(&self) -> Option<ShownTable> {
        self.coach.shown_table(self.screen == PageId::Coach)
    }

    /// It cannot be shown, as the sentence says.
    pub fn not_shown(&mut self, sentence: String) {
        self.coach.hide();
        self.failed(sentence);
    }

    /// Lets `seconds` pass for whatever moves on the screen.
    pub fn tick(&mut self, seconds: f64) {
        self.toasts.tick(seconds);
        if !self.is_covered() {
            self.page_mut().tick(seconds);
        }
    }

    /// Seconds until the next picture; `None` while nothing moves by itself.
    pub fn frame_interval(&self) -> Option<f64> {
        self.page().frame_interval().filter(|_| !self.is_covered())
    }

    /// Whether something lies over the page, which then stands still: what moves is to be seen.
    pub(super) const fn is_covered(&self) -> bool {
        self.overlay.is_some() || self.command_palette.is_some()
    }

    /// The terminal has this size from now on.
    pub const fn resize(&mut self, size: Size) {
        self.area = Rect::new(0, 0, size.width, size.height);
    }

    /// Draws the screen.
    pub fn draw(&self, frame: &mut Frame) {
        view::draw(self, frame.area(), frame.buffer_mut());
    }

    /// The page that is open.
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

    /// Keys of the user's own.
    pub const fn keys(&self) -> &Keys {
        &self.settings.settings.keys
    }

    /// The colours.
    pub fn theme(&self) -> Theme {
        self.theme.with_cue_ball(self.page().cue_ball())
    }
}
