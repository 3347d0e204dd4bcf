//! "What if": the player's own stroke, which keys change. It starts as a copy of the coach's shot, or aimed full at a ball if there is
//! no shot. The coach's shot itself stays unchanged.

use std::sync::Arc;

use crate::{
    coach::layout_number,
    game::Point,
    table::{Layout, Table},
    terminal::{
        CoachJob, CoachQuery, Effect,
        pages::{
            Page,
            coach::{CoachPage, question::Question},
        },
        shot::{OwnStroke, StrokeChange, WhatIf, aiming, stroke::MAX_TEXT_LENGTH, what_if::Situation},
        ui::TextField,
    },
};

/// Number of simulated attempts at the player's own stroke if there is no judged shot of the coach, and at the best shot of a search that was
/// stopped.
pub(super) const DEFAULT_TRIALS: usize = 500;

/// Minimum number of simulated attempts if the coach's shot was judged.
const MIN_TRIALS: usize = 100;

/// The player's own stroke, next to the coach's if there is one.
#[derive(Debug)]
pub struct OwnStrokeState {
    stroke: OwnStroke,
    pub(super) what_if: WhatIf,
    /// The table, layout and query to which the stroke belongs.
    context: (Arc<Table>, Layout, CoachQuery),
    /// The player's own strokes that were played one after the other to reach this layout.
    played: Vec<OwnStroke>,
}

impl CoachPage {
    /// The player's own stroke; `None` if the layout, the query or the coach's displayed shot has changed since it was set.
    pub fn what_if(&self) -> Option<&WhatIf> {
        let OwnStrokeState { what_if, context: (table, layout, query), .. } =
            self.own_stroke.as_ref().filter(|_| self.pending.is_none())?;
        let shown = self.proposal().map(|proposal| Arc::as_ptr(&proposal.shot));
        let is_same_position = Arc::ptr_eq(table, &self.history.present().table) && layout == self.layout();
        let is_same_proposal = what_if.coach.as_ref().map(Arc::as_ptr) == shown && *query == self.query;
        (is_same_position && is_same_proposal).then_some(what_if)
    }

    /// Whether a change of the stroke can be undone, and whether one can be redone.
    pub(super) fn can_undo_redo_stroke(&self) -> (bool, bool) {
        self.own_stroke.as_ref().map_or((false, false), |own| own.stroke.can_undo_redo())
    }

    /// Starts the player's own stroke from the coach's shot, or aimed full at a ball if there is none; `played` are the own strokes that
    /// led to this layout.
    pub(super) fn start_own_stroke(&mut self, played: Vec<OwnStroke>) -> Option<Effect> {
        let situation = self.situation();
        let (cue, what_if) = if let Some(coach) = self.proposal().map(|proposal| Arc::clone(&proposal.shot)) {
            (coach.cue, Ok(WhatIf::new(coach, situation)))
        } else {
            let first =
                aiming::first_stroke(Point::of(situation.rule, situation.table, situation.layout), situation.layout);
            (first, WhatIf::without_coach(&first, situation))
        };
        match what_if {
            Ok(what_if) => {
                let context = (Arc::clone(&self.history.present().table), *self.layout(), self.query.clone());
                self.own_stroke = Some(OwnStrokeState { stroke: OwnStroke::new(cue), what_if, context, played });
            }
            Err(error) => return self.refuse(error),
        }
        self.lesson = None;
        self.watch_from_start();
        self.request_success_rate()
    }

    /// Number of the player's own strokes that led to the current layout.
    pub(super) fn own_strokes_played(&self) -> usize {
        self.own_stroke.as_ref().map_or(0, |own| own.played.len())
    }

    /// Continues with the layout after the player's own stroke and starts the next stroke.
    pub(super) fn play_next_own_stroke(&mut self) -> Option<Effect> {
        let end = self.what_if()?.shot.recording.final_layout();
        if let Err(error) = end.validate(self.table()) {
            return self.refuse(error);
        }
        let OwnStrokeState { stroke, mut played, .. } = self.own_stroke.take()?;
        played.push(stroke);
        self.set_layout(end);
        self.start_own_stroke(played)
    }

    /// Puts the balls back to the positions before the player's last own stroke, with that stroke.
    pub(super) fn undo_own_stroke(&mut self) -> Option<Effect> {
        let mut played = std::mem::take(&mut self.own_stroke.as_mut()?.played);
        let stroke = played.pop()?;
        self.undo();
        self.start_own_stroke(played);
        self.simulate_stroke(stroke)
    }

