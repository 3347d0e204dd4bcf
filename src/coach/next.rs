//! The next shot: possible resting positions of the balls, and how easy the next point is from there.

use std::ops::ControlFlow;

use super::{LayoutDifficulty, draws::Draw, trial::Task};
use crate::{
    game::Tally,
    physics::{CueInputs, strike},
    simulation::{Event, Observer, StepBudget, simulate},
    table::{BALLS, Layout},
};

/// Minimum successful attempts for an estimate of the next point, and the number that makes it precise to three percent.
pub const MIN_POINTS: usize = 8;
pub const MAX_POINTS: usize = 64;

/// Maximum attempts that are simulated per successful one: a beginner makes few.
const ATTEMPTS_PER_POINT: usize = 12;

/// Steps of resting contacts after the point, relative to those before it: balls that stay together press each other longer, and these ends
/// are the easiest next shots.
const STEPS_AFTER_POINT: u32 = 10;

/// The probability of the next point after a shot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NextValue {
    /// An estimate, from where the shot leaves the balls.
    Known(f64),
    /// A placeholder until the value is estimated.
    Assumed(f64),
}

impl NextValue {
    /// Returns the value to count with.
    pub const fn value(self) -> f64 {
        match self {
            Self::Known(value) | Self::Assumed(value) => value,
        }
    }

    /// Returns the estimate, if there is one.
    pub const fn known(self) -> Option<f64> {
        match self {
            Self::Known(value) => Some(value),
            Self::Assumed(_) => None,
        }
    }
}

/// Estimates the mean probability of the next point over the layouts that `cue` leaves, from the first `points` of
/// these attempts that make the point. `None` if no attempt does, or time ran out.
pub fn next_value<'d>(
    task: &Task,
    cue: &CueInputs,
    draws: impl Iterator<Item = Draw<'d>>,
    points: usize,
) -> Option<f64> {
    let (mut sum, mut made) = (0.0, 0);
    for draw in draws.take(ATTEMPTS_PER_POINT * points) {
        if made == points {
            break;
        }
        if task.clock.is_past(task.deadline) {
            return None;
        }
        task.clock.count(1);
        if let Some(end) = final_layout(task, cue, draw) {
            sum += LayoutDifficulty::for_rule(task.rule).probability(task.table, &end, task.skill);
            made += 1;
        }
    }
    // The last attempt may have been aborted.
    (made > 0 && !task.clock.is_past(task.deadline)).then(|| sum / made as f64)
}

/// Returns the layout that an attempt at `cue` leaves if it makes the point.
pub fn final_layout(task: &Task, cue: &CueInputs, draw: Draw) -> Option<Layout> {
    let (stroke, table, layout) = task.stroke(cue, draw);
    if stroke.is_miscue(table) {
        return None;
    }
    let impulse = strike(table, &stroke);
    let tally = task.tally(layout, &impulse);
    let budgets = [1, STEPS_AFTER_POINT].map(|factor| StepBudget(task.max_contact_steps.saturating_mul(factor)));
    let mut observer = FullShot { tally, budgets, task, given_up: false };
    let end = simulate(table, layout, &impulse, &mut observer);
    (task.point().is_made(&observer.tally) && !observer.given_up).then(|| end.layout(table))
}

/// Observes a shot to its end, or until it takes too long.
struct FullShot<'a> {
    tally: Tally,
    /// Before and after the cue ball has hit both object balls.
    budgets: [StepBudget; 2],
    task: &'a Task<'a>,
    given_up: bool,
}

impl Observer for FullShot<'_> {
    /// The final layout counts only if the shot makes the point.
    fn awaited(&self) -> Option<[bool; BALLS - 1]> {
        (!self.tally.has_hit_both()).then(|| self.tally.not_hit())
    }

    fn event(&mut self, event: Event) -> ControlFlow<()> {
        self.tally.count(&event);
        // The ball that is hit second decides.
        if self.tally.has_hit_both() && !self.task.point().is_made(&self.tally) {
            return ControlFlow::Break(());
        }
        ControlFlow::Continue(())
    }

    fn contact_step(&mut self) -> ControlFlow<()> {
        let budget = &mut self.budgets[usize::from(self.tally.has_hit_both())];
        let flow = if self.task.clock.is_past(self.task.deadline) { ControlFlow::Break(()) } else { budget.step() };
        self.given_up |= flow.is_break();
        flow
    }
}
