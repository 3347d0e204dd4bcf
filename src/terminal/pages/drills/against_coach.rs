//! A match against the coach, begun from whatever page.

use crate::{
    drills::{Goal, Session},
    terminal::{
        Effect,
        pages::{
            Page,
            drills::{DrillsPage, keys::DrillContext, turn_actions::FIRST_GAME},
        },
    },
};

/// The exercise with whose balls it begins.
const OPENING: &str = "opening-break";

impl DrillsPage {
    /// Begins a match against the coach at three-cushion, from the opening; one that is open, or was left last, goes on.
    pub fn open_match(&mut self) -> Option<Effect> {
        let is_match = |session: &Session| matches!(session.goal, Goal::Match { against_coach: true, .. });
        match self.turn.as_ref().and(self.unfinished()) {
            Some(open) if is_match(open) => {
                self.pages = vec![DrillContext::Library, DrillContext::Exercise];
                return None;
            }
            Some(open) if open.is_exam() => return self.refuse("an exam is under way; leave it before a match"),
            _ => {}
        }
        self.question = None;
        self.leave_turn();
        // What is practised next is chosen elsewhere.
        let options = self.options;
        self.options.shifted = false;
        let effect = if let Some(place) = self.left.iter().rposition(is_match) {
            let left = self.left.remove(place);
            Some(Effect::Drill(self.practise(left)))
        } else {
            match self.catalogue.library.get(OPENING).cloned() {
                Ok(opening) => {
                    Some(self.begin(Goal::Match { innings: FIRST_GAME, against_coach: true }, vec![opening]))
                }
                Err(error) => self.refuse(error),
            }
        };
        self.options = options;
        effect
    }
}
