//! The end of a step before its time: another event comes first.

use super::{MAX_GUESSES, Resting, State, Trial};
use crate::table::Table;

/// After an interruption a step is tried that is so many times as long as the one that was interrupted.
const GROWTH_AFTER_INTERRUPTION: f64 = 4.0;

/// At this share of its speed at the start the slip that scales time is spent: rescaled time goes on without end, and what is missing of
/// the time is less than what rounding leaves of it.
const SPENT: f64 = 1e-9;

impl Resting {
    /// State `time` seconds after the start of the step, by shorter steps of the same method.
    pub fn after(&self, table: &Table, time: f64) -> State {
        if time >= self.step { self.end } else { self.without_rounding(table, self.until(table, time).step.end.balls) }
    }

    /// Ends the step `time` seconds after its start: its course is that of the shorter step.
    pub fn cut(&mut self, table: &Table, time: f64) {
        if time >= self.step {
            return;
        }
        let trial = self.until(table, time);
        self.end_if_given_up();
        self.interrupted = true;
        (self.step, self.last) = (time, trial.forces);
        (self.end, self.goes_on) = (self.without_rounding(table, trial.step.end.balls), false);
        if time > 0.0 {
            // What comes next is likely to be interrupted as soon.
            self.next_step = GROWTH_AFTER_INTERRUPTION * time;
        }
    }

    /// The step that ends after `time` seconds.
    fn until(&self, table: &Table, time: f64) -> Trial {
        let mut trial = self.reach(table, &self.beginning(), time);
        if self.time_scale.is_some() {
            // Newton's steps: how fast time runs is known.
            for _ in 0..MAX_GUESSES {
                let late = time - trial.step.end.time;
                if late.abs() <= 4.0 * f64::EPSILON * time {
                    break;
                }
                let rate = self.time_rate(table.radius, &trial.step.end.balls);
                if rate < SPENT {
                    break;
                }
                trial = self.reach(table, &trial, trial.span + late / rate);
            }
        }
        trial
    }
}
