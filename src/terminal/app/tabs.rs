//! Going from screen to screen.

use crate::terminal::{App, Effect, Overlay, PageId};

impl App {
    /// Opens the page over the screen, in place of another one; the same once more closes it.
    pub(super) fn lay_over(&mut self, page: Overlay) {
        if self.overlay.is_some_and(|(open, _)| open == page) {
            return self.close_overlay();
        }
        self.command_palette = None;
        self.overlay = Some((page, 0));
        if page == Overlay::Messages {
            // All of them are there, and a toast would lie on them.
            self.toasts.clear();
        }
    }

    pub(super) fn close_overlay(&mut self) {
        if self.overlay.take() == Some((Overlay::Messages, 0)) {
            // What has come meanwhile was the first line there.
            self.toasts.clear();
        }
    }

    /// Turns to a screen, whatever lay over the one before; gives that one, if it is another.
    pub(super) fn turn_to(&mut self, screen: PageId) -> Option<PageId> {
        (self.overlay, self.command_palette) = (None, None);
        self.coach.drop_ball();
        if self.screen == screen {
            return None;
        }
        // A shot that is not on the screen is paused.
        self.coach.playback.pause();
        Some(std::mem::replace(&mut self.screen, screen))
    }

    /// Opens a screen where it was left. What is thought about or trained meanwhile goes on, and is there when one comes back.
    pub(super) fn open(&mut self, screen: PageId) -> Option<Effect> {
        let before = self.turn_to(screen)?;
        if before == PageId::Drills {
            // The player who was chosen there also plays at the coach's table.
            self.coach.take_skill(self.drills.player.at_coach);
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

    /// Back to the coach, or to the shell where the program began with the training screen.
    pub(super) fn leave_training(&mut self) -> Option<Effect> {
        if self.training.alone {
            return Some(Effect::Quit);
        }
        self.open(PageId::Coach)
    }

    /// Whether there is no other screen to go to.
    pub const fn stands_alone(&self) -> bool {
        self.training.alone || self.coach.followed().is_some()
    }
}
