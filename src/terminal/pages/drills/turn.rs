//! The page of an exercise: the balls, the stroke that is set, the shot that came of it, and the session it counts in.
//!
//! [`super::turn_actions`] is what each key does to it.

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
        shot::{OwnStroke, Playback, Profile, StrokeChange, WhatIf, aiming, stroke::TipSlips},
        ui::Message,
    },
};

/// Numbers of the questions to the coach, whatever exercise they are about: an answer may come when another is open.
pub(super) static QUESTIONS: AtomicU64 = AtomicU64::new(1);

/// What is going on.
#[derive(Debug)]
pub enum Stage {
    /// The player sets the stroke.
    Aiming,
    /// It is being played.
    Waiting,
    /// It is watched.
    Watching(Box<Watched>),
}

/// The model shot, as far as it is known.
#[derive(Debug)]
pub enum ModelShotState {
    /// The coach is still thinking.
    Pending,
    /// It has found no shot that makes the point.
    Missing,
    /// This one.
    Known(Box<ModelShot>),
}

/// The page of an exercise.
#[derive(Debug)]
#[expect(clippy::struct_excessive_bools, reason = "each is a fact of its own, seen or not, asked or not")]
pub struct Turn {
    /// What counts, as far as it is safe on the disk or was seen not to be.
    pub session: Session,
    /// The exercise that is played.
    pub exercise: Exercise,
    /// The table.
    pub table: Table,
    /// Where the balls lie.
    pub layout: Layout,
    /// Which of them is the cue ball.
    pub cue_ball: CueBall,
    /// What is going on.
    pub stage: Stage,
    /// Whether the coach may advise jumps and massés here.
    pub jumps: bool,
    /// The model shot.
    pub model_shot: ModelShotState,
    /// Whether it is shown.
    pub shows_hint: bool,
    /// Whether it was shown since the balls were placed.
    pub with_hint: bool,
    /// Whether a jump is shown from the side too.
    pub is_from_side: bool,
    /// The page of the aim's text, where one has no room for all of it; beyond the last the first comes again.
    pub text_page: isize,
    /// The session as it will be once all notes are saved.
    ahead: Option<Session>,
    /// The stroke that is set, with what it was before.
    pub(super) stroke: OwnStroke,
    /// The stroke beside the model shot, once that was taken over.
    pub(super) what_if: Option<WhatIf>,
    /// Whether it was said that nobody has set the stroke yet: then it is played all the same.
    is_warned: bool,
    advice_id: u64,
    cancel: Arc<AtomicBool>,
}

