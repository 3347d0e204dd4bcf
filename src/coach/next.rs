//! What comes next: where the balls may come to rest, and how easy the next point is from there.

use std::ops::ControlFlow;

use super::{
    Ease,
    draws::{Draw, Draws},
    trial::Task,
};
use crate::{
    game::Tally,
    physics::{CueInputs, strike},
    simulation::{Event, Observer, StepBudget, simulate},
    table::{BALLS, Layout},
};

/// Fewest made attempts that tell how easy the next point is, and as many as tell it to three in a hundred.
pub const FEWEST_POINTS: usize = 8;
pub const MOST_POINTS: usize = 64;

/// Most attempts that are followed, for each that is to make the point: what a beginner plays is made rarely.
const ATTEMPTS_EACH: usize = 12;

/// The probability of the next point after a shot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NextValue {
    /// An estimate, from where the shot leaves the balls.
    Known(f64),
    /// Nobody has looked; it counts as this until somebody does.
    Supposed(f64),
}

impl NextValue {
    /// What it counts as.
    pub const fn value(self) -> f64 {
        match self {
            Self::Known(value) | Self::Supposed(value) => value,
        }
    }

    /// The estimate, where there is one.
    pub const fn known(self) -> Option<f64> {
        match self {
            Self::Known(value) => Some(value),
            Self::Supposed(_) => None,
        }
    }
}

/// The mean probability of the next point over the layouts that `cue` leaves in the first so many of these attempts that make a point.
/// `None` where none does, or time ran out.
pub fn next_value(task: &Task, cue: &CueInputs, draws: &Draws, points: usize) -> Option<f64> {
    let (mut sum, mut made) = (0.0, 0);
    for draw in draws.range(0, ATTEMPTS_EACH * points) {
        if made == points {
            break;
        }
        if task.clock.is_past(task.until) {
            return None;
        }
        task.clock.count(1);
        if let Some(end) = end_of(task, cue, draw) {
            sum += Ease::under(task.rule).probability(task.table, &end, task.skill);
            made += 1;
        }
    }
    // The last attempt may have been broken off.
    (made > 0 && !task.clock.is_past(task.until)).then(|| sum / made as f64)
}

/// Where an attempt at `cue` leaves the balls if it makes the point.
pub fn end_of(task: &Task, cue: &CueInputs, draw: Draw) -> Option<Layout> {
    let (stroke, table, layout) = task.stroke(cue, draw);
    if stroke.is_miscue(table) {
        return None;
    }
    let impulse = strike(table, &stroke);
    let tally = task.tally(layout, &impulse);
    let mut whole = Whole { tally, patience: StepBudget(task.patience), task, given_up: false };
    let end = simulate(table, layout, &impulse, &mut whole);
    (task.point().is_made(&whole.tally) && !whole.given_up).then(|| end.layout(table))
}

/// Watches a shot to its end, or until it takes too long.
struct Whole<'a> {
    tally: Tally,
    patience: StepBudget,
    task: &'a Task<'a>,
    given_up: bool,
}

impl Observer for Whole<'_> {
    /// Where a shot ends counts only if it makes the point.
    fn awaited(&self) -> Option<[bool; BALLS - 1]> {
        (!self.tally.met_both()).then(|| self.tally.unmet())
    }

    fn event(&mut self, event: Event) -> ControlFlow<()> {
        self.tally.note(&event);
        ControlFlow::Continue(())
    }

    fn contact_step(&mut self) -> ControlFlow<()> {
        let flow = if self.task.clock.is_past(self.task.until) { ControlFlow::Break(()) } else { self.patience.step() };
        self.given_up |= flow.is_break();
        flow
    }
}
