//! A stroke of the player's own, compared with the coach's if there is one: its outcome, its success rate and its differences.

use std::sync::{
    Arc,
    atomic::{AtomicBool, Ordering},
};

use crate::{
    coach::{Units, Verdict},
    game::Rule,
    physics::{CueInputs, raise_to_clear},
    simulation::ShotError,
    statistics::SuccessRate,
    table::{CueBall, Layout, Table},
    terminal::Shot,
};

/// The situation of both strokes.
#[derive(Clone, Copy, Debug)]
pub struct Situation<'a> {
    /// The table.
    pub table: &'a Table,
    /// Positions of the balls.
    pub layout: &'a Layout,
    /// What counts as a point.
    pub rule: Rule,
}

/// A stroke of the player's own, compared with the coach's if there is one.
#[derive(Debug)]
pub struct WhatIf {
    /// The coach's shot.
    pub coach: Option<Arc<Shot>>,
    /// The player's own shot.
    pub shot: Arc<Shot>,
    verdict: Verdict,
    has_room: bool,
    /// The player's success rate at it, once known.
    pub made: Option<SuccessRate>,
    /// Identifier of the open request for the success rate, if any.
    request: Option<u64>,
    cancel: Arc<AtomicBool>,
}

impl WhatIf {
    /// Starts with a copy of the coach's shot.
    pub fn new(coach: Arc<Shot>, situation: Situation) -> Self {
        let verdict = Verdict::of(situation.rule, situation.table, situation.layout, &coach.recording);
        let shot = Arc::clone(&coach);
        let (made, request, cancel) = (None, None, Arc::default());
        Self { coach: Some(coach), shot, verdict, has_room: true, made, request, cancel }
    }

    /// Starts with a stroke of the player's own. The cue is raised if rails or balls behind it need that.
    ///
    /// # Errors
    /// Any error of the simulator.
    pub fn without_coach(cue: &CueInputs, situation: Situation) -> Result<Self, ShotError> {
        let (shot, verdict, has_room) = struck(cue, situation)?;
        Ok(Self { coach: None, shot, verdict, has_room, made: None, request: None, cancel: Arc::default() })
    }

    /// Replaces the player's own stroke; its success rate is then unknown. The cue is raised if rails or balls behind it need that.
    ///
    /// # Errors
    /// Any error of the simulator; the old stroke then stays.
    pub fn strike(&mut self, cue: &CueInputs, situation: Situation) -> Result<(), ShotError> {
        (self.shot, self.verdict, self.has_room) = struck(cue, situation)?;
        self.made = None;
        self.cancel_request();
        Ok(())
    }

    /// Whether the player's own shot makes the point if played without errors.
    pub fn is_made(&self) -> bool {
        self.verdict.is_made()
    }

    /// Whether the success rate is being computed.
    pub const fn is_rate_pending(&self) -> bool {
        self.request.is_some()
    }

    /// Starts the request `id` for the success rate and cancels an earlier one. The returned flag is set when the answer is no longer
    /// needed.
    pub fn request_rate(&mut self, id: u64) -> Arc<AtomicBool> {
        self.cancel_request();
        self.request = Some(id);
        Arc::clone(&self.cancel)
    }

    /// Handles the answer to request `id`; late answers are dropped.
    pub fn set_rate(&mut self, id: u64, made: SuccessRate) {
        if self.request == Some(id) {
            (self.request, self.made) = (None, Some(made));
        }
    }

    fn cancel_request(&mut self) {
        self.cancel.store(true, Ordering::Relaxed);
        self.cancel = Arc::default();
        self.request = None;
    }

    /// Describes the outcome if the stroke is played exactly. The success rate, which may be shown next to it, is for strokes with errors.
    pub fn outcome(&self, cue_ball: CueBall, units: Units) -> String {
        self.verdict.words(cue_ball, units.length).replacen(": ", ", if played exactly: ", 1)
    }

