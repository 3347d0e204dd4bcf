//! What drawing reads of the state.

use std::sync::Arc;

use super::{App, Mode, Overlay, Screen};
use crate::{
    table::{CueBall, Layout, Table},
    terminal::{
        coach::CoachScreen,
        drills::DrillScreen,
        finder::Finder,
        look::Look,
        playback::Playback,
        settings::{Keys, SettingsScreen},
        shot::Shot,
        status::Message,
        theme::Theme,
        training::TrainingScreen,
    },
};

impl App {
    /// Which screen is shown.
    pub const fn screen(&self) -> Screen {
        self.screen
    }

    /// The coach's screen.
    pub const fn coach(&self) -> &CoachScreen {
        &self.coach
    }

    /// The training screen.
    pub const fn training(&self) -> &TrainingScreen {
        &self.training
    }

    /// The drill screens.
    pub const fn drills(&self) -> &DrillScreen {
        &self.drills
    }

    /// The settings' screen.
    pub const fn settings(&self) -> &SettingsScreen {
        &self.settings
    }

    /// The table that is played on.
    pub fn table(&self) -> &Table {
        self.coach.table()
    }

    /// Where the balls lie before the shot.
    pub const fn layout(&self) -> &Layout {
        self.coach.layout()
    }

    /// The shot that was found for the layout, or the best so far while the coach thinks.
    pub fn shot(&self) -> Option<&Arc<Shot>> {
        self.coach.shot()
    }

    /// What the arrow keys are for.
    pub const fn mode(&self) -> Mode {
        self.coach.mode
    }

    /// The shot that is being watched.
    pub fn watched(&self) -> Option<&Shot> {
        self.shot().filter(|_| self.mode() == Mode::Watching).map(Arc::as_ref)
    }

    /// The clock of the shot.
    pub const fn playback(&self) -> &Playback {
        &self.coach.playback
    }

    /// The ball that the arrow keys move.
    pub const fn selected(&self) -> usize {
        self.coach.selected
    }

    /// The chosen step, mm.
    pub fn step_mm(&self) -> f64 {
        self.coach.step_mm()
    }

    /// Number of the spinner's picture, while the coach thinks.
    pub fn spinner(&self) -> Option<usize> {
        self.coach.spinner()
    }

    /// What the status line says.
    pub const fn message(&self) -> Option<&Message> {
        match self.screen {
            Screen::Coach => self.coach.message.as_ref(),
            Screen::Training => self.training.message.as_ref(),
            Screen::Drills => self.drills.message.as_ref(),
            Screen::Settings => self.settings.message.as_ref(),
        }
    }

    pub(super) const fn message_mut(&mut self) -> &mut Option<Message> {
        match self.screen {
            Screen::Coach => &mut self.coach.message,
            Screen::Training => &mut self.training.message,
            Screen::Drills => &mut self.drills.message,
            Screen::Settings => &mut self.settings.message,
        }
    }

    /// The page that lies over the screen, if one does, with its first line.
    pub const fn help(&self) -> Option<(Overlay, u16)> {
        self.help
    }

    /// Drawing tells that page's first line when it is scrolled to its end.
    pub fn set_help_end(&self, line: u16) {
        self.help_end.set(line);
    }

    /// The command palette, while it is open.
    pub const fn finder(&self) -> Option<&Finder> {
        self.finder.as_ref()
    }

    /// What the terminal can show.
    pub const fn look(&self) -> Look {
        self.look
    }

    /// Keys of the user's own.
    pub const fn keys(&self) -> &Keys {
        &self.settings.settings.keys
    }

    /// The colours.
    pub fn theme(&self) -> &Theme {
        match self.cue_ball() {
            CueBall::White => &self.theme,
            CueBall::Yellow => &self.yellow_theme,
        }
    }

    /// The ball that the player plays with on the screen that is shown.
    pub fn cue_ball(&self) -> CueBall {
        match self.screen {
            Screen::Coach => self.coach.cue_ball(),
            Screen::Drills => self.drills.turn.as_ref().map_or(CueBall::White, |turn| turn.cue_ball),
            Screen::Training | Screen::Settings => CueBall::White,
        }
    }
}
