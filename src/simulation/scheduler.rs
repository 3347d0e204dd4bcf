//! Event scheduler: predicts the next own event of every ball and the next collision of every pair.

use std::ops::ControlFlow;

use super::{
    Observer, Rail, Segment,
    aloft::nose_ahead,
    ball_ball::{Triangle, balls_ahead},
    contacts::PAIRS_OF,
    cushions::cushion_ahead,
    engine::{Ball, ContactMode, Engine, Meeting, only},
    predict::{Ahead, curved_cushion_ahead},
    savings::Savings,
};
use crate::{
    physics::Motion,
    table::{BALLS, PAIRS},
};

/// Prediction horizon, s: no ball moves for so long.
const LONGEST: f64 = 1e9;

impl<S: Savings, O: Observer + ?Sized> Engine<'_, S, O> {
    /// Sets the trajectory of a ball, which is valid for `lasts` seconds, and predicts its next cushion impact.
    #[inline(always)]
    pub(super) fn set(&mut self, index: usize, segment: Segment, lasts: f64) {
        let ball = &mut self.balls[index];
        ball.segment = segment;
        ball.lasts = lasts;
        if self.predict_cushion(index) {
            self.pressed = true;
        }
    }

    /// Predicts the next cushion impact of a ball. Returns whether the ball is pressed against a cushion instead.
    #[inline(always)]
    fn predict_cushion(&mut self, index: usize) -> bool {
        let Ball { segment, lasts, rail_after, rail, .. } = &mut self.balls[index];
        *rail_after = f64::INFINITY;
        self.times[index] = segment.start + *lasts;
        if S::BALLS_AT_REST && segment.motion == Motion::Stationary {
            return false;
        }
        if segment.motion == Motion::Flying || segment.motion == Motion::OffTable {
            if let Some((after, which)) = nose_ahead(&self.constants, &self.law.cushions, segment) {
                (*rail_after, *rail) = (after, which);
                self.times[index] = segment.start + after;
            }
            return false;
        }
        let (ahead, which) = match &self.resting {
            Some(resting) if segment.motion == Motion::Resting => {
                curved_cushion_ahead(&self.constants, segment, *lasts, |rail| resting.holds_at(index, rail))
            }
            _ => cushion_ahead::<S>(&self.constants, segment, *lasts),
        };
        let pressed = ahead == Ahead::Pressed;
        // A ball pressed against one cushion can hit another; and if nothing holds it after all, the same one.
        let (ahead, which) =
            if pressed { curved_cushion_ahead(&self.constants, segment, *lasts, |_| false) } else { (ahead, which) };
        if let Ahead::Meeting(after) = ahead {
            *rail_after = after;
            *rail = which;
            self.times[index] = segment.start + after;
        }
        pressed
    }

    /// Predicts the collisions of one ball, after its trajectory has been set at `now`.
    #[inline(always)]
    pub(super) fn look_ahead_of(&mut self, now: f64, index: usize) -> ControlFlow<()> {
        if !S::KEPT_PREDICTIONS || self.pressed || self.resting.is_some() {
            return self.look_ahead(now, only(index));
        }
        let ball = &self.balls[index];
        let still = ball.segment.motion == Motion::Stationary;
        let flies = ball.segment.motion == Motion::Flying;
        let horizon = self.times[index] - now;
        let triangle =
            Triangle::new(ball.segment.position, ball.segment.velocity, ball.segment.half_acceleration, horizon);
        let apart = self.constants.diameter + self.constants.tolerance.surely_apart;
        for (pair, other) in PAIRS_OF[index] {
            let other = &self.balls[other].segment;
            let at_rest = other.motion == Motion::Stationary;
            // Most pairs end here: one ball passes another one that is at rest.
            if at_rest
                && ((S::BALLS_AT_REST && still)
                    || (S::COURSES_APART && !flies && triangle.clears(other.position, apart)))
            {
                self.times[BALLS + pair] = f64::INFINITY;
                self.pairs[pair] = Meeting::unseen(now, true);
            } else {
                self.predict_pair(pair, now, true);
            }
        }
        if self.pressed {
            // Only the pair predictions have shown that balls press each other.
            return self.look_ahead(now, only(index));
        }
        ControlFlow::Continue(())
    }

    /// Predicts the collisions of the `changed` balls, after their trajectories have been set.
    pub(super) fn look_ahead(&mut self, now: f64, changed: [bool; BALLS]) -> ControlFlow<()> {
        let mut changed = changed;
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
        let at_rail = |index: usize| self.balls[index].rail_after < self.balls[index].lasts && self.times[index] <= now;
        (0..BALLS).any(at_rail) || self.times[BALLS..].iter().any(|time| *time <= now)
    }

    /// Predicts the collisions of balls that continue to press each other as before.
    pub(super) fn look_ahead_of_pressed(&mut self, now: f64, members: [bool; BALLS]) {
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
        self.pairs[index] = Meeting::unseen(now, may_rest);
        self.times[BALLS + index] = f64::INFINITY;
        if S::BALLS_AT_REST && a.motion == Motion::Stationary && b.motion == Motion::Stationary {
            return;
        }
        if a.motion == Motion::OffTable || b.motion == Motion::OffTable {
            return;
        }
        if self.resting.as_ref().is_some_and(|resting| resting.holds_together((first, second))) {
            return;
        }
        let horizon = (self.times[first].min(self.times[second]) - now).min(LONGEST);
        match balls_ahead::<S>(&self.constants, a, b, now, horizon, may_rest) {
            Ahead::Nothing => {}
            Ahead::Meeting(after) => {
                self.pairs[index].after = after;
                self.times[BALLS + index] = now + after;
            }
            Ahead::Pressed => self.pressed = true,
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
                let Meeting { since, may_rest, .. } = self.pairs[index];
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
            lasts: f64::INFINITY,
            rail_after: f64::INFINITY,
            rail: Rail::Left,
            mode: ContactMode::Free,
        }
    }
}
