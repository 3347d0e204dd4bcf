//! Handling of the results of the drill page's background tasks.

use crate::{
    coach::Skill,
    drills::{Attempt, Exercise, Library, Session, store::OwnSkill},
    terminal::{
        AttemptOutcome, DrillContext, DrillReport, DrillTask, LoadedRecords,
        pages::{
            Page,
            drills::{Book, DrillsPage, Estimate, Question, Stage},
        },
        ui::Message,
        words::name_taken_message,
    },
};

impl DrillsPage {
    /// Handles the result of a task. Returns follow-up tasks.
    pub fn receive(&mut self, report: DrillReport) -> Vec<DrillTask> {
        match report {
            DrillReport::Loaded(loaded) => {
                self.on_loaded(*loaded);
                let mut tasks = self.load_newer_session();
                if self.page() == DrillContext::Record {
                    tasks.push(DrillTask::Estimate(self.records.next_request(), self.book.sessions.clone().into()));
                }
                return tasks;
            }
            DrillReport::ModelShot(id, answer) if self.turn.as_ref().is_some_and(|turn| turn.advice_id == id) => {
                let model_shot = answer.unwrap_or_else(|sentence| self.refuse(sentence));
                if let Some(turn) = &mut self.turn {
                    turn.on_model_shot(model_shot);
                }
            }
            // The player has left those balls in the meantime.
            DrillReport::ModelShot(..) => {}
            DrillReport::Played(id, played, saved) => self.on_played(&id, played, saved),
            DrillReport::AttemptRated(id, number, chance) => {
                if let Some(turn) = &mut self.turn {
                    turn.on_judged(&id, number, chance);
                }
                let result = self.exam_result.as_mut().filter(|result| result.session.id == id);
                if let Some(attempt) = result.and_then(|result| result.session.attempts.get_mut(number)) {
                    attempt.chance = Some(chance);
                }
            }
            DrillReport::StrokeRated(id, made) => {
                if let Some(what_if) = self.turn.as_mut().and_then(|turn| turn.what_if.as_mut()) {
                    what_if.set_rate(id, made);
                }
            }
            DrillReport::Saved(session, saved) => return self.on_saved(&session, saved),
            DrillReport::Changed(stored) => {
                self.book.insert(&stored);
                let tasks = self.replace_session(*stored);
                self.message = Some(Message::warning(
                    "another program has changed this session; its version is loaded, without your last action",
                ));
                return tasks;
            }
            DrillReport::Retried(retried) => self.on_retried(retried.err()),
            DrillReport::PositionSaved(exercise, outcome) => match outcome {
                Ok(true) => self.on_position_saved(&exercise),
                Ok(false) if self.question.is_some() => {
                    self.message = Some(Message::warning(name_taken_message(&exercise.name)));
                }
                Ok(false) => self.question = Some(Question::Replace(exercise)),
                Err(sentence) => {
                    self.message = Some(Message::warning(format!("{} is not saved: {sentence}", exercise.name)));
                }
            },
            DrillReport::PositionRemoved(name, outcome) => match outcome {
                Ok(()) => {
                    let own = self.own_positions().filter(|exercise| exercise.name != name).cloned().collect();
                    self.set_own_positions(own);
                    self.message = Some(Message::plain(format!("{name} is removed; its results stay")));
                }
                Err(sentence) => self.message = Some(Message::warning(format!("{name} is not removed: {sentence}"))),
            },
            DrillReport::Estimated(number, found) => {
                let missing = Estimate::Missing;
                let estimate = found.map_or_else(missing, |(skill, sentence)| Estimate::Known(skill, sentence));
                self.records.on_estimate(number, estimate);
            }
            DrillReport::Filmed(number, played) => {
                if let Err(sentence) = self.film.receive(number, played) {
                    self.message = Some(Message::warning(sentence));
                }
            }
            DrillReport::SkillSaved(skill, kept) => {
                self.player.own_skill = Some(skill);
                self.skill_since =
                    self.book.sessions.iter().flat_map(|session| &session.attempts).map(|attempt| attempt.at).max();
                self.player.choose(skill);
                self.message = Some(Message::good("this is your skill now: you are the player \"me by my notes\""));
                self.warn_unsaved(kept, "the skill is used now, but it could not be saved");
                return self.change_player();
            }
        }
        Vec::new()
    }

    /// Handles the result of playing a stroke in the session `id`, and of saving it.
    fn on_played(&mut self, id: &str, played: Result<Box<AttemptOutcome>, String>, saved: Result<(), String>) {
        match (played, &mut self.turn) {
            (Ok(outcome), turn) => {
                self.book.insert(&outcome.session);
                // The player may have left the session while the stroke was being played.
                let mut left = self.unfinished_sessions.iter();
                if let Some(place) = left.position(|left| left.id == outcome.session.id) {
                    self.unfinished_sessions[place] = outcome.session.clone();
                }
                self.unfinished_sessions.retain(|left| !left.is_over());
                if let Some(turn) = turn {
                    turn.on_played(*outcome);
                }
            }
            (Err(sentence), Some(turn)) if turn.session.id == id && matches!(turn.stage, Stage::Waiting) => {
                turn.stage = Stage::Aiming;
                self.message = Some(Message::warning(sentence));
            }
            // The user has left the session in the meantime.
            (Err(_), _) => {}
        }
        self.note_refusal(&saved);
        self.warn_unsaved(saved, "the attempt counts here, but it is not saved");
    }

