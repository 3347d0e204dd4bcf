//! The jump from the side: when it is shown, and what is said where there is none.

use crate::{
    coach::words::no_jump_words,
    terminal::{pages::coach::CoachPage, shot::Profile, ui::Message},
};

/// From where the shot is looked at.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Seen {
    /// From above alone.
    #[default]
    FromAbove,
    /// From the side as well, where it jumps.
    FromTheSide,
}

impl CoachPage {
    /// The jump of the shot, while it is to be shown from the side; a shot without one has none.
    pub fn profile(&self) -> Option<&Profile> {
        self.shot().filter(|_| self.seen == Seen::FromTheSide)?.profile(self.table())
    }

    /// Shows the jump from the side, or no longer; where nothing jumps that high it says so.
    pub(super) fn turn_side_view(&mut self) {
        self.seen = match self.seen {
            Seen::FromAbove => Seen::FromTheSide,
            Seen::FromTheSide => Seen::FromAbove,
        };
        if self.seen == Seen::FromTheSide && self.profile().is_none() {
            self.seen = Seen::FromAbove;
            self.message = Some(Message::plain(self.no_jump()));
        }
    }

    fn no_jump(&self) -> String {
        let recording = self.shot().map(|shot| &shot.recording);
        no_jump_words(self.table(), recording, self.units.length)
    }
}
