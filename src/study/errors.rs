//! Errors of a method on one shot, separated by kind.

use super::{methods::Run, truth::Truth};
use crate::{
    game::{Rule, Tally},
    simulation::{Event, EventKind},
};

/// The rules whose outcome is compared: the easiest and the hardest.
pub const RULES: [Rule; 2] = [Rule::StraightRail, Rule::ThreeCushion];

/// The errors of one run.
#[derive(Clone, Copy, Debug)]
pub struct Errors {
    /// Greatest distance between a ball's final position and its true final position, m.
    pub rest: f64,
    /// `rest` in units of `(1 + condition) 2^-53`.
    pub rest_units: f64,
    /// Greatest error of an event time before the first event that differs, s; `None` if the runs have no event in common.
    pub time: Option<f64>,
    /// Index of the first event that differs; `None` if all events agree.
    pub differs_at: Option<usize>,
    /// Whether the outcome is wrong under each of `RULES`.
    pub flips: [bool; 2],
}

impl Errors {
    /// Compares a run with the truth.
    pub fn of(truth: &Truth, run: &Run) -> Self {
        let rest = truth.distance(&run.end);
        let (mine, theirs) = if truth.chatters {
            (without_chatter(&run.events), without_chatter(&truth.events))
        } else {
            (run.events.clone(), truth.events.clone())
        };
        let same = mine.iter().zip(&theirs).take_while(|(mine, theirs)| mine.1 == theirs.1).count();
        let time_errors = mine.iter().zip(&theirs).take(same).map(|(mine, theirs)| (mine.0 - theirs.0).abs());
        let outcome = |events: &[(f64, EventKind)]| {
            let mut tally = Tally::default();
            for &(time, kind) in events {
                tally.count(&Event { time, kind });
            }
            RULES.map(|rule| tally.is_point(rule))
        };
        let (computed, expected) = (outcome(&run.events), outcome(&truth.events));
        Self {
            rest,
            rest_units: rest / truth.unit(),
            time: time_errors.reduce(f64::max),
            differs_at: (same < mine.len().max(theirs.len())).then_some(same),
            flips: std::array::from_fn(|rule| computed[rule] != expected[rule]),
        }
    }
}

/// Returns the collisions without those that repeat the last collision of all their balls. How many bounces of a chatter a
/// method reports, and how the balls move between them, is a choice of the method.
fn without_chatter(events: &[(f64, EventKind)]) -> Vec<(f64, EventKind)> {
    let mut last = [None; crate::table::BALLS];
    let mut kept = Vec::new();
    for &(time, kind) in events.iter().filter(|(_, kind)| kind.is_contact()) {
        let (first, second) = kind.balls();
        let balls = [Some(first), second];
        if balls.iter().flatten().any(|&ball| last[ball] != Some(kind)) {
            kept.push((time, kind));
        }
        balls.into_iter().flatten().for_each(|ball| last[ball] = Some(kind));
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulation::Rail;

    #[test]
    fn of_a_chatter_only_the_first_bounce_is_compared() {
        let bounce = EventKind::BallRail(0, Rail::Top);
        let hit = EventKind::BallBall(0, 1);
        let events = [
            (0.1, bounce),
            (0.2, EventKind::SlidingRolling(0)),
            (0.3, bounce),
            (0.4, hit),
            (0.5, hit),
            (0.6, EventKind::BallRail(1, Rail::Left)),
            (0.7, hit),
            (0.8, bounce),
        ];
        let kept: Vec<f64> = without_chatter(&events).iter().map(|event| event.0).collect();
        assert_eq!(kept, [0.1, 0.4, 0.6, 0.7, 0.8]);
    }
}
