//! The screen of an exercise: the balls, the stroke that the player sets, the shot that it produces, and the session.
//!
//! [`super::turn_actions`] implements the key actions.

use std::sync::{
    Arc,
    atomic::{AtomicBool, AtomicU64, Ordering},
};

use crate::{
    coach::{
        StrokeTextError,
        words::{LengthUnit, no_jump_words},
    },
    drills::{Attempt, Exercise, ExerciseError, Goal, Session, Venue},
    game::Point,
    physics::CueInputs,
    table::{CueBall, Layout, Table},
    terminal::{
        AdviceTask, AttemptOutcome, DrillTask, ModelShot, PlayTask, Shot,
        pages::drills::{Watched, aim_line::AimLine},
        shot::{OwnStroke, Playback, Profile, StrokeChange, WhatIf, aiming, stroke::StrokeLimit},
        ui::Message,
    },
};

/// Counter for the numbers of requests to the coach, shared by all exercises: an answer may arrive when another exercise is open.
pub(super) static NEXT_REQUEST: AtomicU64 = AtomicU64::new(1);

/// Stage of an attempt.
#[derive(Debug)]
pub enum Stage {
    /// The player sets the stroke.
    Aiming,
    /// The stroke is being simulated.
    Waiting,
    /// The player watches the shot.
    Watching(Box<Watched>),
}

/// The model shot, or why there is none yet.
#[derive(Debug)]
pub enum ModelShotState {
    /// The coach is still thinking.
    Pending,
    /// The coach has found no shot that makes the point.
    Missing,
    /// The model shot is known.
    Known(Box<ModelShot>),
}

/// The state of an open exercise.
#[derive(Debug)]
#[expect(clippy::struct_excessive_bools, reason = "each is a fact of its own, seen or not, asked or not")]
pub struct Turn {
    /// The session, without changes whose saving is still in progress.
    pub session: Session,
    /// The open exercise.
    pub exercise: Exercise,
    /// The table.
    pub table: Table,
    /// The positions of the balls.
    pub layout: Layout,
    /// The cue ball.
    pub cue_ball: CueBall,
    /// Stage of the attempt.
    pub stage: Stage,
    /// Whether the coach may advise jumps and massés here.
    pub jumps: bool,
    /// The model shot.
    pub model_shot: ModelShotState,
    /// Whether the model shot is shown.
    pub shows_hint: bool,
    /// Whether the attempt counts as one with a hint: the model shot was shown since the balls were placed.
    pub with_hint: bool,
    /// Whether a jump is also shown from the side.
    pub has_side_view: bool,
    /// Page number in the text panel, if the text needs several pages; taken modulo the number of pages.
    pub text_page: isize,
    /// The session with all changes, while saving is in progress.
    unsaved: Option<Session>,
    /// The stroke, with its undo history.
    pub(super) stroke: OwnStroke,
    /// The comparison with the model shot; `None` if there is none.
    pub(super) what_if: Option<WhatIf>,
    /// Whether the player was warned that the stroke is unchanged. After that it is played nevertheless.
    is_warned: bool,
    pub(super) advice_id: u64,
    cancel: Arc<AtomicBool>,
}

impl Turn {
    /// Opens the next exercise of `session`; `None` if there is none.
    ///
    /// # Errors
    /// Fails if the exercise cannot be played.
    pub fn new(session: Session) -> Result<Option<Self>, ExerciseError> {
        let (Some(exercise), Some((table, layout))) = (session.exercise().cloned(), session.position()?) else {
            return Ok(None);
        };
        // The coach's next stroke is visible from the start.
        let is_coachs = session.is_coachs_turn();
        Ok(Some(Self {
            stroke: OwnStroke::new(aiming::first_stroke(Point::of(exercise.rule, &table, &layout), &layout)),
            what_if: None,
            is_warned: false,
            cue_ball: session.next_cue_ball(),
            jumps: true,
            session,
            exercise,
            table,
            layout,
            stage: Stage::Aiming,
            model_shot: ModelShotState::Pending,
            shows_hint: is_coachs,
            with_hint: false,
            has_side_view: false,
            text_page: 0,
            unsaved: None,
            advice_id: 0,
            cancel: Arc::default(),
        }))
    }

    /// The stroke as the player has set it.
    pub const fn stroke(&self) -> &CueInputs {
        self.stroke.cue()
    }

    /// The stroke as it will be played: if the rails or balls behind the cue ball require it, the cue is raised.
    pub fn raised_stroke(&self) -> CueInputs {
        self.stroke.raised(&self.table, &self.layout)
    }

