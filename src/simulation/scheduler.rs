//! Event scheduler: predicts the next own event of every ball and the next collision of every pair.

use std::ops::ControlFlow;

use super::{
    Observer, Rail, Segment,
    aloft::next_nose_impact,
    ball_ball::{Triangle, next_collision},
    contacts::PAIRS_OF,
    cushions::next_cushion_impact,
    engine::{Ball, ContactMode, Engine, PairPrediction, only_ball},
    predict::{Prediction, next_cushion_impact_on_curve},
    savings::Savings,
};
use crate::{
    physics::Motion,
    table::{BALLS, PAIRS},
};

/// Prediction horizon, s: no ball moves for so long.
const LONGEST: f64 = 1e9;

impl<S: Savings, O: Observer + ?Sized> Engine<'_, S, O> {
    /// Sets the trajectory of a ball, which is valid for `duration` seconds, and predicts its next cushion impact.
    #[inline(always)]
    pub(super) fn set(&mut self, index: usize, segment: Segment, duration: f64) {
        let ball = &mut self.balls[index];
        ball.segment = segment;
        ball.duration = duration;
        self.pressed |= self.predict_cushion(index);
    }

    /// Predicts the next cushion impact of a ball. Returns whether the ball is pressed against a cushion instead.
    #[inline(always)]
    fn predict_cushion(&mut self, index: usize) -> bool {
        let Ball { segment, duration, rail_after, rail, .. } = &mut self.balls[index];
        *rail_after = f64::INFINITY;
        self.times[index] = segment.start + *duration;
        if S::BALLS_AT_REST && segment.motion == Motion::Stationary {
            return false;
        }
        if segment.motion == Motion::Flying || segment.motion == Motion::OffTable {
            if let Some((after, which)) = next_nose_impact(&self.constants, &self.law, segment) {
                (*rail_after, *rail) = (after, which);
                self.times[index] = segment.start + after;
            }
            return false;
        }
        let (ahead, which) = match &self.resting {
            Some(resting) if segment.motion == Motion::Resting => {
                next_cushion_impact_on_curve(&self.constants, segment, *duration, |rail| {
                    resting.presses_cushion(index, rail)
                })
            }
            _ => next_cushion_impact::<S>(&self.constants, segment, *duration),
        };
        let pressed = ahead == Prediction::Pressed;
        // A ball pressed against one cushion can hit another; and if nothing holds it after all, the same one.
        let (ahead, which) = if pressed {
            next_cushion_impact_on_curve(&self.constants, segment, *duration, |_| false)
        } else {
            (ahead, which)
        };
        if let Prediction::Impact(after) = ahead {
            *rail_after = after;
            *rail = which;
            self.times[index] = segment.start + after;
        }
        pressed
    }

    /// Predicts the collisions of one ball, after its trajectory has been set at `now`.
    #[inline(always)]
    pub(super) fn predict_ball(&mut self, now: f64, index: usize) -> ControlFlow<()> {
        if !S::KEPT_PREDICTIONS || self.pressed || self.resting.is_some() {
            return self.predict_changed(now, only_ball(index));
        }
        let ball = &self.balls[index];
        let still = ball.segment.motion == Motion::Stationary;
        let flies = ball.segment.motion == Motion::Flying;
        let horizon = self.times[index] - now;
        let triangle =
            Triangle::new(ball.segment.position, ball.segment.velocity, ball.segment.half_acceleration, horizon);
        let apart = self.constants.diameter + self.constants.tolerance.certain_gap;
        for (pair, other) in PAIRS_OF[index] {
            let other = &self.balls[other].segment;
            let at_rest = other.motion == Motion::Stationary;
            // Most pairs end here: one ball passes another one that is at rest.
            if at_rest
                && ((S::BALLS_AT_REST && still)
                    || (S::SEPARATED_COURSES && !flies && triangle.clears(other.position, apart)))
            {
                self.times[BALLS + pair] = f64::INFINITY;
                self.pairs[pair] = PairPrediction::none(now, true);
            } else {
                self.predict_pair(pair, now, true);
            }
        }
        if self.pressed {
            // Only the pair predictions have shown that balls press each other.
            return self.predict_changed(now, only_ball(index));
        }
        ControlFlow::Continue(())
    }

    /// Predicts the collisions of the `changed` balls, after their trajectories have been set.
    pub(super) fn predict_changed(&mut self, now: f64, mut changed: [bool; BALLS]) -> ControlFlow<()> {
        if !S::KEPT_PREDICTIONS {
            self.predict_all_again(changed);
        }
        if self.micro_collisions.is_some() {
            self.predict_pairs(now, changed, false);
            self.pressed = false;
            return ControlFlow::Continue(());
        }
        self.predict_pairs(now, changed, true);
        if self.resting.is_some() || (self.pressed && !self.collides_at(now)) {
            self.press(now, &mut changed)?;
            self.predict_pairs(now, changed, false);
            self.pressed = false;
        }
        ControlFlow::Continue(())
    }

    /// Whether an impact is due at this moment. Impacts come first, because forces have no effect in zero time.
    fn collides_at(&self, now: f64) -> bool {
        let at_rail =
            |index: usize| self.balls[index].rail_after < self.balls[index].duration && self.times[index] <= now;
        (0..BALLS).any(at_rail) || self.times[BALLS..].iter().any(|time| *time <= now)
    }

    /// Predicts the collisions of balls that continue to press each other as before.
    pub(super) fn predict_pressed(&mut self, now: f64, members: [bool; BALLS]) {
        if !S::KEPT_PREDICTIONS {
            self.predict_all_again(members);
        }
        self.predict_pairs(now, members, false);
    }

    fn predict_pairs(&mut self, now: f64, changed: [bool; BALLS], may_rest: bool) {
        for (index, &(first, second)) in PAIRS.iter().enumerate() {
            if changed[first] || changed[second] {
                self.predict_pair(index, now, may_rest);
            }
        }
    }

    fn predict_pair(&mut self, index: usize, now: f64, may_rest: bool) {
        let (first, second) = PAIRS[index];
        let (a, b) = (&self.balls[first].segment, &self.balls[second].segment);
        self.pairs[index] = PairPrediction::none(now, may_rest);
        self.times[BALLS + index] = f64::INFINITY;
        if S::BALLS_AT_REST && a.motion == Motion::Stationary && b.motion == Motion::Stationary {
            return;
        }
        if a.motion == Motion::OffTable || b.motion == Motion::OffTable {
            return;
        }
        if self.resting.as_ref().is_some_and(|resting| resting.presses_together((first, second))) {
            return;
        }
        let horizon = (self.times[first].min(self.times[second]) - now).min(LONGEST);
        match next_collision::<S>(&self.constants, a, b, now, horizon, may_rest) {
            Prediction::Nothing => {}
            Prediction::Impact(after) => {
                self.pairs[index].after = after;
                self.times[BALLS + index] = now + after;
            }
            Prediction::Pressed => self.pressed = true,
        }
    }

    /// Repeats known predictions, for when this optimization is switched off. Pressed balls have already been handled.
    fn predict_all_again(&mut self, changed: [bool; BALLS]) {
        let pressed = self.pressed;
        for index in (0..BALLS).filter(|&index| !changed[index]) {
            self.predict_cushion(index);
        }
        for (index, &(first, second)) in PAIRS.iter().enumerate() {
            if !changed[first] && !changed[second] {
                let PairPrediction { since, may_rest, .. } = self.pairs[index];
                self.predict_pair(index, since, may_rest);
            }
        }
        self.pressed = pressed;
    }
}

impl Ball {
    /// Creates a ball at permanent rest.
    pub(super) const fn at_rest(position: glam::DVec2) -> Self {
        Self {
            segment: Segment::at_rest(position),
            duration: f64::INFINITY,
            rail_after: f64::INFINITY,
            rail: Rail::Left,
            mode: ContactMode::Free,
        }
    }
}