    /// Discards the player's own stroke; the coach's shot stays unchanged.
    pub(super) fn leave_own_stroke(&mut self) {
        self.own_stroke = None;
        if self.proposal().is_some() {
            self.watch_from_start();
        } else {
            self.reset_playback();
        }
    }

    /// Changes the player's own stroke.
    pub(super) fn change_stroke(&mut self, change: StrokeChange) -> Option<Effect> {
        let mut stroke = self.own_stroke.as_ref()?.stroke.clone();
        match stroke.change(change, self.table(), self.layout()) {
            Ok(()) => self.simulate_stroke(stroke),
            Err(error) => self.refuse(error),
        }
    }

    /// Asks for the player's own stroke in words.
    pub(super) fn ask_stroke(&mut self) {
        self.playback.pause();
        self.question = Some(Question::Stroke(TextField::new(MAX_TEXT_LENGTH)));
    }

    /// Sets the player's own stroke from its description in words.
    ///
    /// # Errors
    /// Returns a message if the words do not describe a possible stroke.
    pub(super) fn set_stroke_in_words(&mut self, words: &str) -> Result<Option<Effect>, String> {
        let Some(own) = &self.own_stroke else { return Ok(None) };
        let mut stroke = own.stroke.clone();
        stroke.apply_text(words, self.table(), self.layout(), self.cue_ball()).map_err(|error| error.to_string())?;
        Ok(self.simulate_stroke(stroke))
    }

    /// Undoes or redoes a change of the player's own stroke, as `step` does.
    pub(super) fn step_stroke_history(&mut self, step: impl Fn(&mut OwnStroke) -> bool) -> Option<Effect> {
        let mut stroke = self.own_stroke.as_ref()?.stroke.clone();
        step(&mut stroke);
        self.simulate_stroke(stroke)
    }

    fn simulate_stroke(&mut self, stroke: OwnStroke) -> Option<Effect> {
        let mut own = self.own_stroke.take()?;
        let struck = own.what_if.strike(stroke.cue(), self.situation());
        if struck.is_ok() {
            own.stroke = stroke;
        }
        self.own_stroke = Some(own);
        if let Err(error) = struck {
            return self.refuse(error);
        }
        self.watch_from_start();
        self.request_success_rate()
    }

    /// Requests the success rate of the player's current stroke. The simulated errors are those with which the coach's shot was
    /// judged (common random numbers), or those of the layout if there is none, so that two strokes differ by themselves and not by luck. A
    /// player without errors needs no request.
    fn request_success_rate(&mut self) -> Option<Effect> {
        if self.query.skill.is_perfect() {
            return None;
        }
        let cue = self.own_stroke.as_ref()?.what_if.shot.cue;
        let judged = self.proposal().filter(|coach| !coach.is_early).and_then(|coach| coach.made);
        let attempts = judged.map_or(DEFAULT_TRIALS, |made| made.trials.max(MIN_TRIALS));
        let advised = self.current_advice().map(|advised| (advised.seed, advised.judged_from()));
        let job = self.new_job(None);
        let (seed, from) = advised.unwrap_or_else(|| (layout_number(&job.layout).into(), 0));
        let cancel = self.own_stroke.as_mut()?.what_if.request_rate(job.id);
        Some(Effect::AskCoach(Box::new(CoachJob { stroke: Some((cue, from..from + attempts)), seed, cancel, ..job })))
    }