    /// Changes the stroke.
    pub(super) fn change_stroke(&mut self, change: StrokeChange) -> Result<Vec<DrillTask>, StrokeLimit> {
        self.stroke.change(change, &self.table, &self.layout)?;
        Ok(self.compare())
    }

    /// Sets the stroke from its description in words.
    pub(super) fn set_stroke_in_words(&mut self, words: &str) -> Result<Vec<DrillTask>, StrokeTextError> {
        self.stroke.apply_text(words, &self.table, &self.layout, self.cue_ball)?;
        Ok(self.compare())
    }

    /// Undoes or redoes a change of the stroke, as `step` does.
    pub(super) fn step_history(&mut self, step: impl Fn(&mut OwnStroke) -> bool) -> Vec<DrillTask> {
        step(&mut self.stroke);
        self.compare()
    }

    /// Whether to warn that the player has not changed the initial stroke. Returns `true` only once.
    pub(super) fn should_warn_unchanged(&mut self) -> bool {
        let warns = self.is_aiming() && !self.is_coachs_turn() && !self.stroke.can_undo_redo().0;
        warns && !std::mem::replace(&mut self.is_warned, true)
    }

    /// Whether a run, a game or a match has begun and is not over, so that another session would end it.
    pub(super) fn is_in_progress(&self) -> bool {
        let newest = self.latest_session();
        !matches!(newest.goal, Goal::Free | Goal::Exam) && !newest.attempts.is_empty() && !newest.is_over()
    }

    /// The watched stroke.
    pub const fn watched(&self) -> Option<&Watched> {
        if let Stage::Watching(watched) = &self.stage { Some(watched) } else { None }
    }

    /// Jumps to the end of the watched stroke, if there is one.
    pub(super) fn finish_watching(&mut self) {
        if let Some(watched) = self.watched_mut().filter(|watched| !watched.is_end_shown) {
            watched.finish();
        }
    }

    pub(super) const fn watched_mut(&mut self) -> Option<&mut Watched> {
        if let Stage::Watching(watched) = &mut self.stage { Some(watched) } else { None }
    }

    /// Whether the player is setting the stroke.
    pub const fn is_aiming(&self) -> bool {
        matches!(self.stage, Stage::Aiming)
    }

    /// Whether the coach plays the next stroke, as the other side of a match.
    pub fn is_coachs_turn(&self) -> bool {
        self.is_aiming() && self.session.is_coachs_turn()
    }

    /// Whether the stroke is being simulated.
    pub const fn is_waiting(&self) -> bool {
        matches!(self.stage, Stage::Waiting)
    }

    /// The model shot if it is shown; `None` at the coach's own turn, when the current stroke is the coach's.
    pub fn shown_model(&self) -> Option<&ModelShot> {
        self.hint().filter(|_| !self.is_with_coach())
    }

    /// Whether the next or the watched stroke is the coach's.
    pub fn is_with_coach(&self) -> bool {
        self.is_coachs_turn() || self.watched().is_some_and(Watched::is_by_coach)
    }

    /// Whether the coach is still thinking about its own stroke.
    pub fn is_coach_thinking(&self) -> bool {
        self.is_coachs_turn() && matches!(self.model_shot, ModelShotState::Pending)
    }

    /// The aim line of the stroke while the player sets it.
    pub fn aim_line(&self) -> Option<AimLine> {
        let is_there = self.is_aiming() && !self.is_coach_thinking();
        is_there.then(|| AimLine::of(&self.table, &self.layout, &self.raised_stroke())).flatten()
    }

    /// The model shot, if it is known.
    pub const fn model_shot(&self) -> Option<&ModelShot> {
        if let ModelShotState::Known(model_shot) = &self.model_shot { Some(model_shot) } else { None }
    }

    /// The model shot, if it is known and shown.
    pub fn hint(&self) -> Option<&ModelShot> {
        self.model_shot().filter(|_| self.shows_hint)
    }

    /// Whether the model shot is on the table, alone or next to the player's stroke. At its turn, the coach's shot stays there.
    pub(super) fn shows_model_shot(&self) -> bool {
        self.what_if().is_some() || self.hint().is_some() && !self.is_coachs_turn()
    }

    /// The shot on the table: the player's own in a comparison, else the model shot if it is shown, else the watched one.
    pub fn shot(&self) -> Option<&Shot> {
        if let Some(what_if) = self.what_if() {
            return Some(&what_if.shot);
        }
        match self.watched() {
            Some(watched) if !self.shows_hint => watched.outcome.shot.as_deref(),
            _ => self.hint().map(|model_shot| model_shot.shot.as_ref()),
        }
    }

