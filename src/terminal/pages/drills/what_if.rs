//! "What if": comparing the player's stroke with the model shot from which it was copied.

use std::sync::{Arc, atomic::Ordering};

use crate::terminal::{
    DrillTask, RateStrokeTask,
    pages::drills::{ModelShotState, Turn, turn::NEXT_REQUEST},
    shot::{WhatIf, what_if},
};

impl Turn {
    /// The comparison with the model shot, while the player sets the stroke.
    pub fn what_if(&self) -> Option<&WhatIf> {
        self.what_if.as_ref().filter(|_| self.is_aiming())
    }

    /// Copies the model shot into the stroke and starts the comparison. The attempt counts as one with a hint.
    pub(super) fn copy_model_shot(&mut self) -> Vec<DrillTask> {
        let ModelShotState::Known(model_shot) = &self.model_shot else { return Vec::new() };
        let (cue, shot) = (model_shot.advice.cue, Arc::clone(&model_shot.shot));
        self.stroke.set(cue);
        self.what_if = Some(WhatIf::new(shot, self.situation()));
        (self.with_hint, self.shows_hint, self.text_page) = (true, false, 0);
        self.judge()
    }

    /// Updates the comparison with the current stroke, if there is one.
    pub(super) fn compare(&mut self) -> Vec<DrillTask> {
        let Some(mut what_if) = self.what_if.take() else { return Vec::new() };
        // A stroke that cannot be simulated cannot be compared. Playing it shows the reason.
        if what_if.strike(self.stroke(), self.situation()).is_err() {
            return Vec::new();
        }
        self.what_if = Some(what_if);
        self.judge()
    }

    /// Requests the success rate of the compared stroke.
    fn judge(&mut self) -> Vec<DrillTask> {
        let (table, layout, rule) = (self.table.clone(), self.layout, self.exercise.rule);
        let shooter = self.session.shooter();
        let Some(what_if) = &mut self.what_if else { return Vec::new() };
        let id = NEXT_REQUEST.fetch_add(1, Ordering::Relaxed);
        let (cue, cancel) = (what_if.shot.cue, what_if.request_rate(id));
        vec![DrillTask::RateStroke(Box::new(RateStrokeTask { id, table, layout, rule, shooter, cue, cancel }))]
    }

    const fn situation(&self) -> what_if::Situation<'_> {
        what_if::Situation { table: &self.table, layout: &self.layout, rule: self.exercise.rule }
    }
}
