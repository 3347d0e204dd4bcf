//! What the screens read of the state.

use std::sync::Arc;

use super::{App, Mode, SPINNER_INTERVAL, STEPS};
use crate::{
    table::{Layout, Table},
    terminal::{look::Look, playback::Playback, shot::Shot, status::Message, theme::Theme},
};

impl App {
    /// The table that is played on.
    pub const fn table(&self) -> &Table {
        &self.table
    }

    /// Where the balls lie before the shot.
    pub const fn layout(&self) -> &Layout {
        &self.balls.present().layout
    }

    /// The shot that was found for the layout.
    pub const fn shot(&self) -> Option<&Arc<Shot>> {
        self.balls.present().shot.as_ref()
    }

    /// What the arrow keys are for.
    pub const fn mode(&self) -> Mode {
        self.mode
    }

    /// The shot that is being watched.
    pub fn watched(&self) -> Option<&Shot> {
        self.shot().filter(|_| self.mode == Mode::Watching).map(Arc::as_ref)
    }

    /// The clock of the shot.
    pub const fn playback(&self) -> &Playback {
        &self.playback
    }

    /// The ball that the arrow keys move.
    pub const fn selected(&self) -> usize {
        self.selected
    }

    /// The chosen step, mm.
    pub fn step_mm(&self) -> f64 {
        STEPS[self.step]
    }

    /// Number of the spinner's picture, while the coach thinks.
    pub fn spinner(&self) -> Option<usize> {
        self.pending.as_ref().map(|pending| (pending.waited / SPINNER_INTERVAL) as usize)
    }

    /// What the status line says.
    pub const fn message(&self) -> Option<&Message> {
        self.message.as_ref()
    }

    /// The first line of the help, while it is open.
    pub const fn help(&self) -> Option<u16> {
        self.help
    }

    /// What the terminal can show.
    pub const fn look(&self) -> Look {
        self.look
    }

    /// The colours.
    pub const fn theme(&self) -> &Theme {
        &self.theme
    }
}
