//! The jump from the side: when it is shown, and what is said where there is none.

use crate::{
    coach::words::no_jump_words,
    terminal::{pages::coach::CoachPage, shot::Profile, ui::Message},
};

impl CoachPage {
    /// The jump of the shot, while it is to be shown from the side; a shot without one has none.
    pub fn profile(&self) -> Option<&Profile> {
        self.shot().filter(|_| self.is_from_side)?.profile(self.table())
    }

    /// Shows the jump from the side, or no longer; where nothing jumps that high it says so.
    pub(super) fn turn_side_view(&mut self) {
        self.is_from_side = !self.is_from_side;
        if self.is_from_side && self.profile().is_none() {
            self.is_from_side = false;
            let recording = self.shot().map(|shot| &shot.recording);
            self.message = Some(Message::plain(no_jump_words(self.table(), recording, self.units.length)));
        }
    }
}
