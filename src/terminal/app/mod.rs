//! The state of the program; it draws on any frame and needs no terminal.
//!
//! What its screens share is here; each screen has a state of its own. [`view`] is what drawing reads.

mod finding;
mod keys;
mod mouse;
mod news;
mod settings;
mod tabs;
mod view;

use std::{
    cell::Cell,
    path::{Path, PathBuf},
};

use ratatui::{Frame, layout::Rect};

use super::{
    coach::CoachScreen,
    drills::{Balls, DrillScreen, Errand},
    finder::Finder,
    keymap::{Action, CoachAction},
    last::Last,
    look::{Glyphs, Look},
    recommender::Job,
    screens,
    settings::{Complaint, Settings, SettingsErrand, SettingsScreen},
    theme::{Palette, Theme},
    toasts::Toasts,
    training::{Keeping, Launch, TrainingScreen, Wanted},
};
use crate::{
    coach::Skill,
    learning::run::request::Request,
    storage::Places,
    table::{CueBall, Layout, LayoutError, Table},
};

/// What the arrow keys are for on the coach's screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// They move balls.
    Placing,
    /// They step through a shot.
    Watching,
}

/// What the program around the app has to do.
#[derive(Clone, Debug)]
pub enum Effect {
    /// Ask the coach and hand the answer to [`App::receive`].
    Recommend(Box<Job>),
    /// Ask it for a closer look at the shot that is shown, in the same way.
    Study(Box<Job>),
    /// Start a process that trains; how it ends goes to [`App::receive_report`], as do the answers to what follows.
    Train(Box<Launch>),
    /// Ask a run for something.
    Send(Request, PathBuf),
    /// Keep a policy under a name.
    Keep(Box<Keeping>),
    /// Read the policy of the run in this folder.
    LoadPolicy(PathBuf),
    /// Do these, one after the other; what comes of them goes to [`App::receive_drill`].
    Drill(Vec<Errand>),
    /// Read or change the settings' file; what comes of it goes to [`App::receive_settings`].
    Settings(Box<SettingsErrand>),
    /// Put a text into the terminal's clipboard, where it allows that.
    Copy(String),
    /// Stop until the shell continues the program.
    Suspend,
    /// End.
    Quit,
}

/// The screens.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Screen {
    /// The table, and what the coach recommends.
    Coach,
    /// Exercises, and the player at them.
    Drills,
    /// Runs, and how they learn.
    Training,
    /// What is set once and for all.
    Settings,
}

impl Screen {
    /// All of them, in the order of their tabs.
    pub const ALL: [Self; 4] = [Self::Coach, Self::Drills, Self::Training, Self::Settings];

    /// What stands on its tab.
    pub const fn title(self) -> &'static str {
        match self {
            Self::Coach => "Coach",
            Self::Drills => "Drills",
            Self::Training => "Training",
            Self::Settings => "Settings",
        }
    }
}

/// A page that lies over the screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Overlay {
    /// Every key.
    Help,
    /// What was refused or has failed so far.
    Messages,
}

/// The whole state of the terminal program.
#[derive(Debug)]
pub struct App {
    screen: Screen,
    coach: CoachScreen,
    training: TrainingScreen,
    drills: DrillScreen,
    settings: SettingsScreen,
    /// The settings that hold.
    in_force: Settings,
    /// The screen before the settings.
    before: Screen,
    /// The page that lies over the screen, and its first line.
    help: Option<(Overlay, u16)>,
    /// The first line of that page when it is scrolled to its end. Only drawing knows: it depends on the terminal's size.
    help_end: Cell<u16>,
    /// The command palette while it is open.
    finder: Option<Finder>,
    toasts: Toasts,
    /// Where the screen was drawn, to find what the mouse points at.
    area: Cell<Rect>,
    /// Whether the mouse is wanted.
    mouse: bool,
    look: Look,
    /// The look with any palette that has colours.
    full_look: Look,
    /// The finest characters to draw with: octants only where they were asked for.
    finest: Glyphs,
    theme: Theme,
    /// The same where yellow is the cue ball.
    yellow_theme: Theme,
    palette: Palette,
    /// Finds out what the terminal can show under some settings; without it that stays as at the start.
    detect: Option<fn(&Settings) -> Look>,
}

impl App {
    /// The program at its start; `seed` decides about random layouts.
    ///
    /// # Errors
    /// A layout that is not possible on the table.
    pub fn new(table: Table, layout: Layout, look: Look, seed: u64) -> Result<Self, LayoutError> {
        Ok(Self {
            screen: Screen::Coach,
            coach: CoachScreen::new(table, layout, seed)?,
            training: TrainingScreen::new(Places::of_this_user()),
            drills: DrillScreen::new(Places::of_this_user(), seed),
            settings: SettingsScreen::new(Settings::path()),
            in_force: Settings::default(),
            before: Screen::Coach,
            help: None,
            help_end: Cell::new(u16::MAX),
            finder: None,
            toasts: Toasts::default(),
            area: Cell::default(),
            mouse: true,
            look,
            full_look: look,
            finest: look.finest(),
            theme: Theme::new(look.depth),
            yellow_theme: Theme::new(look.depth).with_cue_ball(CueBall::Yellow),
            palette: Palette::default(),
            detect: None,
        })
    }