    /// The height profile of the displayed shot's jump; `None` if the side view is off or no ball jumps.
    pub fn profile(&self) -> Option<&Profile> {
        self.shot().filter(|_| self.has_side_view)?.profile(&self.table)
    }

    /// Turns the side view of jumps on or off, and returns a message on it. Without a shot, the choice applies to the next one.
    pub(super) fn toggle_side_view(&mut self) -> String {
        self.has_side_view = !self.has_side_view;
        match (self.has_side_view, self.shot()) {
            (false, _) => "jumps are shown from above only".to_owned(),
            (true, None) => "jumps are shown from the side too".to_owned(),
            (true, Some(shot)) if shot.profile(&self.table).is_some() => "the jump from the side".to_owned(),
            (true, Some(_)) => no_jump_words(&self.table).to_owned(),
        }
    }

    /// Whether the last attempt of the session is still being watched, so that its result must not be shown yet.
    pub(super) fn is_result_hidden(&self) -> bool {
        self.watched().is_some_and(|watched| !watched.is_end_shown)
    }

    /// The session without an attempt whose result must not be shown yet.
    pub fn settled_session(&self) -> Session {
        let mut session = self.session.clone();
        if self.is_result_hidden() {
            session.undo();
        }
        session
    }

    /// The result of the watched stroke; `None` if it must not be shown yet.
    pub fn verdict(&self, unit: LengthUnit) -> Option<Message> {
        let watched = self.watched().filter(|watched| watched.is_end_shown)?;
        let AttemptOutcome { played, .. } = &watched.outcome;
        let mut text = played.words(self.cue_ball, unit);
        if watched.is_by_coach() {
            text += " (the coach)";
        }
        if let Some(score) = self.session.score_words().filter(|_| self.session.is_over()) {
            let winner = self.session.winner_words().unwrap_or_default();
            text = format!("{text}; the match is over: {score}, {winner}");
        }
        Some(if played.made { Message::good(text) } else { Message::warning(text) })
    }

    /// Requests the model shot for the current position, and cancels the previous request.
    pub(super) fn request_model_shot(&mut self) -> Vec<DrillTask> {
        self.cancel_request();
        self.what_if = None;
        self.model_shot = ModelShotState::Pending;
        self.advice_id = NEXT_REQUEST.fetch_add(1, Ordering::Relaxed);
        let is_exact = self.layout == self.exercise.layout;
        vec![DrillTask::Advise(Box::new(AdviceTask {
            id: self.advice_id,
            table: self.table.clone(),
            layout: self.layout,
            rule: self.exercise.rule,
            shooter: self.session.shooter(),
            plan: self.session.is_game(),
            jumps: self.jumps,
            is_for_coach: self.session.is_coachs_turn(),
            own: self.session.model_shot_of(&self.exercise).filter(|_| is_exact && !self.session.is_game()),
            cancel: Arc::clone(&self.cancel),
        }))]
    }

    /// Cancels the pending request for a model shot.
    pub(super) fn cancel_request(&mut self) {
        self.cancel.store(true, Ordering::Relaxed);
        self.cancel = Arc::default();
    }

    /// Handles the answer to request `id`; late answers are dropped.
    pub(super) fn on_model_shot(&mut self, model_shot: Option<ModelShot>) {
        if let Some(model_shot) = model_shot.as_ref().filter(|_| self.is_coachs_turn()) {
            self.stroke = OwnStroke::new(model_shot.advice.cue);
        }
        self.model_shot =
            model_shot.map_or(ModelShotState::Missing, |model_shot| ModelShotState::Known(Box::new(model_shot)));
    }

    /// Returns the task that plays the stroke.
    pub(super) fn play(&mut self) -> DrillTask {
        self.stroke.end_undo_step();
        self.text_page = 0;
        self.stage = Stage::Waiting;
        self.with_hint |= self.shows_hint;
        self.shows_hint = false;
        DrillTask::Play(Box::new(PlayTask {
            session: self.session.clone(),
            intended: *self.stroke(),
            with_hint: self.with_hint,
            advice_id: self.advice_id,
        }))
    }

    /// Handles the result of a played stroke and starts its playback.
    pub(super) fn on_played(&mut self, outcome: AttemptOutcome) {
        if outcome.session.id != self.session.id || !matches!(self.stage, Stage::Waiting) {
            return;
        }
        self.session = outcome.session.clone();
        let noted = outcome.session.attempts.last().and_then(|attempt| attempt.intended);
        let intended = noted.unwrap_or(*self.stroke());
        let playback = Playback::default();
        let mut watched = Watched { outcome, intended, chance: None, playback, is_end_shown: false };
        watched.playback.toggle(watched.duration());
        watched.settle();
        self.stage = Stage::Watching(Box::new(watched));
    }

