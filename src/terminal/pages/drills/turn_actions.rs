//! Implementation of the key actions on an open exercise, and their conditions.

use crate::{
    coach::Skill,
    drills::{Attempt, Goal, Session, Venue},
    terminal::{
        DrillAction as Action, DrillCondition as Condition, DrillTask, Effect, ModelShot,
        pages::drills::{DrillsPage, ModelShotState, Question, Stage, Turn, goals::with_added_length},
        shot::{OwnStroke, PlaybackKey, stroke},
        ui::{Message, TextField},
        words::player_words,
    },
};

/// The reason why a key is disabled before the result of a stroke has been shown.
pub(super) const IS_RUNNING: &str = "the shot is running; Enter skips to its end";
/// The reason why a key waits for the model shot to go.
const MODEL_SHOT_OFF: &str = "Esc takes the model shot off the table first";
/// The warning before a stroke is played that the player has not changed.
const UNCHANGED: &str = "the stroke is unchanged; Space again plays it anyway";

impl Turn {
    /// Returns the reason why a key binding is disabled now; `None` if it is enabled.
    pub(super) fn disabled_reason(&self, when: Condition) -> Option<&'static str> {
        let refuse = |refused: bool, reason| refused.then_some(reason);
        match (&self.stage, when) {
            (
                Stage::Waiting,
                Condition::Aiming
                | Condition::Playable
                | Condition::Watching
                | Condition::Running
                | Condition::Ended
                | Condition::GoalReached
                | Condition::Free
                | Condition::Restartable
                | Condition::Repeating
                | Condition::Recordable
                | Condition::HasGoalLength
                | Condition::InExam
                | Condition::ModelShotCopyable,
            ) => Some("the stroke is being played"),
            (
                Stage::Aiming,
                Condition::Playable
                | Condition::StrokeSet
                | Condition::Aiming
                | Condition::Watching
                | Condition::ModelShotCopyable,
            ) if self.is_coach_thinking() => Some("the coach is still thinking"),
            (Stage::Aiming, Condition::Playable | Condition::StrokeSet) if self.is_coachs_turn() => None,
            (Stage::Aiming, Condition::HasModelShot) if self.is_coachs_turn() && self.hint().is_some() => {
                Some("the coach's stroke is shown already")
            }
            (Stage::Aiming, Condition::Aiming | Condition::Watching | Condition::ModelShotCopyable)
                if self.is_coachs_turn() =>
            {
                Some("the coach plays this stroke: Space")
            }
            (_, Condition::Playable | Condition::Aiming) => {
                refuse(!self.is_aiming(), "a shot is being watched; Enter goes on")
            }
            (_, Condition::Recordable) => match self.session.goal {
                Goal::Match { against_coach: true, .. } => {
                    Some("the coach cannot play at a real table; o chooses another goal")
                }
                Goal::Match { .. } => Some("a match is played only here; o chooses another goal"),
                _ => self.disabled_reason(Condition::Restartable),
            },
            (_, Condition::Repeating) => {
                refuse(self.session.is_game(), "a game plays on from where the balls stop; o chooses another goal")
                    .or_else(|| self.disabled_reason(Condition::Restartable))
            }
            (_, Condition::Watching) => refuse(self.watched().is_none(), "no shot is being watched"),
            (_, Condition::Running | Condition::Ended | Condition::GoalReached) => match self.watched() {
                None => Some("no shot is being watched"),
                Some(watched) if !watched.is_end_shown => refuse(when != Condition::Running, IS_RUNNING),
                Some(_) => match (when, self.session.is_over() && !self.session.is_exam()) {
                    (Condition::Running, _) => Some("the shot is at its end"),
                    (Condition::Ended, true) => Some("the goal is reached"),
                    (Condition::GoalReached, false) => Some("the goal is not reached yet"),
                    _ => None,
                },
            },
            (_, Condition::InExam) => refuse(!self.session.is_exam(), "no exam is under way")
                .or(refuse(self.session.is_over(), "the exam is over; Enter shows its result")),
            (_, Condition::Free | Condition::Restartable | Condition::HasGoalLength) if self.session.is_exam() => {
                Some("an exam is under way; Esc leaves it, x discards it")
            }
            // Another session would remove the stroke before its result is shown. A run asks for confirmation, which shows the result.
            (_, Condition::Restartable | Condition::HasGoalLength)
                if self.is_result_hidden() && !self.is_in_progress() =>
            {
                Some(IS_RUNNING)
            }
            (_, Condition::HasGoalLength) => {
                refuse(self.session.goal == Goal::Free, "free repetition has no end; o chooses a goal")
            }
            (_, Condition::HasModelShot) => refuse(self.session.is_exam(), "an exam gives no hints")
                .or(refuse(matches!(self.model_shot, ModelShotState::Pending), "the coach is still thinking"))
                .or(refuse(self.model_shot().is_none(), "the coach has found no shot that makes the point")),
            (_, Condition::ModelShotHidden) => refuse(self.shows_model_shot(), MODEL_SHOT_OFF),
            (_, Condition::ModelShotCopyable) => self
                .disabled_reason(Condition::HasModelShot)
                .or_else(|| self.disabled_reason(Condition::Aiming))
                .or(refuse(self.what_if().is_some(), MODEL_SHOT_OFF)),
            (_, Condition::ModelShotShown) => refuse(!self.shows_model_shot(), "the model shot is not on the table"),
            (Stage::Aiming, Condition::StrokeUndoable) => {
                refuse(!self.stroke.can_undo_redo().0, "the stroke is unchanged")
            }
            (Stage::Aiming, Condition::StrokeSet) => {
                refuse(!self.stroke.can_undo_redo().0, "the stroke is unchanged; Space twice plays it anyway")
            }
            (Stage::Aiming, Condition::StrokeRedoable) => {
                refuse(!self.stroke.can_undo_redo().1, "no change of the stroke to redo")
            }
            (_, Condition::StrokeUndoable | Condition::StrokeSet | Condition::StrokeRedoable) => {
                self.disabled_reason(Condition::Aiming)
            }
            (_, Condition::Undoable) => refuse(
                !self.can_undo(),
                "there is no note from a real table since the last stroke here; z undoes the stroke",
            ),
            _ => None,
        }
    }

    /// Whether an action starts another session.
    fn is_ended_by(&self, action: Action) -> bool {
        match action {
            Action::ToggleShift | Action::NextGoal | Action::ChangeGoalLength(_) | Action::NextPlayer => true,
            Action::Play => self.latest_session().venue == Venue::Table,
            Action::LogAttempt(_) => self.latest_session().venue != Venue::Table,
            _ => false,
        }
    }

    /// Creates a new session of the same exercises with these options.
    fn new_session(&self, goal: Goal, shifted: bool, venue: Venue, skill: Skill, seed: u64) -> Session {
        let exercises = self.session.exercises.clone();
        let mut session = Session::new(goal, venue, exercises, skill, seed);
        session.shifted = shifted;
        session.coach_skill = self.session.coach_skill.filter(|_| session.is_against_coach());
        session
    }
}