    /// The program that opens with the training screen: with a run, or with the list of those in `list`, by default the
    /// user's. Going back from its first page ends the program.
    ///
    /// # Errors
    /// None with the default table, whose opening position is possible.
    pub fn watching(look: Look, run: Option<PathBuf>, list: Option<PathBuf>) -> Result<Self, LayoutError> {
        let table = Table::default();
        let layout = Layout::opening(&table);
        let mut app = Self::new(table, layout, look, 0)?;
        app.screen = Screen::Training;
        app.training.open_alone(run, list);
        Ok(app)
    }

    /// The same program with its runs and policies elsewhere.
    #[must_use]
    pub fn with_places(mut self, places: Places) -> Self {
        self.training.folder.clone_from(&places.runs);
        self.drills.places = places.clone();
        self.training.places = places;
        self
    }

    /// The same program as the user wants it.
    #[must_use]
    pub fn with_settings(mut self, settings: &Settings) -> Self {
        self.coach.take_settings(settings);
        self.settings.settings = settings.clone();
        self.in_force = settings.clone();
        self.mouse = settings.mouse;
        self.choose_palette(settings.palette);
        self
    }

    /// The same program with its settings in another file.
    #[must_use]
    pub fn with_settings_file(mut self, path: PathBuf) -> Self {
        self.settings.path = path;
        self
    }

    /// The same program, which asks `detect` what the terminal can show whenever that is set otherwise.
    #[must_use]
    pub fn with_detection(mut self, detect: fn(&Settings) -> Look) -> Self {
        self.detect = Some(detect);
        self
    }

    /// The same program with the way back to where the last session ended.
    #[must_use]
    pub fn with_last(mut self, last: Option<Last>) -> Self {
        self.coach.offer(last);
        self
    }

    /// The same program for a player whose own skill is known.
    #[must_use]
    pub const fn with_own_skill(mut self, own: Option<Skill>) -> Self {
        self.coach.own = own;
        self
    }

    /// What the next session may go on from; `None` where nothing has been done that is worth it.
    pub fn last(&self) -> Option<Last> {
        let practice = if self.screen == Screen::Drills { self.drills.unfinished() } else { None };
        self.coach.last(practice.cloned())
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
            Action::CloseHelp => self.help = None,
            Action::ScrollHelp(lines) => {
                let end = self.help_end.get();
                self.help = self.help.map(|(page, top)| (page, top.min(end).saturating_add_signed(lines).min(end)));
            }
            Action::NextGlyphs => self.next_glyphs(),
            Action::NextPalette => self.next_palette(),
            Action::Open(screen) => return self.open(screen),
            Action::SavePosition => {
                self.coach.playback.pause();
                self.screen = Screen::Drills;
                let shot = self.coach.shot().filter(|shot| shot.solved).map(|shot| shot.cue);
                let (table, layout) = (self.coach.table().clone(), *self.coach.layout());
                let balls = Balls { table, layout, rule: self.coach.tutor.rule };
                return Some(self.drills.open_to_save(balls, self.coach.tutor.skill, shot));
            }
            Action::Finder(action) => return self.find(action),
            Action::Coach(CoachAction::Resume) => {
                let practice = self.coach.resume()?;
                self.screen = Screen::Drills;
                return Some(self.drills.resume(practice, self.coach.tutor.skill));
            }
            Action::Coach(action) => return self.coach.update(action),
            Action::Drill(action) => {
                let effect = self.drills.update(action);
                let balls = self.drills.take_for_coach();
                if balls.is_some() || self.drills.is_left() {
                    self.open(Screen::Coach);
                }
                if let Some(Balls { table, layout, rule }) = balls {
                    self.coach.take_position(&table, layout, rule);
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
            Action::Settings(action) => {
                let effect = self.settings.update(action);
                if self.settings.is_left() {
                    return self.open(self.before);
                }
                return self.set(effect);
            }
        }
        None
    }

    /// What the program around has to find out as long as it is wanted; it goes to [`App::receive_report`].
    pub fn wanted(&self) -> Wanted {
        if self.screen == Screen::Training { self.training.wanted() } else { Wanted::default() }
    }

    /// Lets `seconds` pass for whatever moves on the screen.
    pub fn tick(&mut self, seconds: f64) {
        self.toasts.tick(seconds);
        match self.screen {
            Screen::Coach => self.coach.tick(seconds),
            Screen::Training => self.training.tick(seconds),
            Screen::Drills => self.drills.tick(seconds),
            Screen::Settings => {}
        }
    }

    /// Seconds until the next picture; `None` while nothing moves by itself.
    pub fn frame_interval(&self) -> Option<f64> {
        match self.screen {
            Screen::Coach => self.coach.frame_interval(),
            Screen::Training => self.training.frame_interval(),
            Screen::Drills => self.drills.frame_interval(),
            Screen::Settings => None,
        }
    }

    /// Draws the screen.
    pub fn draw(&self, frame: &mut Frame) {
        self.area.set(frame.area());
        screens::draw(self, frame.area(), frame.buffer_mut());
    }
}
