//! A match against the coach, begun from whatever page.

use crate::{
    drills::{Goal, Session},
    terminal::{
        Effect,
        pages::{Page, drills::DrillsPage},
    },
};

/// The exercise with whose balls it begins.
const OPENING: &str = "opening-break";
/// Innings of each side.
const INNINGS: u32 = 10;

impl DrillsPage {
    /// Begins a match against the coach at three-cushion, from the opening; one that is open, or was left last, goes on.
    pub fn open_match(&mut self) -> Option<Effect> {
        let is_match = |session: &Session| matches!(session.goal, Goal::Match { against_coach: true, .. });
        match self.turn.as_ref().and(self.unfinished()) {
            Some(open) if is_match(open) => return None,
            Some(open) if open.is_exam() => return self.refuse("an exam is under way; leave it before a match"),
            _ => {}
        }
        self.question = None;
        self.leave_turn();
        if let Some(place) = self.left.iter().rposition(is_match) {
            let left = self.left.remove(place);
            return Some(Effect::Drill(self.practise(left)));
        }
        match self.catalogue.library.get(OPENING).cloned() {
            Ok(opening) => Some(self.begin(Goal::Match { innings: INNINGS, against_coach: true }, vec![opening])),
            Err(error) => self.refuse(error),
        }
    }
}
