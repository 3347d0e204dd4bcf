//! Implementation of the coach page's key actions: how each action changes the state of the page.

use std::sync::Arc;

use glam::DVec2;

use crate::{
    coach::{FirstContact, words::no_jump_words},
    game::{Point, Rule},
    table::{BALLS, CueBall, Layout, Opening, Side},
    terminal::{
        CoachAction as Action, CoachCondition, CoachQuery, Effect, InfoPanel, Mode, Terms,
        pages::{
            coach::{CoachPage, Snapshot},
            neighbour, next_skill,
        },
        shot::{
            OwnStroke, PlaybackKey, Profile,
            placing::{self, STEPS},
        },
        ui::Message,
    },
};

impl CoachPage {
    /// Returns the reason why a key binding is disabled now; `None` if it is enabled.
    pub fn disabled_reason(&self, when: CoachCondition) -> Option<&'static str> {
        let refuse = |refused: bool, reason| refused.then_some(reason);
        let thinking = refuse(self.pending.is_some(), "the coach is thinking; Esc stops it");
        match when {
            CoachCondition::Always => None,
            CoachCondition::HasPlayerName => {
                refuse(self.player.is_none(), "start carom --player NAME so that others can follow")
            }
            CoachCondition::Thinking => refuse(self.pending.is_none(), "the coach is not thinking"),
            _ if thinking.is_some() => thinking,
            CoachCondition::Placing => {
                refuse(self.mode != Mode::Placing, "a shot is being watched; Esc goes back to the balls")
            }
            CoachCondition::Shot | CoachCondition::Watching if self.shot().is_none() => {
                Some("there is no shot yet; Enter asks the coach")
            }
            CoachCondition::Idle | CoachCondition::Shot => None,
            CoachCondition::Watching => {
                refuse(self.mode != Mode::Watching, "no shot is being watched; Space plays one")
            }
            CoachCondition::SeveralShots => refuse(
                self.current_advice().is_none_or(|advised| advised.choices.len() < 2),
                "there is no other shot to choose",
            ),
            CoachCondition::Undoable => refuse(!self.history.can_undo(), "there is nothing to undo"),
            CoachCondition::Resumable => refuse(
                self.earlier_sessions.is_empty() && self.unfinished_exams.is_empty(),
                "no unfinished exam or earlier session; F3 shows the drills, F9 a match",
            ),
            CoachCondition::CustomPolicy => {
                refuse(self.query.policy.is_none(), "the bundled networks are asked already")
            }
            CoachCondition::StrokeUndoable => refuse(!self.can_undo_redo_stroke().0, "the stroke is unchanged"),
            CoachCondition::OwnStrokePlayed => refuse(self.own_strokes_played() == 0, "the stroke is unchanged"),
            CoachCondition::StrokeRedoable => refuse(!self.can_undo_redo_stroke().1, "no change of the stroke to redo"),
            CoachCondition::Redoable => refuse(!self.history.can_redo(), "there is nothing to redo"),
        }
    }

    /// Performs the action of an enabled key binding.
    pub fn update(&mut self, action: Action) -> Option<Effect> {
        self.end_drag();
        let effect = self.act(action);
        self.refresh();
        // The action may have changed the displayed shot: the background analysis must follow it.
        let study = self.study();
        effect.or(study)
    }

    fn act(&mut self, action: Action) -> Option<Effect> {
        let terms = self.query.terms();
        match action {
            // The number keys select balls by colour, not by role.
            Action::SelectBall(ball) => self.select(self.cue_ball().to_ball_order([0, 1, 2])[ball]),
            Action::CycleBall(balls) => self.select((self.selected + BALLS).saturating_add_signed(balls) % BALLS),
            Action::MoveBall(x, y, scale) => self.move_ball(DVec2::new(f64::from(x), f64::from(y)), scale),
            Action::ChangeStepSize(steps) => self.choose_step(self.step.saturating_add_signed(steps)),
            Action::ToggleQuarters => {
                self.quarters = !self.quarters;
                self.report_step();
            }
            Action::TypePositions => self.ask_positions(),
            Action::NextSystem => self.next_lesson(),
            Action::OpeningPosition => self.place_opening(),
            Action::SwapCueBall => self.swap_cue_ball(),
            Action::RandomPosition => {
                let layout = Layout::random(&self.history.present().table, &mut self.rng);
                self.set_layout(layout);
            }
            Action::Undo if self.what_if().is_some() => return self.undo_own_stroke(),
            Action::Undo => self.undo(),
            Action::Redo => self.redo(),
            Action::Recommend => return Some(self.request_advice()),
            Action::SavePosition => self.ask_title(),
            Action::Answer(true) => return self.accept_answer(),
            Action::Answer(false) => self.question = None,
            Action::Cancel => self.cancel(),
            Action::PlaceBalls => self.place_balls(),
            Action::Continue if self.what_if().is_some() => return self.play_next_own_stroke(),
            Action::Continue => return self.continue_from_end(),
            Action::NextRule => self.choose_terms(Terms { rule: neighbour(&Rule::ALL, terms.rule, 1), ..terms }),
            Action::NextSkill => {
                let skill = next_skill(terms.skill, self.own_skill, self.settings_terms.skill);
                self.choose_terms(Terms { skill, ..terms });
            }
            Action::TogglePlan => self.choose_terms(Terms { plan: !terms.plan, ..terms }),
            Action::NextFirstContact => {
                self.choose_terms(Terms { first: neighbour(&FirstContact::ALL, terms.first, 1), ..terms });
            }
            Action::ToggleNumbers => self.is_in_numbers = !self.is_in_numbers,
            Action::ToggleAllEvents => {
                self.has_all_events = !self.has_all_events;
                let words = if self.has_all_events { "all events are listed" } else { "contacts only are listed" };
                self.message = Some(Message::plain(words));
            }
            Action::ToggleSideView => self.toggle_side_view(),
            Action::ToggleSharing => self.toggle_sharing(),
            Action::NextInfoPanel if self.shot().is_none() && self.pending.is_none() => {
                self.message =
                    Some(Message::plain("without a shot the panel shows the ball positions; Enter asks the coach"));
            }
            Action::NextInfoPanel => self.info = neighbour(&InfoPanel::ALL, self.info, 1),
            Action::CycleShot(shots) => self.choose_shot(|advised| advised.cycle(shots)),
            Action::ShowShot(shot) => self.choose_shot(|advised| advised.show_shot(shot)),
            Action::WhatIf => return self.start_own_stroke(Vec::new()),
            Action::LeaveStroke => self.leave_own_stroke(),
            Action::ChangeStroke(change) => return self.change_stroke(change),
            Action::TypeStroke => self.ask_stroke(),
            Action::UndoStroke => return self.step_stroke_history(OwnStroke::undo),
            Action::RedoStroke => return self.step_stroke_history(OwnStroke::redo),
            Action::UseBundledPolicies => {
                let (table, rule) = self.table_and_rule_without_policy();
                self.set_query(&table, CoachQuery { policy: None, rule, ..self.query.clone() });
            }
            Action::Playback(key) => self.apply_playback_key(key),
            // The app opens the other page, or resumes the session.
            Action::OpenDrills | Action::OpenFilms | Action::OpenTraining | Action::Resume => {}
        }
        None
    }

    /// Gives the turn to the opponent: the other ball becomes the cue ball, and all balls keep their positions.
    fn swap_cue_ball(&mut self) {
        let cue_ball = self.cue_ball().other();
        let layout = self.layout().for_the_opponent();
        self.selected = CueBall::Yellow.to_ball_order([0, 1, 2])[self.selected];
        self.set_layout(layout);
        self.history.present_mut().cue_ball = cue_ball;
        self.message = Some(Message::plain(format!("{cue_ball} is the cue ball now; Enter asks the coach")));
    }

    /// Puts the balls in the opening position. If they are there already, moves the cue ball to the other side of the opponent's ball.
    fn place_opening(&mut self) {
        let side = self.layout().opening_side(self.table()).map_or(Side::Left, Side::other);
        let layout = Layout::opening_on(self.table(), side);
        let rule = self.query.rule;
        self.set_layout(layout);
        if self.table().opening == Opening::Umb {
            let red = if Point::of(rule, self.table(), &layout).red_first { "; red must be hit first" } else { "" };
            let (here, there) = (side.name(), side.other().name());
            self.message = Some(Message::plain(format!("the cue ball on the {here}, again for the {there}{red}")));
        }
    }

    fn apply_playback_key(&mut self, key: PlaybackKey) {
        let Some(shot) = self.shot().cloned() else { return };
        self.leave_example();
        self.mode = Mode::Watching;
        self.playback.apply(key, &self.events(&shot), shot.recording.duration());
    }

    fn select(&mut self, ball: usize) {
        self.selected = ball;
        self.place_balls();
    }

    /// Returns to placing balls: pauses the shot and discards the player's own stroke.
    fn place_balls(&mut self) {
        self.leave_example();
        self.own_stroke = None;
        self.playback.pause();
        self.mode = Mode::Placing;
    }

    /// The height profile of the shot's jump; `None` if the side view is off or no ball jumps.
    pub fn profile(&self) -> Option<&Profile> {
        self.shot().filter(|_| self.has_side_view)?.profile(self.table())
    }

    /// Turns the side view of the jump on or off. If no ball jumps, shows a message instead.
    fn toggle_side_view(&mut self) {
        self.has_side_view = !self.has_side_view;
        if self.has_side_view && self.profile().is_none() {
            self.has_side_view = false;
            self.message = Some(Message::plain(no_jump_words(self.table())));
        }
    }

    fn choose_step(&mut self, step: usize) {
        self.step = step.min(STEPS.len() - 1);
        self.quarters = false;
        self.report_step();
    }

    fn report_step(&mut self) {
        self.message = Some(Message::plain(format!("one step is {}", self.step_words())));
    }

    fn move_ball(&mut self, direction: DVec2, scale: f64) {
        let step = if self.quarters {
            placing::quarter_diamonds(self.table(), self.layout().balls[self.selected], direction * scale)
        } else {
            direction * (0.001 * self.step_mm() * scale)
        };
        let slide = placing::slide(self.table(), self.layout(), self.selected, step);
        if slide.layout != *self.layout() {
            self.set_layout(slide.layout);
        }
        let names = self.cue_ball().names();
        if let Some(place) = slide.stop_message(self.selected, names) {
            self.message = Some(Message::warning(format!("{} stops {place}", names[self.selected])));
        }
    }

    /// Puts the balls in new positions, as an undoable step. The shot disappears because it belongs to the old positions.
    pub(super) fn set_layout(&mut self, layout: Layout) {
        self.end_drag();
        self.history.push(self.snapshot(layout));
        self.reset_playback();
    }

    /// Returns a snapshot with the same table, policy and cue ball, a new layout and no advice.
    pub(super) fn snapshot(&self, layout: Layout) -> Snapshot {
        let Snapshot { table, policy, cue_ball, .. } = self.history.present();
        Snapshot { policy: policy.clone(), cue_ball: *cue_ball, ..Snapshot::new(Arc::clone(table), layout) }
    }

    pub(super) fn undo(&mut self) {
        let left = self.history.present().clone();
        self.history.undo();
        let terms = left.terms.map(|[before, after]| [after, before]);
        self.restore_after_history_step(left, terms);
    }

    fn redo(&mut self) {
        let left = self.history.present().clone();
        self.history.redo();
        self.restore_after_history_step(left, self.history.present().terms);
    }

    /// Updates the state after an undo or redo. The step changes the query from the first terms to the second. Terms that the user
    /// has chosen since then are kept.
    fn restore_after_history_step(&mut self, left: Snapshot, terms: Option<[Terms; 2]>) {
        let present = self.history.present_mut();
        if (&left.table, left.layout, left.cue_ball) == (&present.table, present.layout, present.cue_ball) {
            // The balls have not moved, so the advice on them is still valid.
            present.advised = left.advised;
        }
        if left.cue_ball != present.cue_ball {
            self.selected = CueBall::Yellow.to_ball_order([0, 1, 2])[self.selected];
        }
        self.query.policy.clone_from(&present.policy);
        let before = self.query.terms();
        if let Some(change) = terms {
            self.query = self.query.with(before.with_change(change));
        }
        self.reset_playback();
        let table = (left.table != self.history.present().table).then(|| format!("the table is {}", self.table().name));
        self.report_terms(before, false);
        if let Some(table) = table {
            self.message = Some(match self.message.take() {
                Some(terms) => Message { text: format!("{table}; {}", terms.text), ..terms },
                None => Message::plain(format!("{table} now")),
            });
        }
    }

    /// Resets mode and playback after the displayed shot has changed or disappeared.
    pub(super) fn reset_playback(&mut self) {
        self.mode = Mode::Placing;
        self.playback.seek(0.0);
        self.refresh();
    }

    /// Brings everything that depends on the displayed shot up to date.
    fn refresh(&mut self) {
        // Drop the player's own stroke if it belongs to another layout, query or shot.
        if self.what_if().is_none() {
            self.own_stroke = None;
        }
        self.refresh_lesson();
    }
}
