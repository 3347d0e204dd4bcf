//! Times within a step: when a law of its active set breaks, and when another event ends the step early.

use super::{MAX_GUESSES, Resting, State, Trial};
use crate::table::Table;

/// Ratio of the next trial step after an interruption to the interrupted step.
const GROWTH_AFTER_INTERRUPTION: f64 = 4.0;

/// Share of its initial speed below which the slip that scales time counts as ended: rescaled time would continue to infinity, but the
/// remaining time is below rounding.
const SPENT: f64 = 1e-9;

impl Resting {
    /// If a law of the active set is broken at the end of a step, shortens the step to just after the time of the break.
    pub(super) fn until_a_law_breaks(&self, table: &Table, begin: &Trial, whole: &Trial) -> Trial {
        if whole.forces.slack < -self.constants.tolerance.force_error {
            let shorter = self.until_margin_is_zero(table, begin, whole);
            if !self.shared || !self.satisfies_laws(table, &shorter) {
                return shorter;
            }
        }
        self.until_laws_break(table, begin, whole)
    }

    /// Finds the zero of the slack by false position (Illinois) and bisection; each iteration starts at the last state before the zero.
    fn until_margin_is_zero(&self, table: &Table, begin: &Trial, whole: &Trial) -> Trial {
        let allowed = self.constants.tolerance.force_error;
        let (mut before, mut after) = (*begin, *whole);
        let (mut low_value, mut high_value) = ((self.first.slack + allowed).max(0.0), after.forces.slack + allowed);
        let mut same_side = 0_i32;
        for _ in 0..MAX_GUESSES {
            if high_value >= -allowed || after.span - before.span <= self.constants.tolerance.shortest_step {
                break;
            }
            let secant = (low_value / (low_value - high_value)).clamp(0.01, 0.99);
            let share = if same_side.abs() > 2 { 0.5 } else { secant };
            let middle = self.step_to(table, &before, before.span + share * (after.span - before.span));
            let value = middle.forces.slack + allowed;
            if value < 0.0 {
                (after, high_value) = (middle, value);
                same_side = same_side.max(0) + 1;
                if same_side > 1 {
                    low_value *= 0.5;
                }
            } else {
                (before, low_value) = (middle, value);
                same_side = same_side.min(0) - 1;
                if same_side < -1 {
                    high_value *= 0.5;
                }
            }
        }
        after
    }

    /// As [`Self::until_margin_is_zero`] for over-constrained sets, whose end only a test of the laws can detect.
    fn until_laws_break(&self, table: &Table, begin: &Trial, whole: &Trial) -> Trial {
        let (mut before, mut after) = (*begin, *whole);
        while after.span - before.span > self.constants.tolerance.shortest_step.max(1e-9 * after.span) {
            let middle = self.step_to(table, &before, 0.5 * (before.span + after.span));
            if self.satisfies_laws(table, &middle) {
                before = middle;
            } else {
                after = middle;
            }
        }
        after
    }

    /// Returns the state `time` seconds after the start of the step, by shorter steps of the same method.
    pub fn after(&self, table: &Table, time: f64) -> State {
        if time >= self.step { self.end } else { self.without_rounding(table, self.until(table, time).step.end.balls) }
    }

    /// Ends the step `time` seconds after its start, before its end: its trajectory becomes that of the shorter step.
    pub fn shorten(&mut self, table: &Table, time: f64) {
        let trial = self.until(table, time);
        self.end_if_given_up();
        self.interrupted = true;
        (self.step, self.last) = (time, trial.forces);
        (self.end, self.keeps_set) = (self.without_rounding(table, trial.step.end.balls), false);
        if time > 0.0 {
            // The next step will probably be interrupted after a similar time.
            self.next_step = GROWTH_AFTER_INTERRUPTION * time;
        }
    }

    /// Returns the step that ends after `time` seconds.
    fn until(&self, table: &Table, time: f64) -> Trial {
        let mut trial = self.step_to(table, &self.initial_trial(), time);
        if self.time_scale.is_some() {
            // Newton iterations: the derivative of time is known.
            for _ in 0..MAX_GUESSES {
                let late = time - trial.step.end.time;
                if late.abs() <= 4.0 * f64::EPSILON * time {
                    break;
                }
                let rate = self.time_rate(&trial.step.end.balls);
                if rate < SPENT {
                    break;
                }
                trial = self.step_to(table, &trial, trial.span + late / rate);
            }
        }
        trial
    }
}
