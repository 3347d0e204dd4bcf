//! What drawing reads of the state.

use std::sync::Arc;

use crate::{
    table::{CueBall, Layout, Table},
    terminal::{
        App, Capabilities, CommandPalette, Keys, Mode, Overlay, PageId, SettingsPage, Shot,
        pages::{Page, calibration::CalibrationPage, coach::CoachPage, drills::DrillsPage, training::TrainingPage},
        shot::Playback,
        ui::{Message, Theme},
    },
};

impl App {
    /// Which screen is shown.
    pub const fn screen(&self) -> PageId {
        self.screen
    }

    /// The coach's screen.
    pub const fn coach(&self) -> &CoachPage {
        &self.coach
    }

    /// The training screen.
    pub const fn training(&self) -> &TrainingPage {
        &self.training
    }

    /// The drill screens.
    pub const fn drills(&self) -> &DrillsPage {
        &self.drills
    }

    /// The settings' screen.
    pub const fn settings(&self) -> &SettingsPage {
        &self.settings
    }

    /// The calibration's page.
    pub const fn calibration(&self) -> &CalibrationPage {
        &self.calibration
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
        self.coach.watched()
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

    /// What the status line says.
    pub fn message(&self) -> Option<&Message> {
        self.page().message()
    }

    /// The page that lies over the screen, if one does, with its first line.
    pub const fn help(&self) -> Option<(Overlay, u16)> {
        self.help
    }

    /// The command palette, while it is open.
    pub const fn command_palette(&self) -> Option<&CommandPalette> {
        self.command_palette.as_ref()
    }

    /// What the terminal can show.
    pub const fn caps(&self) -> Capabilities {
        self.caps
    }

    /// Keys of the user's own.
    pub const fn keys(&self) -> &Keys {
        &self.settings.settings.keys
    }

    /// The colours.
    pub fn theme(&self) -> &Theme {
        match self.page().cue_ball() {
            CueBall::White => &self.theme,
            CueBall::Yellow => &self.yellow_theme,
        }
    }
}