    fn on_loaded(&mut self, loaded: LoadedRecords) {
        let LoadedRecords { sessions, positions, skill, troubles } = loaded;
        self.book = Book::new(sessions, troubles);
        self.set_own_positions(positions);
        // The saved skill becomes the current one unless the user has chosen another.
        self.skill_since = skill.map(|own| own.since).or(self.skill_since);
        if let Some(OwnSkill { skill, .. }) = skill.filter(|_| self.player.own_skill.is_none()) {
            self.player.own_skill = Some(skill);
            if self.player.skill == Skill::default() {
                self.player.skill = skill;
            }
        }
    }

    /// Loads the newer version of the open session if another instance of the program has continued it.
    fn load_newer_session(&mut self) -> Vec<DrillTask> {
        let Some(turn) = &self.turn else { return Vec::new() };
        let stored =
            self.book.sessions.iter().find(|stored| stored.id == turn.session.id && turn.is_older_than(stored));
        let Some(stored) = stored.cloned() else { return Vec::new() };
        self.message = Some(Message::plain("another program has continued this session; its version is loaded"));
        self.replace_session(stored)
    }

    /// Replaces the open session with the version of another instance of the program.
    fn replace_session(&mut self, stored: Session) -> Vec<DrillTask> {
        let Some(turn) = self.turn.as_mut().filter(|turn| turn.session.id == stored.id) else { return Vec::new() };
        if stored.is_exam() && stored.is_over() {
            let tasks = turn.replace_session(stored.clone());
            self.show_result(stored);
            return tasks;
        }
        turn.replace_session(stored)
    }

    /// Handles the result of saving a session, with a message about the recorded or undone attempt.
    fn on_saved(&mut self, session: &Session, saved: Result<(), String>) -> Vec<DrillTask> {
        let before = self.book.sessions.iter().find(|known| known.id == session.id);
        let taken_back = before.and_then(|before| before.attempts.get(session.attempts.len())).cloned();
        self.book.insert(session);
        let tasks = self.turn.as_mut().map_or_else(Vec::new, |turn| turn.on_saved(session));
        let record = session.record();
        let what = |attempt: &Attempt| if attempt.made { "made" } else { "missed" };
        let now = match record.tried {
            0 => "nothing is noted now".to_owned(),
            tried => format!("{} of {tried} now", record.made),
        };
        self.message = Some(match (taken_back, session.attempts.last()) {
            (Some(attempt), _) => Message::plain(format!("undone: {}, {now}", what(&attempt))),
            // The first record may be a mistake, because earlier strokes were played in the program.
            (None, Some(first)) if record.tried == 1 => {
                Message::plain(format!("noted for a real table: {}, {now}; u undoes it", what(first)))
            }
            (None, Some(last)) if last.made => Message::good(format!("noted: made, {now}")),
            (None, Some(_)) => Message::plain(format!("noted: missed, {now}")),
            (None, None) => Message::plain(now),
        });
        if session.is_over() {
            self.message = Some(Message::good(format!("done: {} of {} made", record.made, record.tried)));
        }
        self.note_refusal(&saved);
        self.warn_unsaved(saved, "the note counts here, but it is not saved");
        tasks
    }

    /// Tells that everything is saved now, or what is still not. The same refusal is not told again.
    fn on_retried(&mut self, refusal: Option<String>) {
        if self.unsaved != refusal {
            self.message = Some(match &refusal {
                None => Message::good("what was not saved is on the disk now"),
                Some(sentence) => Message::warning(format!("{sentence}; carom tries again")),
            });
            self.unsaved = refusal;
        }
    }

    /// Notes that the disk has refused something, which is tried again later.
    fn note_refusal(&mut self, saved: &Result<(), String>) {
        if saved.is_err() {
            self.unsaved.get_or_insert_default();
        }
    }

    fn warn_unsaved(&mut self, saved: Result<(), String>, what: &str) {
        if let Err(sentence) = saved {
            self.message = Some(Message::warning(format!("{what}: {sentence}")));
        }
    }

    /// The user's own positions in the library.
    fn own_positions(&self) -> impl Iterator<Item = &Exercise> {
        let library = &self.catalogue.library;
        library.exercises().iter().filter(|exercise| !library.is_bundled(&exercise.name))
    }

    fn set_own_positions(&mut self, own: Vec<Exercise>) {
        let (library, refused) = Library::with_own(own);
        self.catalogue.set_library(library);
        self.book.troubles.extend(refused.iter().map(ToString::to_string));
    }

    fn on_position_saved(&mut self, exercise: &Exercise) {
        let own = self.own_positions().filter(|own| own.name != exercise.name).cloned();
        let own = own.chain([exercise.clone()]).collect();
        self.set_own_positions(own);
        self.catalogue.show_own(&exercise.name);
        self.message = Some(Message::good(format!("saved as {}", exercise.name)));
    }
}