    /// Stores the success rate of the stroke that was meant in attempt `number` of the session `id`.
    pub(super) fn on_judged(&mut self, id: &str, number: usize, chance: f64) {
        if self.session.id != id || self.session.attempts.len() <= number {
            return;
        }
        self.session.attempts[number].chance = Some(chance);
        let is_last = self.session.attempts.len() == number + 1;
        if let Some(watched) = self.watched_mut().filter(|_| is_last) {
            watched.chance = Some(chance);
        }
    }

    /// The session including changes whose saving is in progress.
    pub(super) fn latest_session(&self) -> &Session {
        self.unsaved.as_ref().unwrap_or(&self.session)
    }

    /// Returns the task that saves the changed `session`.
    pub(super) fn save(&mut self, session: Session) -> DrillTask {
        let before = self.latest_session().attempts.clone();
        self.unsaved = Some(session.clone());
        DrillTask::Save(Box::new(session), before)
    }

    /// Whether another instance of the program has continued the session (its version is `stored`) and no save is in progress here.
    pub(super) fn is_older_than(&self, stored: &Session) -> bool {
        let (known, stored) = (&self.session.attempts, &stored.attempts);
        self.is_aiming() && self.unsaved.is_none() && known.len() < stored.len() && Attempt::is_prefix(known, stored)
    }

    /// Continues with the version of another instance of the program.
    pub(super) fn replace_session(&mut self, stored: Session) -> Vec<DrillTask> {
        self.stage = Stage::Aiming;
        self.begin_session(stored)
    }

    /// Handles the end of saving a session, successful or not. Requests a new model shot if the next position is a different one.
    pub(super) fn on_saved(&mut self, session: &Session) -> Vec<DrillTask> {
        if self.unsaved.as_ref().is_none_or(|ahead| ahead.id != session.id) {
            return Vec::new();
        }
        self.unsaved.take_if(|ahead| ahead == session);
        self.session = session.clone();
        if self.place_next() { self.request_model_shot() } else { Vec::new() }
    }

    /// Whether a record from a real table can be undone.
    pub(super) fn can_undo(&self) -> bool {
        let newest = self.latest_session();
        newest.venue == Venue::Table && !newest.attempts.is_empty()
    }

    /// Starts another session of the same exercises. Requests a new model shot if that may be different now.
    pub(super) fn begin_session(&mut self, session: Session) -> Vec<DrillTask> {
        let asks_otherwise = (session.skill, session.is_game()) != (self.session.skill, self.session.is_game());
        self.session = session;
        self.unsaved = None;
        let is_moved = self.place_next();
        if is_moved || asks_otherwise { self.request_model_shot() } else { Vec::new() }
    }

    /// Places the balls for the next attempt of the session. Returns whether the position has changed.
    pub(super) fn place_next(&mut self) -> bool {
        match self.session.position() {
            Ok(Some((table, layout))) => self.place_balls(table, layout),
            // The session is over. An error is impossible here, because the exercise was checked when it was opened.
            _ => false,
        }
    }

    /// Places the balls. Returns whether the position has changed.
    pub(super) fn place_balls(&mut self, table: Table, layout: Layout) -> bool {
        let exercise = self.session.exercise().cloned().unwrap_or_else(|| self.exercise.clone());
        let is_other = exercise.name != self.exercise.name;
        // The equalising inning may begin from the balls of the stroke before.
        let is_turned = self.session.next_cue_ball() != self.cue_ball;
        let is_moved = is_other || is_turned || layout != self.layout || table != self.table;
        if is_other || is_moved && self.session.is_game() {
            let point = Point::of(exercise.rule, &table, &layout);
            self.stroke = OwnStroke::new(aiming::first_stroke(point, &layout));
            self.is_warned = false;
        }
        (self.exercise, self.table, self.layout) = (exercise, table, layout);
        self.cue_ball = self.session.next_cue_ball();
        self.stage = Stage::Aiming;
        // The coach's stroke is visible at its turn and hidden at the player's.
        self.shows_hint = self.is_coachs_turn() || self.shows_hint && !is_moved;
        if is_moved {
            self.what_if = None;
        }
        self.with_hint = self.shows_hint || self.what_if.is_some();
        is_moved
    }

    /// Advances the playback by `seconds`.
    pub fn tick(&mut self, seconds: f64) {
        if let Some(watched) = self.watched_mut() {
            watched.playback.tick(seconds, watched.duration());
            watched.settle();
        }
    }

    /// Whether a playback is running.
    pub fn is_moving(&self) -> bool {
        self.watched().is_some_and(|watched| watched.playback.playing)
    }
}