impl DrillsPage {
    /// Performs an action on the open exercise. Asks for confirmation if the action would end an unfinished run, game or match.
    pub(super) fn update_turn(&mut self, action: Action) -> Option<Effect> {
        let turn = self.turn.as_mut()?;
        if action == Action::Play && turn.should_warn_unchanged() {
            self.message = Some(Message::warning(UNCHANGED));
            return None;
        }
        if turn.is_in_progress() && turn.is_ended_by(action) {
            // The question counts the stroke that is still being watched, so the score next to it must count it too.
            turn.finish_watching();
            let Session { goal, attempts, .. } = turn.latest_session();
            let own = attempts.iter().filter(|attempt| !attempt.by_coach).count();
            self.question = Some(Question::GiveUp(action, goal.name(), own));
            return None;
        }
        self.act(action)
    }

    /// Performs an action on the open exercise without confirmation.
    pub(super) fn act(&mut self, action: Action) -> Option<Effect> {
        let turn = self.turn.as_mut()?;
        match action {
            Action::ChangeStroke(change) => match turn.change_stroke(change) {
                Ok(tasks) => return tasks_effect(tasks),
                Err(error) => self.message = Some(Message::warning(error.to_string())),
            },
            Action::TypeStroke => self.question = Some(Question::Stroke(TextField::new(stroke::MAX_TEXT_LENGTH))),
            Action::UndoStroke => return tasks_effect(turn.step_history(OwnStroke::undo)),
            Action::RedoStroke => return tasks_effect(turn.step_history(OwnStroke::redo)),
            Action::WhatIf => return tasks_effect(turn.copy_model_shot()),
            Action::HideModelShot => (turn.what_if, turn.shows_hint) = (None, false),
            Action::Play => return self.play(),
            Action::Next => return self.next(),
            Action::Playback(key) => self.apply_playback_key(key),
            Action::ToggleHint => {
                turn.what_if = None;
                turn.shows_hint = !turn.shows_hint;
                turn.text_page = 0;
                turn.with_hint |= turn.shows_hint && turn.is_aiming();
            }
            Action::ToggleSideView => self.message = Some(Message::plain(turn.toggle_side_view())),
            Action::ToggleNumbers => self.is_in_numbers = !self.is_in_numbers,
            Action::TurnTextPage(pages) => turn.text_page += pages,
            Action::ToggleShift => {
                self.options.shifted = !turn.session.shifted;
                let news = if self.options.shifted {
                    "from the second repetition on, each ball is shifted by half a ball"
                } else {
                    "the balls are placed as in the exercise"
                };
                self.message = Some(Message::plain(news));
                return tasks_effect(self.restart(None));
            }
            Action::NextGoal => {
                let goal = self.options.lengths.next_goal(turn.session.goal);
                return tasks_effect(self.choose_goal(goal));
            }
            Action::ChangeGoalLength(step) => {
                let step = i32::try_from(step).unwrap_or(0);
                let goal = with_added_length(turn.session.goal, step);
                return tasks_effect(self.choose_goal(goal));
            }
            Action::NextPlayer => {
                self.player.choose_next();
                self.message = Some(Message::plain(format!("the player: {}", player_words(self.player.skill))));
                return tasks_effect(self.restart(None));
            }
            Action::LogAttempt(made) => return self.log(made),
            Action::Undo => return self.undo(),
            _ => {}
        }
        None
    }

