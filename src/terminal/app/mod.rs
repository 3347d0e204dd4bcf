//! The state of the program; it draws on any frame and needs no terminal.
//!
//! What its screens share is here; each screen has a state of its own. [`view`] is what drawing reads.

mod finding;
mod mouse;
mod view;

use std::{
    cell::Cell,
    path::{Path, PathBuf},
};

use crossterm::event::{KeyEvent, KeyEventKind};
use ratatui::{Frame, layout::Rect};

use super::{
    coach::CoachScreen,
    drills::{Balls, DrillReport, DrillScreen, Errand},
    finder::Finder,
    keymap::{self, Action, Place, When},
    last::Last,
    look::{Depth, Glyphs, Look},
    recommender::{Answer, Job},
    screens,
    settings::{Complaint, Keys, Settings},
    status::Message,
    theme::{Palette, Theme},
    training::{Keeping, Launch, Report, TrainingScreen, Wanted},
};
use crate::{
    coach::Skill,
    learning::run::request::Request,
    storage::Places,
    table::{Layout, LayoutError, Table},
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
    /// Runs, and how they learn.
    Training,
    /// Exercises, and the player at them.
    Drills,
}

/// The whole state of the terminal program.
#[derive(Debug)]
pub struct App {
    screen: Screen,
    coach: CoachScreen,
    training: TrainingScreen,
    drills: DrillScreen,
    help: Option<u16>,
    /// The first line of the help when it is scrolled to its end. Only drawing knows: it depends on the terminal's size.
    help_end: Cell<u16>,
    /// The command palette while it is open.
    finder: Option<Finder>,
    /// Where the screen was drawn, to find what the mouse points at.
    area: Cell<Rect>,
    /// Whether the mouse is wanted.
    mouse: bool,
    look: Look,
    /// The look with any palette that has colours.
    full_look: Look,
    theme: Theme,
    palette: Palette,
    /// Keys of the user's own.
    keys: Keys,
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
            help: None,
            help_end: Cell::new(u16::MAX),
            finder: None,
            area: Cell::default(),
            mouse: true,
            look,
            full_look: look,
            theme: Theme::new(look.depth),
            palette: Palette::default(),
            keys: Keys::default(),
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
        self.keys = settings.keys.clone();
        self.mouse = settings.mouse;
        self.choose_palette(settings.palette);
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
        self.coach.last()
    }

    /// Says that something is wrong with the settings.
    #[must_use]
    pub fn with_complaints(mut self, file: &Path, complaints: &[Complaint]) -> Self {
        if let Some(first) = complaints.first() {
            let more = if complaints.len() > 1 { "; carom config --check says more" } else { "" };
            *self.message_mut() = Some(Message::warning(format!("{}: {first}{more}", file.display())));
        }
        self
    }

    fn choose_palette(&mut self, palette: Palette) {
        self.palette = palette;
        let mono = Look { depth: Depth::Mono, glyphs: Glyphs::Letters, ..self.full_look };
        self.look = if palette == Palette::Mono { mono } else { self.full_look };
        self.theme = Theme::of(palette, self.look.depth);
    }

    /// A key was pressed.
    pub fn handle(&mut self, key: &KeyEvent) -> Option<Effect> {
        if key.kind == KeyEventKind::Release {
            return None;
        }
        if let Some(finder) = &mut self.finder {
            if finder.take_key(key) {
                *self.message_mut() = None;
                return None;
            }
        } else if self.help.is_none() {
            let typed = match self.screen {
                Screen::Coach => false,
                Screen::Training => self.training.typed(key),
                Screen::Drills => self.drills.typed(key),
            };
            if typed {
                return None;
            }
        }
        let found = keymap::find(&self.keys.translate(key), self.place(), |when| self.refusal(when))?;
        *self.message_mut() = None;
        match found {
            Ok(action) => self.update(action),
            Err(reason) => {
                *self.message_mut() = Some(Message::warning(reason));
                None
            }
        }
    }

    /// Does what an enabled binding asks for.
    pub fn update(&mut self, action: Action) -> Option<Effect> {
        match action {
            Action::Quit => return Some(Effect::Quit),
            Action::Suspend => return Some(Effect::Suspend),
            Action::OpenHelp => {
                self.help = Some(0);
                self.help_end.set(u16::MAX);
            }
            Action::CloseHelp => self.help = None,
            Action::ScrollHelp(lines) => {
                let end = self.help_end.get();
                self.help = self.help.map(|top| top.min(end).saturating_add_signed(lines).min(end));
            }
            Action::NextGlyphs => {
                self.look = self.look.with_next_glyphs();
                if self.palette != Palette::Mono {
                    self.full_look = self.look;
                }
            }
            Action::NextPalette => {
                self.choose_palette(self.palette.next());
                *self.message_mut() = Some(Message::plain(format!("theme: {}", self.palette)));
            }
            Action::OpenTraining => {
                // What nobody watches does not play on.
                self.coach.playback.pause();
                self.training.open();
                self.screen = Screen::Training;
            }
            Action::OpenDrills => {
                self.coach.playback.pause();
                self.screen = Screen::Drills;
                return Some(self.drills.open(self.coach.tutor.skill));
            }
            Action::SavePosition => {
                self.coach.playback.pause();
                self.screen = Screen::Drills;
                let shot = self.coach.shot().filter(|shot| shot.solved).map(|shot| shot.cue);
                let (table, layout) = (self.coach.table.clone(), *self.coach.layout());
                let balls = Balls { table, layout, rule: self.coach.tutor.rule };
                return Some(self.drills.open_to_save(balls, self.coach.tutor.skill, shot));
            }
            Action::Finder(action) => return self.find(action),
            Action::Coach(action) => return self.coach.update(action),
            Action::Drill(action) => {
                let effect = self.drills.update(action);
                let balls = self.drills.take_for_coach();
                if balls.is_some() || self.drills.is_left() {
                    self.screen = Screen::Coach;
                    // Whoever was chosen there plays here too.
                    self.coach.take_skill(self.drills.player.at_coach);
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
        }
        None
    }

    /// Back to the coach, or to the shell where the program began with the training screen.
    fn leave_training(&mut self) -> Option<Effect> {
        if self.training.alone {
            return Some(Effect::Quit);
        }
        self.screen = Screen::Coach;
        None
    }

    /// Why a binding may not be used now; `None` where it may.
    pub fn refusal(&self, when: When) -> Option<&'static str> {
        match when {
            When::Help => self.help.is_none().then_some("the help is not open"),
            _ if self.help.is_some() => Some("close the help first: Esc"),
            When::Always => None,
            When::Coach(when) => self.coach.refusal(when),
            When::Training(when) => self.training.refusal(when),
            When::Drill(when) => self.drills.refusal(when),
        }
    }

    /// What is on the screen. The help is that of what lies below it.
    pub fn place(&self) -> Place {
        if self.finder.is_some() { Place::Finder } else { self.place_below() }
    }

    /// The same without the command palette.
    pub(super) fn place_below(&self) -> Place {
        match self.screen {
            Screen::Coach => Place::Coach,
            Screen::Training if self.help.is_some() => self.training.page().place(),
            Screen::Training => self.training.place(),
            Screen::Drills if self.help.is_some() => Place::Drill(self.drills.page_place()),
            Screen::Drills => Place::Drill(self.drills.place()),
        }
    }

    /// The coach has something to say. Late answers to cancelled questions are dropped.
    pub fn receive(&mut self, answer: Answer) -> Option<Effect> {
        self.coach.receive(answer)
    }

    /// The thread that thinks is gone, and with it the answer.
    pub fn coach_lost(&mut self) {
        self.coach.lost();
    }

    /// Something has come of what the training screen wanted.
    pub fn receive_report(&mut self, report: Report) {
        if let Some((table, tutor)) = self.training.receive(report) {
            self.coach.take_tutor(&table, tutor);
            self.training.alone = false;
            self.screen = Screen::Coach;
            self.help = None;
            self.finder = None;
        }
    }

    /// Something has come of an errand of the drill screens; gives what is to be done next.
    pub fn receive_drill(&mut self, report: DrillReport) -> Vec<Errand> {
        let errands = self.drills.receive(report);
        self.coach.own = self.drills.player.own.or(self.coach.own);
        errands
    }

    /// Text was pasted.
    pub fn paste(&mut self, text: &str) {
        if let Some(finder) = &mut self.finder {
            finder.take_text(text);
        } else if self.screen == Screen::Drills && self.help.is_none() {
            self.drills.pasted(text);
        }
    }

    /// What the program around has to find out as long as it is wanted; it goes to [`App::receive_report`].
    pub fn wanted(&self) -> Wanted {
        if self.screen == Screen::Training { self.training.wanted() } else { Wanted::default() }
    }

    /// Lets `seconds` pass for whatever moves on the screen.
    pub fn tick(&mut self, seconds: f64) {
        match self.screen {
            Screen::Coach => self.coach.tick(seconds),
            Screen::Training => self.training.tick(seconds),
            Screen::Drills => self.drills.tick(seconds),
        }
    }

    /// Seconds until the next picture; `None` while nothing moves by itself.
    pub fn frame_interval(&self) -> Option<f64> {
        match self.screen {
            Screen::Coach => self.coach.frame_interval(),
            Screen::Training => self.training.frame_interval(),
            Screen::Drills => self.drills.frame_interval(),
        }
    }

    /// Draws the screen.
    pub fn draw(&self, frame: &mut Frame) {
        self.area.set(frame.area());
        screens::draw(self, frame.area(), frame.buffer_mut());
    }
}