    fn situation(&self) -> Situation<'_> {
        Situation { table: self.table(), layout: self.layout(), rule: self.query.rule }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        physics::CueInputs,
        statistics::SuccessRate,
        table::{Layout, Table},
        terminal::{Advice, CoachAction as Action, CoachAnswer, CoachEvent, Proposal, Shot, shot::PlaybackKey},
    };
    use std::sync::atomic::Ordering;

    /// Returns a page with the opening position and the coach's shot on it.
    fn page_with_advice() -> CoachPage {
        let table = Table::default();
        let layout = Layout::opening(&table);
        let mut page = CoachPage::new(table.clone(), layout, 1).unwrap();
        let Some(Effect::AskCoach(job)) = page.update(Action::Recommend) else { panic!("the coach is asked") };
        let cue = CueInputs::parse("0.2,0.3,6,-72,2.5").unwrap();
        let shot = Arc::new(Shot::new(&table, &layout, cue, true, "search").unwrap());
        let made = Some(SuccessRate::new(890, 1000));
        let best = Proposal { shot, made, risk: None, next: None, is_early: false };
        let advice = Advice { proposals: vec![best], seed: 1, effort: None, found: None };
        assert!(page.receive(CoachAnswer { id: job.id, event: CoachEvent::Advice(advice) }).is_some(), "it is studied");
        page
    }

    /// Performs an action and returns the job about the own stroke that it requests.
    fn own_stroke_job(page: &mut CoachPage, action: Action) -> Box<CoachJob> {
        match page.update(action) {
            Some(Effect::AskCoach(job)) if job.stroke.is_some() => job,
            other => panic!("{action:?}: {other:?}"),
        }
    }

    const HARDER: Action = Action::ChangeStroke(StrokeChange::Faster(0.1));

    #[test]
    fn stroke_change_requests_one_success_rate_and_drops_late_answers() {
        let mut page = page_with_advice();
        let first = own_stroke_job(&mut page, Action::WhatIf);
        let (cue, attempts) = first.stroke.clone().unwrap();
        assert_eq!((Some(cue), attempts), (page.shot().map(|shot| shot.cue), 0..1000));
        let second = own_stroke_job(&mut page, HARDER);
        assert!(first.cancel.load(Ordering::Relaxed) && !second.cancel.load(Ordering::Relaxed));
        assert!((second.stroke.as_ref().unwrap().0.speed - 2.6).abs() < 1e-9);
        let tell = |page: &mut CoachPage, id: u64, made| {
            assert!(
                page.receive(CoachAnswer { id, event: CoachEvent::StrokeRated(SuccessRate::new(made, 100)) }).is_none()
            );
            page.what_if().unwrap().made.map(|rate| rate.rate)
        };
        assert_eq!(tell(&mut page, first.id, 10), None);
        assert_eq!(tell(&mut page, second.id, 70), Some(0.7));
        assert!(page.update(Action::Playback(PlaybackKey::Toggle)).is_none(), "playing asks nothing");
        assert!(page.playback.playing && page.shot().unwrap().cue.speed > 2.55, "the player's own is played");
    }

    #[test]
    fn leaving_own_stroke_restores_and_analyses_the_coachs_shot() {
        let mut page = page_with_advice();
        let coach = Arc::clone(page.shot().unwrap());
        own_stroke_job(&mut page, Action::WhatIf);
        own_stroke_job(&mut page, HARDER);
        own_stroke_job(&mut page, HARDER);
        own_stroke_job(&mut page, Action::UndoStroke);
        assert_eq!(page.shot().unwrap().cue, coach.cue, "one input changed twice is one step back");
        assert_eq!(page.can_undo_redo_stroke(), (false, true));
        own_stroke_job(&mut page, Action::RedoStroke);
        let Some(Effect::AskCoach(study)) = page.update(Action::LeaveStroke) else { panic!("the study goes on") };
        assert_eq!((study.shot, study.stroke), (Some(coach.cue), None));
        assert!(page.what_if().is_none() && Arc::ptr_eq(page.shot().unwrap(), &coach));
    }

    /// Regression test: without the coach's shot, the errors differed from request to request, and so did the rate of the same stroke.
    #[test]
    fn strokes_without_a_coachs_shot_are_rated_by_the_same_errors() {
        let table = Table::default();
        let mut page = CoachPage::new(table.clone(), Layout::opening(&table), 1).unwrap();
        let jobs = [Action::WhatIf, HARDER, Action::UndoStroke].map(|action| own_stroke_job(&mut page, action));
        assert!(jobs.iter().all(|job| job.seed == jobs[0].seed) && jobs[0].stroke == jobs[2].stroke);
    }

    #[test]
    fn own_stroke_is_discarded_when_its_shot_is_hidden() {
        let mut page = page_with_advice();
        own_stroke_job(&mut page, Action::WhatIf);
        page.set_skill(crate::coach::Skill::CLUB);
        assert!(page.what_if().is_none() && page.shot().is_none());
        page.update(Action::NextInfoPanel);
        assert!(page.own_stroke.is_none());
    }
}
