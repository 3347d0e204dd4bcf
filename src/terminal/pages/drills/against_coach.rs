//! The match against the coach, which can be started from any page.

use crate::{
    drills::{Goal, Session},
    terminal::{
        Effect,
        pages::{
            Page,
            drills::{DrillsPage, goals::DEFAULT_INNINGS},
        },
    },
};

/// The exercise whose layout the match starts from.
const OPENING: &str = "opening-break";

impl DrillsPage {
    /// Opens a match against the coach. An open match or the last unfinished one is resumed, else the one that `earlier` returns from
    /// an earlier session of the program. If there is none, a three-cushion match starts from the opening.
    pub fn open_match(&mut self, earlier: impl FnOnce() -> Option<Session>) -> Option<Effect> {
        match self.turn.as_ref().and(self.unfinished()) {
            Some(open) if open.is_against_coach() => {
                self.show_session();
                return None;
            }
            Some(open) if open.is_exam() => return self.refuse("an exam is under way; leave it before a match"),
            _ => {}
        }
        self.question = None;
        self.close_exercise();
        // The match must not change the options of the exercises.
        let options = self.options.clone();
        self.options.shifted = false;
        let left = self
            .unfinished_sessions
            .iter()
            .rposition(Session::is_against_coach)
            .map(|place| self.unfinished_sessions.remove(place));
        let effect = if let Some(left) = left {
            Some(Effect::Drill(self.practise(left)))
        } else if let Some(left) = earlier() {
            Some(self.resume(left, self.player.coach_page_skill))
        } else {
            match self.catalogue.library.get(OPENING).cloned() {
                Ok(opening) => {
                    Some(self.begin(Goal::Match { innings: DEFAULT_INNINGS, against_coach: true }, vec![opening]))
                }
                Err(error) => self.refuse(error),
            }
        };
        self.options = options;
        effect
    }
}