impl Turn {
    /// The page of the exercise that `session` begins with.
    ///
    /// # Errors
    /// An exercise that cannot be played.
    pub fn new(session: Session) -> Result<Option<Self>, ExerciseError> {
        let (Some(exercise), Some((table, layout))) = (session.exercise().cloned(), session.position()?) else {
            return Ok(None);
        };
        // What the coach is to play is there to be seen.
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
            is_from_side: false,
            text_page: 0,
            ahead: None,
            advice_id: 0,
            cancel: Arc::default(),
        }))
    }

    /// The stroke that is set.
    pub const fn stroke(&self) -> &CueInputs {
        self.stroke.cue()
    }

    /// The stroke as it will be meant when it is played: rails and balls behind raise the cue that is set lower.
    pub fn raised_stroke(&self) -> CueInputs {
        self.stroke.raised(&self.table, &self.layout)
    }

    /// Changes the stroke.
    pub(super) fn change_stroke(&mut self, change: StrokeChange) -> Result<Vec<DrillTask>, TipSlips> {
        self.stroke.change(change, &self.table, &self.layout)?;
        Ok(self.compare())
    }

    /// Sets the stroke as `words` say it.
    pub(super) fn say_stroke(&mut self, words: &str) -> Result<Vec<DrillTask>, StrokeTextError> {
        self.stroke.say(words, &self.table, &self.layout, self.cue_ball)?;
        Ok(self.compare())
    }

    /// Sets the stroke as it was before its last change, or after it again.
    pub(super) fn travel(&mut self, step: impl Fn(&mut OwnStroke) -> bool) -> Vec<DrillTask> {
        step(&mut self.stroke);
        self.compare()
    }

    /// Whether the stroke is the one that the page began with, of the player's own, which nobody was warned of: once.
    pub(super) fn takes_warning(&mut self) -> bool {
        let warns = self.is_aiming() && !self.is_coachs_turn() && !self.stroke.can_travel().0;
        warns && !std::mem::replace(&mut self.is_warned, true)
    }

    /// Whether a run, a game or a match has begun and is not over: another session would end it.
    pub(super) fn is_under_way(&self) -> bool {
        let newest = self.newest();
        !matches!(newest.goal, Goal::Free | Goal::Exam) && !newest.attempts.is_empty() && !newest.is_over()
    }

    /// The stroke that is watched.
    pub const fn watched(&self) -> Option<&Watched> {
        if let Stage::Watching(watched) = &self.stage { Some(watched) } else { None }
    }

    /// Goes to the end of the stroke that is watched, if one is.
    pub(super) fn finish_watching(&mut self) {
        if let Some(watched) = self.watched_mut().filter(|watched| !watched.is_settled) {
            watched.finish();
        }
    }

    pub(super) const fn watched_mut(&mut self) -> Option<&mut Watched> {
        if let Stage::Watching(watched) = &mut self.stage { Some(watched) } else { None }
    }

    /// Whether the player sets a stroke.
    pub const fn is_aiming(&self) -> bool {
        matches!(self.stage, Stage::Aiming)
    }

    /// Whether the coach is to make the next stroke, as the other side of a match.
    pub fn is_coachs_turn(&self) -> bool {
        self.is_aiming() && self.session.is_coachs_turn()
    }

    /// Whether it waits for what came of a stroke.
    pub const fn is_waiting(&self) -> bool {
        matches!(self.stage, Stage::Waiting)
    }

    /// The model shot while it is shown, except where it is the coach's own turn: then its stroke is the one that is set.
    pub fn shown_model(&self) -> Option<&ModelShot> {
        self.hint().filter(|_| !self.is_with_coach())
    }

    /// Whether a stroke of the coach's is to come, or is watched.
    pub fn is_with_coach(&self) -> bool {
        self.is_coachs_turn() || self.watched().is_some_and(Watched::is_by_coach)
    }

    /// Whether the coach is still thinking about the stroke that it is to make.
    pub fn is_coach_thinking(&self) -> bool {
        self.is_coachs_turn() && matches!(self.model_shot, ModelShotState::Pending)
    }

    /// Where the stroke leads, while it is set.
    pub fn aim_line(&self) -> Option<AimLine> {
        let is_there = self.is_aiming() && !self.is_coach_thinking();
        is_there.then(|| AimLine::of(&self.table, &self.layout, &self.raised_stroke())).flatten()
    }

    /// The model shot, if it is known and there is one.
    pub const fn model_shot(&self) -> Option<&ModelShot> {
        if let ModelShotState::Known(model_shot) = &self.model_shot { Some(model_shot) } else { None }
    }

    /// The same while it is shown.
    pub fn hint(&self) -> Option<&ModelShot> {
        self.model_shot().filter(|_| self.shows_hint)
    }

    /// The shot on the table: the one that is watched, the model shot while it is shown, or the player's own beside it.
    pub fn shot(&self) -> Option<&Shot> {
        if let Some(what_if) = self.what_if() {
            return Some(&what_if.shot);
        }
        match self.watched() {
            Some(watched) if !self.shows_hint => watched.outcome.shot.as_deref(),
            _ => self.hint().map(|model_shot| model_shot.shot.as_ref()),
        }
    }

    /// The jump of the shot on the table, while it is to be shown from the side; a shot without one has none.
    pub fn profile(&self) -> Option<&Profile> {
        self.shot().filter(|_| self.is_from_side)?.profile(&self.table)
    }

    /// Shows jumps from the side, or no longer; what there is to say where the shot on the table has none. Before the stroke
    /// it holds for the one that comes.
    pub(super) fn turn_side_view(&mut self) -> String {
        self.is_from_side = !self.is_from_side;
        match (self.is_from_side, self.shot()) {
            (false, _) => "jumps are shown from above alone".to_owned(),
            (true, None) => "jumps are shown from the side too".to_owned(),
            (true, Some(shot)) if shot.profile(&self.table).is_some() => "the jump from the side".to_owned(),
            (true, Some(_)) => no_jump_words(&self.table).to_owned(),
        }
    }

    /// Whether the last attempt of the session is still being watched: its result is not shown yet.
    pub(super) fn is_open(&self) -> bool {
        self.watched().is_some_and(|watched| !watched.is_settled)
    }

    /// The session as far as it may be shown.
    pub fn settled_session(&self) -> Session {
        let mut session = self.session.clone();
        if self.is_open() {
            session.undo();
        }
        session
    }

    /// The result of the watched stroke, once it may be shown.
    pub fn verdict(&self, unit: LengthUnit) -> Option<Message> {
        let watched = self.watched().filter(|watched| watched.is_settled)?;
        let AttemptOutcome { played, .. } = &watched.outcome;
        let mut text = played.words(self.cue_ball, unit);
        if watched.is_by_coach() {
            text += " (the coach)";
        }
        if let Some(score) = self.session.score_words().filter(|_| self.session.is_over()) {
            text = format!("{text}; the match is over: {score}");
        }
        Some(if played.made { Message::good(text) } else { Message::warning(text) })
    }

    /// Asks for the model shot in this position. Nobody waits for the one before any more.
    pub(super) fn ask(&mut self) -> Vec<DrillTask> {
        self.stop_asking();
        self.what_if = None;
        self.model_shot = ModelShotState::Pending;
        self.advice_id = QUESTIONS.fetch_add(1, Ordering::Relaxed);
        let is_exact = self.layout == self.exercise.layout;
        vec![DrillTask::Advise(Box::new(AdviceTask {
            id: self.advice_id,
            table: self.table.clone(),
            layout: self.layout,
            rule: self.exercise.rule,
            shooter: self.session.shooter(),
            plan: self.session.is_game(),
            jumps: self.jumps,
            is_coachs: self.session.is_coachs_turn(),
            own: self.session.model_shot_of(&self.exercise).filter(|_| is_exact && !self.session.is_game()),
            cancel: Arc::clone(&self.cancel),
        }))]
    }

    /// Lets the coach stop thinking about a position that is left.
    pub(super) fn stop_asking(&mut self) {
        self.cancel.store(true, Ordering::Relaxed);
        self.cancel = Arc::default();
    }

    /// The answer to question `id`; late ones are dropped.
    pub(super) fn advised(&mut self, id: u64, model_shot: Option<ModelShot>) {
        if id == self.advice_id {
            if let Some(model_shot) = model_shot.as_ref().filter(|_| self.is_coachs_turn()) {
                self.stroke = OwnStroke::new(model_shot.advice.cue);
            }
            self.model_shot =
                model_shot.map_or(ModelShotState::Missing, |model_shot| ModelShotState::Known(Box::new(model_shot)));
        }
    }

    /// What plays the stroke that is set.
    pub(super) fn play(&mut self) -> DrillTask {
        self.stroke.settle();
        self.text_page = 0;
        self.stage = Stage::Waiting;
        self.with_hint |= self.shows_hint;
        self.shows_hint = false;
        DrillTask::Play(Box::new(PlayTask {
            session: self.session.clone(),
            meant: *self.stroke(),
            with_hint: self.with_hint,
            advice_id: self.advice_id,
        }))
    }

    /// The stroke was played.
    pub(super) fn played(&mut self, outcome: AttemptOutcome) {
        if outcome.session.id != self.session.id || !matches!(self.stage, Stage::Waiting) {
            return;
        }
        self.session = outcome.session.clone();
        let mut playback = Playback::default();
        let duration = outcome.shot.as_ref().map_or(0.0, |shot| shot.recording.duration());
        playback.toggle(duration);
        let noted = outcome.session.attempts.last().and_then(|attempt| attempt.intended);
        let meant = noted.unwrap_or(*self.stroke());
        let mut watched = Watched { outcome, meant, chance: None, playback, is_settled: false };
        watched.settle();
        self.stage = Stage::Watching(Box::new(watched));
    }

    /// How often the player makes what was meant in attempt `number` of the session called `id`.
    pub(super) fn judged(&mut self, id: &str, number: usize, chance: f64) {
        if self.session.id != id || self.session.attempts.len() <= number {
            return;
        }
        self.session.attempts[number].chance = Some(chance);
        let is_last = self.session.attempts.len() == number + 1;
        if let Some(watched) = self.watched_mut().filter(|_| is_last) {
            watched.chance = Some(chance);
        }
    }

    /// The session as it stands, with notes that are on their way to the disk.
    pub(super) fn newest(&self) -> &Session {
        self.ahead.as_ref().unwrap_or(&self.session)
    }

    /// What saves `session`, in which something was noted or taken back.
    pub(super) fn save(&mut self, session: Session) -> DrillTask {
        let before = self.newest().attempts.clone();
        self.ahead = Some(session.clone());
        DrillTask::Save(Box::new(session), before)
    }

    /// Whether another program has gone on with the session, as it is `stored`, and nothing here is on its way to the disk.
    pub(super) fn is_behind(&self, stored: &Session) -> bool {
        let (known, stored) = (&self.session.attempts, &stored.attempts);
        self.is_aiming() && self.ahead.is_none() && known.len() < stored.len() && Attempt::is_prefix(known, stored)
    }

    /// Goes on with the session as another program has left it.
    pub(super) fn go_on_with(&mut self, stored: Session) -> Vec<DrillTask> {
        self.stage = Stage::Aiming;
        self.begin(stored)
    }

    /// A session is on the disk, or cannot be; asks for the model shot where the balls lie elsewhere next.
    pub(super) fn saved(&mut self, session: &Session) -> Vec<DrillTask> {
        let Some(ahead) = self.ahead.take_if(|ahead| ahead.id == session.id) else { return Vec::new() };
        if ahead != *session {
            self.ahead = Some(ahead);
        }
        self.session = session.clone();
        if self.place_next() { self.ask() } else { Vec::new() }
    }

    /// Whether a note from a real table can be taken back.
    pub(super) fn can_undo(&self) -> bool {
        let newest = self.newest();
        newest.venue == Venue::Table && !newest.attempts.is_empty()
    }

    /// Begins another session of the same exercises, and asks for the model shot where that may be another stroke.
    pub(super) fn begin(&mut self, session: Session) -> Vec<DrillTask> {
        let asks_otherwise = (session.skill, session.is_game()) != (self.session.skill, self.session.is_game());
        self.session = session;
        self.ahead = None;
        let is_moved = self.place_next();
        if is_moved || asks_otherwise { self.ask() } else { Vec::new() }
    }

    /// Places the balls for the next attempt of the session; whether they lie elsewhere now.
    pub(super) fn place_next(&mut self) -> bool {
        match self.session.position() {
            Ok(Some((table, layout))) => self.place(table, layout),
            // It is over, or its exercise was checked when it was opened: nothing moves.
            _ => false,
        }
    }

    /// Places the balls; whether they lie elsewhere now.
    pub(super) fn place(&mut self, table: Table, layout: Layout) -> bool {
        let exercise = self.session.exercise().cloned().unwrap_or_else(|| self.exercise.clone());
        let is_other = exercise.name != self.exercise.name;
        let is_moved = is_other || layout != self.layout;
        if is_other || is_moved && self.session.is_game() {
            let point = Point::of(exercise.rule, &table, &layout);
            self.stroke = OwnStroke::new(aiming::first_stroke(point, &layout));
            self.is_warned = false;
        }
        (self.exercise, self.table, self.layout) = (exercise, table, layout);
        self.cue_ball = self.session.next_cue_ball();
        self.stage = Stage::Aiming;
        // What the coach is to play is no longer there when the player is to strike.
        self.shows_hint = self.is_coachs_turn() || self.shows_hint && !is_moved;
        if is_moved {
            self.what_if = None;
        }
        self.with_hint = self.shows_hint || self.what_if.is_some();
        is_moved
    }

    /// Lets `seconds` pass for the shot.
    pub fn tick(&mut self, seconds: f64) {
        if let Some(watched) = self.watched_mut()
            && let Some(shot) = &watched.outcome.shot
        {
            watched.playback.tick(seconds, shot.recording.duration());
            watched.settle();
        }
    }

    /// Whether something moves by itself.
    pub fn is_moving(&self) -> bool {
        self.watched().is_some_and(|watched| watched.playback.playing)
    }
}
