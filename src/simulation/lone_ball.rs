//! Fast path for the parts of a shot in which a single ball moves, from cushion to cushion, without other candidate events.
//!
//! Most of a shot is like this, and most shots consist of nothing else. The general loop compares six event times at every event and stores
//! the whole ball in memory between events. Here the ball's own next event is the only one, and its trajectory stays in registers. All
//! numbers are computed by the same operations in the same order as in the general loop. Every unusual case is left to the general loop
//! before any part of it is processed.

use std::ops::ControlFlow;

use super::{
    EventKind, Observer, Segment,
    ball_ball::Triangle,
    contacts::{PAIRS_OF, is_in_corner, move_to_cushion},
    cushions::next_cushion_impact,
    engine::{Ball, ContactMode, Engine},
    guards::ITERATION_COST,
    predict::Prediction,
    savings::Savings,
};
use crate::{physics::Motion, table::BALLS};

impl<S: Savings, O: Observer + ?Sized> Engine<'_, S, O> {
    /// Whether ball `index` is the only moving ball, free, and with no other ball in its path.
    #[inline(always)]
    pub(super) fn is_only_moving_ball(&self, index: usize) -> bool {
        let still = |ball: usize| self.balls[ball].segment.motion == Motion::Stationary;
        matches!(self.balls[index].segment.motion, Motion::Sliding | Motion::Rolling)
            && PAIRS_OF[index].iter().all(|&(pair, other)| still(other) && self.times[BALLS + pair] == f64::INFINITY)
            && self.balls[index].mode == ContactMode::Free
            && self.resting.is_none()
    }

    /// Processes events from `now` on while ball `index` moves alone; `now` becomes the time of the last event.
    pub(super) fn play_lone_ball(&mut self, index: usize, now: &mut f64) -> ControlFlow<()> {
        let others = PAIRS_OF[index].map(|(_, other)| self.balls[other].segment.position);
        let constants = &{ self.constants };
        let near = (constants.diameter + constants.tolerance.touching).powi(2);
        let mut ball = self.balls[index].to_free();
        loop {
            self.effort.add(ITERATION_COST);
            if self.resting_budget_spent() || self.is_exhausted() {
                break;
            }
            let Ball { segment, duration, rail_after, rail, .. } = &ball;
            let next = ball.next_event_time();
            let (mut after, duration_after, kind);
            if rail_after < duration {
                let n = rail.normal();
                let mut state = segment.state_after(constants, *rail_after);
                move_to_cushion(constants, n, &mut state.position);
                let impulse = self.law.cushion(*rail).resolve(constants.radius, n, &mut state);
                // Possible part of a chatter, simultaneous contact with two cushions or a ball, or leaving the cloth.
                if state.velocity.dot(n) <= constants.tolerance.slow_bounce
                    || is_in_corner(constants, state.position)
                    || others.iter().any(|other| state.position.distance_squared(*other) <= near)
                    || impulse.climb > constants.least_climb
                {
                    break;
                }
                (after, duration_after) = Segment::free(constants, next, &state);
                kind = Some(EventKind::BallRail(index, *rail));
            } else {
                if segment.motion == Motion::Rolling && segment.rolls_to_rest(constants) {
                    break;
                }
                (after, duration_after) = segment.successor(constants, *duration);
                after.start = next;
                kind = (segment.motion == Motion::Sliding).then_some(EventKind::SlidingRolling(index));
            }
            if after.motion == Motion::Stationary {
                break;
            }
            if self.observer.wants_segments() {
                self.observer.segment(index, segment, next);
            }
            *now = next;
            let flow = kind.map_or(ControlFlow::Continue(()), |kind| self.report(next, kind));
            let (ahead, rail) = next_cushion_impact::<S>(constants, &after, duration_after);
            let rail_after = if let Prediction::Impact(after) = ahead { after } else { f64::INFINITY };
            ball = Ball { segment: after, duration: duration_after, rail_after, rail, mode: ContactMode::Free };
            let Segment { position, velocity, half_acceleration, .. } = ball.segment;
            let triangle = Triangle::new(position, velocity, half_acceleration, ball.next_event_time() - next);
            let clears = |other| {
                S::SEPARATED_COURSES && triangle.clears(other, constants.diameter + constants.tolerance.certain_gap)
            };
            if flow.is_break() || ahead == Prediction::Pressed || !(clears(others[0]) & clears(others[1])) {
                if ahead == Prediction::Pressed {
                    self.set(index, ball.segment, ball.duration);
                } else {
                    self.store_ball(index, ball);
                }
                flow?;
                self.predict_ball(next, index)?;
                if !self.is_only_moving_ball(index) {
                    return ControlFlow::Continue(());
                }
                ball = self.balls[index].to_free();
            }
        }
        self.store_ball(index, ball);
        ControlFlow::Continue(())
    }

    /// Stores a ball whose next event is known.
    #[inline(always)]
    fn store_ball(&mut self, index: usize, ball: Ball) {
        self.times[index] = ball.next_event_time();
        self.balls[index] = ball;
    }
}

impl Ball {
    /// Returns a copy that the compiler knows to be free and without a curved trajectory.
    #[inline(always)]
    fn to_free(&self) -> Self {
        let &Segment { start, position, velocity, half_acceleration, spin, motion, .. } = &self.segment;
        Self {
            segment: Segment { start, position, velocity, half_acceleration, spin, motion, course: None },
            mode: ContactMode::Free,
            ..*self
        }
    }

    /// Returns the time of the next event, s.
    #[inline(always)]
    fn next_event_time(&self) -> f64 {
        self.segment.start + if self.rail_after < self.duration { self.rail_after } else { self.duration }
    }
}
