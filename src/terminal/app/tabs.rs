//! Switching between the screens.

use crate::terminal::{App, Effect, Overlay, PageId};

impl App {
    /// Opens an overlay in place of any other; closes it if it is already open.
    pub(super) fn open_overlay(&mut self, page: Overlay) {
        if self.overlay.is_some_and(|(open, _)| open == page) {
            return self.close_overlay();
        }
        self.command_palette = None;
        self.overlay = Some((page, 0));
        if page == Overlay::Messages {
            // The page lists all toasts, and a toast would cover it.
            self.toasts.clear();
        }
    }

    pub(super) fn close_overlay(&mut self) {
        if self.overlay.take() == Some((Overlay::Messages, 0)) {
            // Messages that arrived meanwhile were visible in the first line.
            self.toasts.clear();
        }
    }

    /// Switches to `screen` and closes any overlay. Returns the previous screen, or `None` if `screen` was open already.
    pub(super) fn switch_to(&mut self, screen: PageId) -> Option<PageId> {
        (self.overlay, self.command_palette) = (None, None);
        self.coach.end_drag();
        if self.screen == screen {
            return None;
        }
        // A shot that is not visible is paused.
        self.coach.playback.pause();
        Some(std::mem::replace(&mut self.screen, screen))
    }

    /// Opens a screen in the state in which it was left. Searches and training continue in the background meanwhile.
    pub(super) fn open(&mut self, screen: PageId) -> Option<Effect> {
        let before = self.switch_to(screen)?;
        if before == PageId::Drills {
            // The player chosen on the drill screens also becomes the player at the coach's table.
            self.coach.set_skill(self.drills.player.coach_page_skill);
        }
        match screen {
            PageId::Coach => None,
            PageId::Drills => Some(self.drills.open(self.coach.query.skill, self.coach.query.rule, self.coach.table())),
            PageId::Training => {
                self.training.open();
                None
            }
            PageId::Calibration => Some(self.calibration.open(self.coach.table())),
            PageId::Settings => {
                self.before = before;
                self.show_session();
                Some(self.settings.open())
            }
        }
    }

    /// Whether there is no other screen to open.
    pub const fn is_only_screen(&self) -> bool {
        self.training.is_only_page || self.coach.followed().is_some()
    }
}