    /// Restarts the open exercise if the player has changed. While a stroke is played or watched, the restart comes after it.
    pub(super) fn change_player(&mut self) -> Vec<DrillTask> {
        let is_on_its_way = self.turn.as_ref().is_some_and(|turn| turn.is_waiting() || turn.is_result_hidden());
        if self.has_other_player() && !is_on_its_way { self.restart(None) } else { Vec::new() }
    }

    /// Whether the player has changed since the session began. An exam or a run that has begun keeps its player to the end.
    fn has_other_player(&self) -> bool {
        let is_other =
            |turn: &Turn| !turn.session.is_exam() && !turn.is_in_progress() && turn.session.skill != self.player.skill;
        self.turn.as_ref().is_some_and(is_other)
    }

    /// Restarts the session with the current player and shift option.
    fn restart(&mut self, venue: Option<Venue>) -> Vec<DrillTask> {
        // The goal comes from the session, because a match started with F9 is not among the options.
        let Some(goal) = self.turn.as_ref().map(|turn| turn.session.goal) else { return Vec::new() };
        self.restart_for(goal, venue)
    }

    /// Restarts the session with another goal, which stays with the open exercise.
    fn choose_goal(&mut self, goal: Goal) -> Vec<DrillTask> {
        self.options.goals.extend(self.turn.as_ref().map(|turn| (turn.exercise.name.clone(), goal)));
        self.restart_for(goal, None)
    }

