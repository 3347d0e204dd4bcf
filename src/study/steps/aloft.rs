//! Flights with fixed time steps. Each parabola, landing and impact is detected at the end of a step, as on the cloth.

use std::ops::ControlFlow;

use glam::DVec3;

use super::{Ball, Stepper, Steps};
use crate::{
    physics::{Cloth, Motion, SpatialState},
    simulation::{Course, Event, EventKind, Hops, Nose, Rail, Segment},
};

/// Maximum number of landings located within one step; the rest of the hops is dropped.
const LOCATED: i32 = 60;

/// Returns the rebound speed, m/s, below which a ball stays on the cloth: that of a hop that lasts one step or, if landings are
/// located, what is left of it after [`LOCATED`] more landings.
pub(super) fn last_hop(cloth: &Cloth, method: Steps) -> f64 {
    let seen = 0.5 * cloth.gravity * method.dt;
    if method.locate { seen * cloth.restitution.powi(LOCATED) } else { seen }
}

/// Returns the state of a ball in the air `time` later.
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

    /// Returns the vector from a ball in the air to the nose of `rail`, m.
    fn vector_to_nose(&self, state: &SpatialState, rail: Rail) -> DVec3 {
        Nose::of(self.law.cushion(rail), self.constants.radius).vector_from(&self.constants, rail, state.position)
    }

    /// Returns the same vector, or the horizontal vector towards the rail for a ball that is deep within it.
    pub(super) fn to_nose(&self, state: &SpatialState, rail: Rail) -> DVec3 {
        let way = self.vector_to_nose(state, rail);
        let n = rail.normal();
        if way.truncate().dot(n) < 0.0 { way } else { -self.constants.radius * n.extend(0.0) }
    }

    /// Whether the centre of a ball in the air is over the rail behind its nose. A ball below that height has passed through
    /// the cushion.
    pub(super) fn is_over(&self, state: &SpatialState, rail: Rail) -> bool {
        let way = self.vector_to_nose(state, rail);
        way.truncate().dot(rail.normal()) >= 0.0 && way.z < 0.0
    }

    /// Returns the distance of a ball in the air to the nose or, behind it, to the top of the rail, m.
    pub(super) fn nose_gap(&self, state: &SpatialState, rail: Rail) -> f64 {
        let radius = self.constants.radius;
        let way = self.vector_to_nose(state, rail);
        let is_passed = way.truncate().dot(rail.normal()) >= 0.0;
        if is_passed { -way.z - radius } else { way.length() - radius }
    }

    /// Starts the cue ball with the state after the stroke.
    pub(super) fn start(&mut self, state: SpatialState) -> ControlFlow<()> {
        if state.velocity.z <= self.constants.tolerance.slowest_in_air {
            self.balls[0] = Ball::launched(&self.constants, self.now, state.horizontal_state());
            return ControlFlow::Continue(());
        }
        self.fly(0, state);
        self.observer.event(Event { time: self.now, kind: EventKind::Jumps(0) })
    }

    /// Launches a ball after an impact, into the air if its upward speed is high enough.
    pub(super) fn send_off(&mut self, index: usize, mut state: SpatialState) -> ControlFlow<()> {
        let was_aloft = self.is_aloft(index);
        if let Some(cloth) = self.cloth.filter(|_| state.position.z <= 0.0) {
            cloth.resolve(self.constants.radius, &mut state);
            state.position.z = 0.0;
        }
        let flies = state.position.z > 0.0 || state.velocity.z > self.constants.tolerance.slowest_in_air;
        if flies {
            self.close(index);
            self.fly(index, state);
        } else {
            self.launch(index, state.horizontal_state());
        }
        if flies == was_aloft {
            return ControlFlow::Continue(());
        }
        let kind = if flies { EventKind::Jumps(index) } else { EventKind::Lands(index) };
        self.observer.event(Event { time: self.now, kind })
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

    /// Handles a landing: the ball hops again, or stays on the cloth. The ball is detected below the cloth. Its landing speed
    /// follows from energy conservation: the present speed is too high, and would make hops that are as short as a step higher
    /// again.
    pub(super) fn land(&mut self, index: usize) -> ControlFlow<()> {
        let Some(cloth) = self.cloth else { return ControlFlow::Continue(()) };
        let mut state = self.balls[index].state;
        let square = state.velocity.z.powi(2) + 2.0 * cloth.gravity * state.position.z;
        (state.position.z, state.velocity.z) = (0.0, -square.max(0.0).sqrt());
        cloth.resolve(self.constants.radius, &mut state);
        if state.velocity.z > self.last_hop {
            self.close(index);
            self.fly(index, state);
            return ControlFlow::Continue(());
        }
        self.last_event = self.now;
        self.launch(index, state.horizontal_state());
        let time = self.now;
        self.observer.event(Event { time, kind: EventKind::Lands(index) })?;
        match self.balls[index].segment.motion {
            Motion::Rolling => self.observer.event(Event { time, kind: EventKind::SlidingRolling(index) }),
            Motion::Stationary => self.observer.event(Event { time, kind: EventKind::RollingStationary(index) }),
            _ => ControlFlow::Continue(()),
        }
    }

    /// Handles a collision of two balls of which at least one is in the air.
    pub(super) fn collide_in_space(&mut self, first: usize, second: usize) -> ControlFlow<()> {
        let (mut one, mut other) = (self.balls[first].state, self.balls[second].state);
        let slowest = self.constants.tolerance.slowest_in_air;
        let Some(cloth) = self.cloth else { return ControlFlow::Continue(()) };
        self.law.balls.resolve_over_cloth(self.constants.radius, slowest, &cloth, &mut one, &mut other);
        self.observer.event(Event { time: self.now, kind: EventKind::BallBall(first, second) })?;
        self.send_off(first, one)?;
        self.send_off(second, other)
    }

    /// Handles the impact of a ball in the air on a nose.
    pub(super) fn rebound_in_space(&mut self, index: usize, rail: Rail) -> ControlFlow<()> {
        let mut state = self.balls[index].state;
        let d = self.to_nose(&state, rail).normalize();
        let slowest = self.constants.tolerance.slowest_in_air;
        self.law.cushion(rail).resolve_in_space(self.constants.radius, slowest, d, &mut state);
        self.observer.event(Event { time: self.now, kind: EventKind::BallRail(index, rail) })?;
        self.send_off(index, state)
    }

    /// Takes a ball that has left the table out of play.
    pub(super) fn leave(&mut self, index: usize) {
        let position = self.balls[index].state.horizontal_state().position;
        self.close(index);
        let segment = Segment { start: self.now, motion: Motion::OffTable, ..Segment::at_rest(position) };
        let state = SpatialState { position: position.extend(0.0), velocity: DVec3::ZERO, spin: DVec3::ZERO };
        self.balls[index] = Ball { state, segment, ends: f64::INFINITY };
    }
}
