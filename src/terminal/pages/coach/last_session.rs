//! What the next session of the program can continue from, and what `c` continues of earlier ones.

use crate::{
    drills::Session,
    terminal::{CoachQuery, SavedSession, pages::coach::CoachPage, ui::Message},
};

impl CoachPage {
    /// Restores the query terms of the last session, except those that the settings have changed since then. Offers to resume that
    /// session and earlier ones that have not been resumed, if they differ from the current state.
    pub fn restore_last_session(&mut self, last: Option<SavedSession>) {
        if let Some((last, set)) = last.as_ref().and_then(|last| Some((last, last.settings?))) {
            self.query = self.query.with(self.settings_terms.with_change([set, last.terms()]));
        }
        self.start_terms = self.query.terms();
        let is_elsewhere = |last: &SavedSession| {
            last.layout != *self.layout() || last.table != *self.table() || last.practice.is_some()
        };
        let mut before = last.map_or_else(Vec::new, SavedSession::into_sessions);
        before.retain(is_elsewhere);
        self.earlier_sessions = before;
        let words = match self.earlier_sessions.first() {
            None => return,
            Some(SavedSession { practice: Some(practice), .. }) if practice.is_exam() || practice.is_game() => {
                format!("c goes on with the {} of the last session", practice.goal.name())
            }
            Some(_) => "c goes on from where the last session ended".to_owned(),
        };
        self.message = Some(Message::plain(words));
    }

    /// Returns the state from which the next session can resume. It includes the current practice session, or the unfinished exam or
    /// `game`. `None` if there is no such session and nothing has changed since the start.
    pub fn saved_session(&self, practised: Option<&Session>, game: Option<&Session>) -> Option<SavedSession> {
        let is_begun = self.is_begun() || practised.or(game).is_some() || !self.unfinished_exams.is_empty();
        if self.followed().is_some() || !is_begun {
            return None;
        }
        let (declined, left): (Vec<_>, Vec<_>) =
            self.unfinished_exams.iter().rev().partition(|exam| self.is_declined(exam));
        let earlier_practice = self.earlier_sessions.first().and_then(|before| before.practice.as_ref());
        let mut exams = practised.into_iter().chain(left.iter().copied()).chain(earlier_practice);
        let practice = exams.find(|session| session.is_exam()).or(practised).or(game);
        let ended = |practice: Option<&Session>| {
            let (table, terms) = (self.table().clone(), self.query.terms());
            SavedSession::new(table, *self.layout(), self.cue_ball(), terms, practice.cloned())
                .with_settings(self.settings_terms)
        };
        // A saved session holds one practice session. Each further unfinished exam or game is saved as an earlier session of its own.
        let others = left.into_iter().chain(game);
        let others = others.filter(|other| practice.is_none_or(|practice| practice.id != other.id));
        let former = others.map(|other| ended(Some(other))).chain(self.earlier_sessions.iter().cloned());
        let former = former.chain(declined.into_iter().map(|exam| ended(Some(exam))));
        Some(ended(practice).with_former_sessions(former.collect()))
    }

    /// Returns the earlier sessions that have not been resumed, in the form in which they are saved; `None` if there are none.
    pub fn earlier_session(&self) -> Option<SavedSession> {
        SavedSession::of_sessions(&self.earlier_sessions)
    }

    /// Whether the user has changed anything since the start.
    fn is_begun(&self) -> bool {
        self.history.can_undo() || !self.history.present().advised.is_empty() || self.query.terms() != self.start_terms
    }

    /// Whether the exam was left without a stroke since it was last resumed: the player wants something else.
    fn is_declined(&self, exam: &Session) -> bool {
        self.resumed_exams.get(&exam.id) == Some(&exam.attempts.len())
    }

    /// Whether the exam that is open on the drill screens is the next to resume.
    pub fn resumes_open(&self, exam: &Session) -> bool {
        self.unfinished_exams.is_empty() && (self.earlier_sessions.is_empty() || !self.is_declined(exam))
    }

    /// Notes that the exam is being resumed.
    pub fn note_resumed(&mut self, exam: &Session) {
        self.resumed_exams.insert(exam.id.clone(), exam.attempts.len());
    }

    /// Keeps an exam that was left. Returns whether others, or earlier sessions, are resumed before it.
    pub fn keep_exam(&mut self, exam: Session) -> bool {
        let is_declined = self.is_declined(&exam);
        let others = self.unfinished_exams.len();
        self.unfinished_exams.insert(if is_declined { 0 } else { others }, exam);
        is_declined && (others > 0 || !self.earlier_sessions.is_empty())
    }

    /// Keeps an exam that is interrupted by another one, which is resumed.
    pub fn keep_interrupted_exam(&mut self, exam: Option<Session>) {
        self.unfinished_exams.splice(0..0, exam);
    }

    /// Resumes an unfinished exam, or the last saved session. Returns its practice session, if it has one. An exam that was left without
    /// a stroke since it was last resumed waits for all others and all saved sessions.
    pub fn resume(&mut self) -> Option<Session> {
        let wanted = self.unfinished_exams.iter().rposition(|exam| !self.is_declined(exam));
        let declined = self.unfinished_exams.len().checked_sub(1).filter(|_| self.earlier_sessions.is_empty());
        let practice = match wanted.or(declined) {
            Some(place) => Some(self.unfinished_exams.remove(place)),
            None => self.resume_earlier_session(),
        };
        if let Some(exam) = practice.as_ref().filter(|practice| practice.is_exam()) {
            self.note_resumed(exam);
        }
        practice
    }

    /// Resumes the last saved session. Returns its practice session, if it has one.
    fn resume_earlier_session(&mut self) -> Option<Session> {
        if self.earlier_sessions.is_empty() {
            return None;
        }
        let last = self.earlier_sessions.remove(0);
        // A session that stores its settings had its terms restored at the start; keys may have changed them since then.
        let terms = if last.settings.is_some() { self.query.terms() } else { last.terms() };
        let query = CoachQuery { policy: self.policy_on(&last.table), ..self.query.with(terms) };
        let its_rule = if last.rule == query.rule { String::new() } else { format!(", under the rule {}", last.rule) };
        self.replace_position(&last.table, last.layout, last.cue_ball, query);
        let which = if std::mem::replace(&mut self.has_resumed, true) { "that earlier" } else { "the last" };
        let more = if self.earlier_sessions.is_empty() { "" } else { "; c goes back to the one before" };
        let text = format!("this is where {which} session ended{its_rule}; Enter asks the coach{more}");
        self.message = Some(Message::good(text));
        last.practice
    }

    /// Takes the latest unfinished match against the coach out of the earlier sessions.
    pub fn take_open_match(&mut self) -> Option<Session> {
        let of = |before: &mut SavedSession| before.practice.take_if(|practice| practice.is_against_coach());
        self.earlier_sessions.iter_mut().find_map(of)
    }
}