    /// Restarts the session with another goal.
    fn restart_for(&mut self, goal: Goal, venue: Option<Venue>) -> Vec<DrillTask> {
        let (seed, shifted, skill) = (self.seed(), self.options.shifted, self.player.skill);
        let own_table = self.own_table.clone();
        let Some(turn) = &mut self.turn else { return Vec::new() };
        let is_match = matches!(goal, Goal::Match { .. });
        // Both sides of a match play in the program.
        let venue = if is_match { Venue::Program } else { venue.unwrap_or(turn.latest_session().venue) };
        let mut session = turn.new_session(goal, shifted && !is_match, venue, skill, seed);
        session.table = own_table;
        turn.begin_session(session)
    }

    fn play(&mut self) -> Option<Effect> {
        let mut tasks = Vec::new();
        let newest = self.turn.as_ref()?.latest_session();
        if newest.venue == Venue::Table || newest.is_over() {
            // Strokes in the program and records from a real table belong to separate sessions.
            tasks = self.restart(Some(Venue::Program));
        }
        tasks.push(self.turn.as_mut()?.play());
        Some(Effect::Drill(tasks))
    }

    fn next(&mut self) -> Option<Effect> {
        let turn = self.turn.as_mut()?;
        let Stage::Watching(watched) = &mut turn.stage else { return None };
        if !watched.is_end_shown {
            // The first press jumps to the end, where the result is shown.
            watched.finish();
            return None;
        }
        let next = watched.outcome.next.clone();
        if self.has_other_player() {
            return tasks_effect(self.restart(None));
        }
        let turn = self.turn.as_mut()?;
        match next {
            Some((table, layout)) => turn.place_balls(table, layout).then(|| Effect::Drill(turn.request_model_shot())),
            None if turn.session.is_exam() => {
                let session = turn.session.clone();
                self.show_result(session);
                None
            }
            None => tasks_effect(self.restart(None)),
        }
    }

    fn apply_playback_key(&mut self, key: PlaybackKey) {
        let Some(watched) = self.turn.as_mut().and_then(Turn::watched_mut) else { return };
        let Some(shot) = watched.outcome.shot.clone() else { return };
        watched.playback.apply(key, shot.recording.events(), shot.recording.duration());
        watched.settle();
    }

    /// Records an attempt at a real table.
    fn log(&mut self, made: bool) -> Option<Effect> {
        let turn = self.turn.as_ref()?;
        let (newest, was_with_hint, layout) = (turn.latest_session(), turn.with_hint, turn.layout);
        let mut tasks = Vec::new();
        if newest.venue != Venue::Table || newest.is_over() {
            tasks = self.restart(Some(Venue::Table));
        }
        let turn = self.turn.as_mut()?;
        // A hint that was shown for these positions also counts in the new session.
        turn.with_hint |= was_with_hint && turn.layout == layout;
        let mut session = turn.latest_session().clone();
        match session.log(made) {
            Ok(()) => {
                // Not if the positions of this repetition have not been shown yet.
                let is_shown = |note: &&mut Attempt| note.layout.unwrap_or(turn.exercise.layout) == turn.layout;
                if let Some(note) = session.attempts.last_mut().filter(is_shown) {
                    note.helped = turn.with_hint;
                    // The advised shot is used for the skill estimate. It must be the exercise's own model shot or have been shown
                    // for this layout, so that the player can have known it.
                    let known =
                        |model_shot: &&ModelShot| (model_shot.is_own || turn.with_hint) && !turn.session.is_game();
                    let advice = turn.model_shot().filter(known).map(|model_shot| model_shot.advice);
                    note.advised = advice.map(|advice| advice.cue);
                    note.advised_chance = advice.map(|advice| advice.chance.rate);
                }
                tasks.insert(0, turn.save(session));
            }
            Err(error) => self.message = Some(Message::warning(error.to_string())),
        }
        Some(Effect::Drill(tasks))
    }

    fn undo(&mut self) -> Option<Effect> {
        let turn = self.turn.as_mut()?;
        let mut session = turn.latest_session().clone();
        session.undo();
        Some(Effect::Drill(vec![turn.save(session)]))
    }
}

/// The effect that runs these tasks; `None` if there are none.
pub(super) fn tasks_effect(tasks: Vec<DrillTask>) -> Option<Effect> {
    (!tasks.is_empty()).then_some(Effect::Drill(tasks))
}
