//! The match against the coach, which can be started from any page.

use crate::{
    drills::Session,
    terminal::{
        DrillAction, DrillContext, Effect,
        pages::{
            Page,
            drills::{DrillsPage, Question},
        },
    },
};

/// The exercise whose layout the match starts from.
const OPENING: &str = "opening-break";

impl DrillsPage {
    /// Opens a match against the coach. An open match or the last unfinished one is resumed, else the one that `earlier` returns from
    /// an earlier session of the program. If there is none, the user chooses the distance and the coach's level of another.
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
        let left = self.unfinished_sessions.iter().rposition(Session::is_against_coach);
        let left = left.map(|place| self.unfinished_sessions.remove(place));
        if let Some(left) = left {
            self.close_exercise();
            return Some(self.keeping_options(|page| Effect::Drill(page.practise(left))));
        }
        if let Some(left) = earlier() {
            self.close_exercise();
            return Some(self.keeping_options(|page| page.resume(left, page.player.coach_page_skill)));
        }
        self.set_up_match();
        None
    }

    /// Opens the page on which the user chooses the distance of a match and the coach's level.
    pub(super) fn set_up_match(&mut self) {
        if self.page() != DrillContext::Match {
            self.pages.push(DrillContext::Match);
        }
    }

    /// Begins the match that was chosen. Asks first if another match against the coach is unfinished.
    pub(super) fn ask_to_begin_match(&mut self) -> Option<Effect> {
        let open = self.turn.as_ref().filter(|turn| turn.is_in_progress()).map(|turn| &turn.session);
        let open = open.into_iter().chain(&self.unfinished_sessions).find(|session| session.is_against_coach());
        let Some(open) = open else { return self.begin_match() };
        let own = open.attempts.iter().filter(|attempt| !attempt.by_coach).count();
        self.question = Some(Question::GiveUp(DrillAction::BeginMatch, open.goal.name(), own));
        None
    }

    /// Begins the match that was chosen, in place of any other match against the coach.
    pub(super) fn begin_match(&mut self) -> Option<Effect> {
        let opening = match self.catalogue.library.get(OPENING) {
            Ok(opening) => self.match_setup.exercise(opening.clone()),
            Err(error) => return self.refuse(error),
        };
        self.close_exercise();
        self.unfinished_sessions.retain(|left| !left.is_against_coach());
        Some(self.keeping_options(|page| {
            page.options.shifted = false;
            let mut session = page.new_session(page.match_setup.goal(), vec![opening]);
            session.coach_skill = page.match_setup.level;
            Effect::Drill(page.practise(session))
        }))
    }

    /// Opens a session by `open`, which does not change the options of the exercises.
    pub(super) fn keeping_options(&mut self, open: impl FnOnce(&mut Self) -> Effect) -> Effect {
        let options = self.options.clone();
        let effect = open(self);
        self.options = options;
        effect
    }
}