    /// Describes how the stroke differs from that of the coach, called `advisor`, and whether the cue has no room; without a coach's
    /// stroke, describes the stroke. `coach_made` is the player's success rate at the coach's stroke, if known: a stroke with at least that
    /// rate is not called wrong, even if it misses when played exactly.
    pub fn difference(&self, advisor: &str, coach_made: Option<f64>, cue_ball: CueBall, units: Units) -> String {
        let Some(coach) = &self.coach else {
            let room = if self.has_room { "" } else { " No room for the cue." };
            return self.shot.words.sentence(cue_ball, units) + room;
        };
        let misses = !self.is_made() && coach.solved;
        let is_as_good = misses && self.made.zip(coach_made).is_some_and(|(own, made)| own.rate >= made);
        let parts = self.shot.words.differences(&coach.words, misses && !is_as_good, cue_ball, units);
        let room = match (self.has_room, is_as_good) {
            (false, _) => "; no room for the cue",
            (true, true) => "; you make it at least as often",
            (true, false) => "",
        };
        if parts.is_empty() {
            format!("You: as the {advisor}{room}")
        } else {
            format!("You: {}{room}", parts.join(", "))
        }
    }
}

/// Simulates a stroke of the player's own. Returns the shot, its verdict, and whether there is room for the cue.
fn struck(cue: &CueInputs, situation: Situation) -> Result<(Arc<Shot>, Verdict, bool), ShotError> {
    let raised = raise_to_clear(situation.table, situation.layout, cue);
    let shot = Shot::new(situation.table, situation.layout, raised.unwrap_or(*cue), false, "yours")?;
    let verdict = Verdict::of(situation.rule, situation.table, situation.layout, &shot.recording);
    Ok((Arc::new(Shot { solved: verdict.is_made(), ..shot }), verdict, raised.is_ok()))
}

impl Drop for WhatIf {
    fn drop(&mut self) {
        self.cancel_request();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn with(check: impl FnOnce(WhatIf, Situation)) {
        let table = Table::default();
        let layout = Layout::opening(&table);
        let situation = Situation { table: &table, layout: &layout, rule: Rule::StraightRail };
        let cue = CueInputs::parse("0.2,0.3,6,-8.8,2.5").unwrap();
        let coach = Shot::new(&table, &layout, cue, true, "search").unwrap();
        check(WhatIf::new(Arc::new(coach), situation), situation);
    }

    #[test]
    fn changing_a_copied_stroke_keeps_the_coachs_stroke() {
        with(|mut what_if, situation| {
            let units = Units::default();
            assert!(what_if.is_made() && Arc::ptr_eq(what_if.coach.as_ref().unwrap(), &what_if.shot));
            assert_eq!(what_if.difference("coach", None, CueBall::White, units), "You: as the coach");
            let coach = Arc::clone(what_if.coach.as_ref().unwrap());
            let softer = CueInputs { speed: 0.5, ..coach.cue };
            what_if.strike(&softer, situation).unwrap();
            assert!(!what_if.is_made() && what_if.coach.as_ref().unwrap().cue == coach.cue);
            assert_eq!(what_if.shot.cue.speed, 0.5);
            assert!(what_if.outcome(CueBall::White, units).starts_with("No point, if played exactly: "));
            let told = what_if.difference("coach", None, CueBall::White, units);
            assert!(told.starts_with("You: ") && told.contains("softer by "), "{told}");
            // With the player's errors it may be as good, even if it misses when played exactly.
            what_if.made = Some(SuccessRate::new(90, 100));
            let as_good = what_if.difference("coach", Some(0.5), CueBall::White, units);
            assert!(as_good.ends_with("; you make it at least as often"), "{as_good}");
            assert_eq!(what_if.difference("coach", Some(0.95), CueBall::White, units), told);
        });
    }

    #[test]
    fn late_answers_are_dropped_and_each_change_clears_the_rate() {
        with(|mut what_if, situation| {
            let rate = |made| SuccessRate::new(made, 100);
            let first = what_if.request_rate(7);
            what_if.set_rate(6, rate(1));
            assert!(what_if.made.is_none() && what_if.is_rate_pending());
            what_if.strike(&CueInputs { speed: 2.6, ..what_if.shot.cue }, situation).unwrap();
            assert!(first.load(Ordering::Relaxed) && !what_if.is_rate_pending());
            let second = what_if.request_rate(8);
            what_if.set_rate(7, rate(1));
            assert_eq!(what_if.made, None);
            what_if.set_rate(8, rate(90));
            assert_eq!(what_if.made, Some(rate(90)));
            assert!(!second.load(Ordering::Relaxed));
            drop(what_if);
            assert!(second.load(Ordering::Relaxed));
        });
    }
}
