//! Balls in the air in fixed steps: each parabola, landing and impact is seen at the end of a step, too.

use std::ops::ControlFlow;

use glam::DVec3;

use super::{Ball, Stepper, Steps};
use crate::{
    physics::{Cloth, Motion, SpatialState},
    simulation::{Course, Event, EventKind, Hops, Nose, Rail, Segment},
};

/// Landings that are located within one step before what is left of the hops is given up.
const LOCATED: i32 = 60;

/// A ball that is thrown up no faster than this stays on the cloth, m/s: its hop would be over before the step is, or, where
/// landings are located, so would be so many of them.
pub(super) fn last_hop(cloth: &Cloth, method: Steps) -> f64 {
    let seen = 0.5 * cloth.gravity * method.dt;
    if method.locate { seen * cloth.restitution.powi(LOCATED) } else { seen }
}

/// A ball in the air, `time` later.
pub(super) fn falling(state: &SpatialState, gravity: f64, time: f64) -> SpatialState {
    let fallen = gravity * time * DVec3::Z;
    SpatialState {
        position: state.position + time * (state.velocity - 0.5 * fallen),
        velocity: state.velocity - fallen,
        ..*state
    }
}

impl Stepper<'_> {
    pub(super) fn is_aloft(&self, index: usize) -> bool {
        self.balls[index].segment.motion == Motion::Flying
    }

    /// The way from a ball in the air to the nose of `rail`, m.
    fn way_to_nose(&self, state: &SpatialState, rail: Rail) -> DVec3 {
        Nose::of(self.law.cushions.at(rail), self.constants.radius).way_from(&self.constants, rail, state.position)
    }

    /// The same; straight at the rail for one that is deep within it.
    pub(super) fn to_nose(&self, state: &SpatialState, rail: Rail) -> DVec3 {
        let way = self.way_to_nose(state, rail);
        let n = rail.normal();
        if way.truncate().dot(n) < 0.0 { way } else { -self.constants.radius * n.extend(0.0) }
    }

    /// Whether the centre of a ball in the air is over the rail behind its nose. One that is lower has gone through it.
    pub(super) fn is_over(&self, state: &SpatialState, rail: Rail) -> bool {
        let way = self.way_to_nose(state, rail);
        way.truncate().dot(rail.normal()) >= 0.0 && way.z < 0.0
    }

    /// How far a ball in the air is from the nose, or behind it from the top of the rail, m.
    pub(super) fn nose_gap(&self, state: &SpatialState, rail: Rail) -> f64 {
        let radius = self.constants.radius;
        let way = self.way_to_nose(state, rail);
        let is_passed = way.truncate().dot(rail.normal()) >= 0.0;
        if is_passed { -way.z - radius } else { way.length() - radius }
    }

    /// Starts the cue ball.
    pub(super) fn start(&mut self, state: SpatialState) -> ControlFlow<()> {
        if state.velocity.z <= self.constants.tolerance.slowest_in_air {
            self.balls[0] = Ball::launched(&self.constants, self.now, state.seen_from_above());
            return ControlFlow::Continue(());
        }
        self.fly(0, state);
        self.observer.event(Event { time: self.now, kind: EventKind::Jumps(0) })
    }

    /// Sends a ball off after a blow, into the air if it is thrown up fast enough.
    pub(super) fn send_off(&mut self, index: usize, mut state: SpatialState) -> ControlFlow<()> {
        let was_aloft = self.is_aloft(index);
        let time = self.now;
        if let Some(cloth) = self.cloth.filter(|_| state.position.z <= 0.0) {
            cloth.answer(self.constants.radius, &mut state);
            state.position.z = 0.0;
        }
        if state.position.z > 0.0 || state.velocity.z > self.constants.tolerance.slowest_in_air {
            self.close(index);
            self.fly(index, state);
            return if was_aloft {
                ControlFlow::Continue(())
            } else {
                self.observer.event(Event { time, kind: EventKind::Jumps(index) })
            };
        }
        self.launch(index, state.seen_from_above());
        if was_aloft {
            self.observer.event(Event { time, kind: EventKind::Lands(index) })
        } else {
            ControlFlow::Continue(())
        }
    }

    fn fly(&mut self, index: usize, state: SpatialState) {
        let Some(cloth) = self.cloth else { return };
        let hops = Hops::new(&self.constants, &cloth, &state);
        let segment = Segment {
            start: self.now,
            velocity: state.velocity.truncate(),
            spin: state.spin,
            motion: Motion::Flying,
            ..Segment::at_rest(state.position.truncate())
        };
        let ends = self.now + hops.arc(0).end;
        self.balls[index] =
            Ball { state, segment: Segment { course: Some(Box::new(Course::Hops(hops))), ..segment }, ends };
    }

    /// A ball comes down on the cloth: it hops again, or stays there. It is found below the cloth, and came there with the speed that
    /// its energy tells; the speed that it has by now would make hops higher again that are as short as a step.
    pub(super) fn land(&mut self, index: usize) -> ControlFlow<()> {
        let Some(cloth) = self.cloth else { return ControlFlow::Continue(()) };
        let mut state = self.balls[index].state;
        let square = state.velocity.z.powi(2) + 2.0 * cloth.gravity * state.position.z;
        (state.position.z, state.velocity.z) = (0.0, -square.max(0.0).sqrt());
        cloth.answer(self.constants.radius, &mut state);
        if state.velocity.z > self.last_hop {
            self.close(index);
            self.fly(index, state);
            return ControlFlow::Continue(());
        }
        self.last_event = self.now;
        self.launch(index, state.seen_from_above());
        let time = self.now;
        self.observer.event(Event { time, kind: EventKind::Lands(index) })?;
        match self.balls[index].segment.motion {
            Motion::Rolling => self.observer.event(Event { time, kind: EventKind::SlidingRolling(index) }),
            Motion::Stationary => self.observer.event(Event { time, kind: EventKind::RollingStationary(index) }),
            _ => ControlFlow::Continue(()),
        }
    }

    /// Two balls meet of which one at least is in the air.
    pub(super) fn collide_in_space(&mut self, first: usize, second: usize) -> ControlFlow<()> {
        let (mut one, mut other) = (self.balls[first].state, self.balls[second].state);
        let slowest = self.constants.tolerance.slowest_in_air;
        let Some(cloth) = self.cloth else { return ControlFlow::Continue(()) };
        self.law.balls.resolve_over_cloth(self.constants.radius, slowest, &cloth, &mut one, &mut other);
        self.observer.event(Event { time: self.now, kind: EventKind::BallBall(first, second) })?;
        self.send_off(first, one)?;
        self.send_off(second, other)
    }

    /// A ball in the air meets a nose.
    pub(super) fn rebound_in_space(&mut self, index: usize, rail: Rail) -> ControlFlow<()> {
        let mut state = self.balls[index].state;
        let d = self.to_nose(&state, rail).normalize();
        let slowest = self.constants.tolerance.slowest_in_air;
        self.law.cushions.at(rail).resolve_in_space(self.constants.radius, slowest, d, &mut state);
        self.observer.event(Event { time: self.now, kind: EventKind::BallRail(index, rail) })?;
        self.send_off(index, state)
    }

    /// A ball leaves the table.
    pub(super) fn leave(&mut self, index: usize) {
        let place = self.balls[index].state.seen_from_above().position;
        self.close(index);
        let segment = Segment { start: self.now, motion: Motion::OffTable, ..Segment::at_rest(place) };
        let state = SpatialState { position: place.extend(0.0), velocity: DVec3::ZERO, spin: DVec3::ZERO };
        self.balls[index] = Ball { state, segment, ends: f64::INFINITY };
    }
}
