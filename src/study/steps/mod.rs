//! Simulation with fixed time steps: the intuitive method (thesis 3.1). All balls advance by one step, and events are detected
//! at its end. It is a baseline for the engine: its events are late, balls overlap or pass through each other (thesis Figures
//! 10 and 11), and it measures by how much.

mod aloft;

use std::ops::ControlFlow;

use glam::DVec2;
use serde::Serialize;

use crate::{
    physics::{BallState, Cloth, ImpactLaw, Impulse, Motion, Rolling, SpatialState, rolling_spin},
    printing::number,
    simulation::{Constants, End, Event, EventKind, Observer, Rail, Segment},
    table::{BALLS, Layout, PAIRS, Table},
};

/// Maximum number of events located within one step; the rest of a chatter is detected at the end of the step.
const MAX_LOCATED: usize = 64;

/// Parameters of the stepping.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Steps {
    /// The time step, s.
    pub dt: f64,
    /// Whether an event that is detected at the end of a step is located within it. Events that are over before the end are
    /// missed either way.
    pub locate: bool,
}

/// A time step outside the accepted range.
#[derive(Debug, thiserror::Error, PartialEq)]
#[error("dt = {} s is no usable time step; accepted is {} to 1 s", number(*.0), number(Steps::SHORTEST))]
pub struct StepError(f64);

/// The result of a stepped shot.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SteppedShot {
    /// The final state of the balls.
    #[serde(skip)]
    pub end: End,
    /// Number of steps.
    pub steps: u64,
    /// Deepest overlap of two balls, or of a ball and a cushion, m.
    pub deepest_overlap: f64,
    /// Whether all balls came to rest. Long steps can keep a ball jittering forever.
    pub at_rest: bool,
}

impl Steps {
    /// The shortest time step, s. The time limit of a shot is a second or more: millions of such steps, which take some seconds
    /// to compute.
    const SHORTEST: f64 = 3e-7;

    /// Creates steps of `dt` seconds.
    ///
    /// # Errors
    /// [`StepError`] if `dt` is not from 3e-7 to 1.
    pub fn new(dt: f64, locate: bool) -> Result<Self, StepError> {
        if (Self::SHORTEST..=1.0).contains(&dt) { Ok(Self { dt, locate }) } else { Err(StepError(dt)) }
    }

    /// Returns the shortest time step, s, with which a shot takes at most `most` steps.
    pub fn finest(table: &Table, impulse: &Impulse, most: f64) -> f64 {
        time_limit(table, impulse) / most
    }

    /// Plays a shot as [`simulate`](crate::simulation::simulate) does, step by step.
    pub fn simulate(
        self,
        table: &Table,
        layout: &Layout,
        impulse: &Impulse,
        observer: &mut dyn Observer,
    ) -> SteppedShot {
        let mut stepper = Stepper::new(table, layout, self, observer);
        let velocity = impulse.velocity.extend(impulse.lift);
        let state = SpatialState { velocity, spin: impulse.spin, ..stepper.balls[0].state };
        let mut flow = stepper.start(state);
        let limit = time_limit(table, impulse);
        let mut steps = 0_u64;
        while flow.is_continue() && !stepper.at_rest() && steps as f64 * self.dt < limit {
            steps += 1;
            // A product does not accumulate rounding errors, as a sum of steps would.
            flow = stepper.step(steps as f64 * self.dt, self);
        }
        let at_rest = stepper.at_rest();
        let deepest_overlap = stepper.deepest_overlap;
        SteppedShot { end: stepper.finish(), steps, deepest_overlap, at_rest }
    }
}

/// Upper bound of the duration of a shot, s. No ball of this energy can roll longer; any motion left then is jitter.
fn time_limit(table: &Table, impulse: &Impulse) -> f64 {
    let velocity = impulse.velocity.extend(impulse.lift);
    let state = SpatialState { velocity, spin: impulse.spin, position: glam::DVec3::ZERO };
    let speed = (2.0 * state.specific_energy(table.radius, table.gravity)).sqrt();
    let hops = Cloth::of(table).map_or(0.0, |cloth| 2.0 * speed / (cloth.gravity * (1.0 - cloth.restitution)));
    1.0 + hops + speed / Rolling::of(table).least
}

/// A ball and the segment of its present motion.
#[derive(Clone)]
struct Ball {
    state: SpatialState,
    segment: Segment,
    /// Time at which the present motion would end, s.
    ends: f64,
}

impl Ball {
    fn launched(constants: &Constants, now: f64, state: BallState) -> Self {
        let (segment, lasts) = Segment::free(constants, now, &state);
        Self { state: state.into(), segment, ends: now + lasts }
    }

    fn moves(&self) -> bool {
        !matches!(self.segment.motion, Motion::Stationary | Motion::OffTable)
    }

    /// Whether the state of the ball changes with time: a ball at rest may still spin.
    fn turns(&self) -> bool {
        self.moves() || self.state.spin.z != 0.0
    }

    /// Returns the state `time` later, extrapolated with the present velocity and acceleration.
    fn after(&self, constants: &Constants, time: f64) -> SpatialState {
        if let Some(hops) = self.segment.hops() {
            return aloft::falling(&self.state, hops.cloth.gravity, time);
        }
        let BallState { position, velocity, spin } = self.state.horizontal_state();
        Segment { position, velocity, spin, ..self.segment.clone() }.state_after(constants, time).into()
    }
}

struct Stepper<'a> {
    constants: Constants,
    law: ImpactLaw,
    /// The cloth, if balls can leave it.
    cloth: Option<Cloth>,
    /// A ball that lands and rebounds no faster than this stays on the cloth, m/s.
    last_hop: f64,
    observer: &'a mut dyn Observer,
    balls: [Ball; BALLS],
    now: f64,
    last_event: f64,
    deepest_overlap: f64,
}

impl<'a> Stepper<'a> {
    fn new(table: &Table, layout: &Layout, method: Steps, observer: &'a mut dyn Observer) -> Self {
        let balls = layout.balls.map(|position| Ball {
            state: BallState::at_rest(position).into(),
            segment: Segment::at_rest(position),
            ends: f64::INFINITY,
        });
        let constants = Constants::of(table);
        let cloth = Cloth::of(table);
        Self {
            constants,
            law: ImpactLaw::of(table),
            last_hop: cloth.map_or(0.0, |cloth| aloft::last_hop(&cloth, method)),
            cloth,
            observer,
            balls,
            now: 0.0,
            last_event: 0.0,
            deepest_overlap: 0.0,
        }
    }

    fn at_rest(&self) -> bool {
        !self.balls.iter().any(Ball::moves)
    }

    /// Advances one step, to time `end`.
    fn step(&mut self, end: f64, method: Steps) -> ControlFlow<()> {
        if method.locate {
            for _ in 0..MAX_LOCATED {
                let Some((time, kind)) = self.first_within(end - self.now) else { break };
                self.advance(self.now + time);
                self.apply_event(kind)?;
            }
        }
        self.advance(end);
        self.detect_events()
    }

    fn advance(&mut self, to: f64) {
        for ball in self.balls.iter_mut().filter(|ball| ball.turns()) {
            ball.state = ball.after(&self.constants, to - self.now);
        }
        self.now = to;
    }

    /// Handles all events detected at the end of a step, in a fixed order, because their true order is not known.
    fn detect_events(&mut self) -> ControlFlow<()> {
        for index in 0..BALLS {
            if self.balls[index].moves() && self.balls[index].ends <= self.now {
                self.apply_event(self.end_of_motion(index))?;
            }
        }
        for index in 0..BALLS {
            for rail in Rail::ALL {
                let ball = &self.balls[index];
                if ball.moves() && self.rail_gap(index, &ball.state, rail) < 0.0 {
                    let kind = self.rail_event(index, &ball.state, rail);
                    if matches!(kind, EventKind::BallRail(..)) {
                        self.deepest_overlap = self.deepest_overlap.max(-self.rail_gap(index, &ball.state, rail));
                    }
                    if self.approaches_rail(index, &ball.state, rail) {
                        self.apply_event(kind)?;
                    }
                }
            }
        }
        for (first, second) in PAIRS {
            let (a, b) = (&self.balls[first], &self.balls[second]);
            let apart = a.state.position - b.state.position;
            let reach = 2.0 * self.constants.radius;
            if self.can_collide(first, second) && apart.length_squared() < reach * reach {
                self.deepest_overlap = self.deepest_overlap.max(reach - apart.length());
                if apart.dot(a.state.velocity - b.state.velocity) < 0.0 {
                    self.apply_event(EventKind::BallBall(first, second))?;
                }
            }
        }
        ControlFlow::Continue(())
    }

    fn end_of_motion(&self, index: usize) -> EventKind {
        match self.balls[index].segment.motion {
            Motion::Sliding => EventKind::SlidingRolling(index),
            Motion::Flying => EventKind::Lands(index),
            _ => EventKind::RollingStationary(index),
        }
    }

    /// Whether two balls can collide: one of them moves, and both are on the table.
    fn can_collide(&self, first: usize, second: usize) -> bool {
        let balls = [&self.balls[first], &self.balls[second]];
        balls.iter().any(|ball| ball.moves()) && balls.iter().all(|ball| ball.segment.motion != Motion::OffTable)
    }

    /// Returns the distance of a ball to a cushion, m.
    fn rail_gap(&self, index: usize, state: &SpatialState, rail: Rail) -> f64 {
        if self.is_aloft(index) {
            return self.nose_gap(state, rail);
        }
        rail.gap(self.constants.reach, state.position.truncate())
    }

    /// Returns the event of a ball whose gap to a cushion has closed.
    fn rail_event(&self, index: usize, state: &SpatialState, rail: Rail) -> EventKind {
        let leaves = self.is_aloft(index) && self.is_over(state, rail);
        if leaves { EventKind::LeavesTable(index) } else { EventKind::BallRail(index, rail) }
    }

    /// Whether a ball moves towards a cushion, or comes down behind its nose.
    fn approaches_rail(&self, index: usize, state: &SpatialState, rail: Rail) -> bool {
        if self.is_aloft(index) {
            return self.is_over(state, rail) || state.velocity.dot(self.to_nose(state, rail)) > 0.0;
        }
        state.velocity.truncate().dot(rail.normal()) < 0.0
    }

    /// Returns the first event that is detected at the end of the next `span` seconds, and its time within the span.
    fn first_within(&self, span: f64) -> Option<(f64, EventKind)> {
        let mut first: Option<(f64, EventKind)> = None;
        let mut offer = |time: f64, kind| {
            if first.is_none_or(|(earliest, _)| time < earliest) {
                first = Some((time, kind));
            }
        };
        let after = |index: usize, time: f64| self.balls[index].after(&self.constants, time);
        for (index, ball) in self.balls.iter().enumerate().filter(|(_, ball)| ball.moves()) {
            if ball.ends <= self.now + span {
                offer((ball.ends - self.now).clamp(0.0, span), self.end_of_motion(index));
            }
            for rail in Rail::ALL {
                let gap = |time| self.rail_gap(index, &after(index, time), rail);
                if let Some(time) = closing(gap, span) {
                    let there = after(index, time);
                    if self.approaches_rail(index, &there, rail) {
                        offer(time, self.rail_event(index, &there, rail));
                    }
                }
            }
        }
        for (one, other) in PAIRS {
            if self.can_collide(one, other) {
                let gap = |time| {
                    after(one, time).position.distance(after(other, time).position) - 2.0 * self.constants.radius
                };
                let approach = |time| {
                    let (a, b) = (after(one, time), after(other, time));
                    (a.position - b.position).dot(a.velocity - b.velocity)
                };
                if let Some(time) = closing(gap, span).filter(|&time| approach(time) < 0.0) {
                    offer(time, EventKind::BallBall(one, other));
                }
            }
        }
        first
    }

    /// Applies an event at the present time.
    fn apply_event(&mut self, kind: EventKind) -> ControlFlow<()> {
        let c = self.constants;
        if let EventKind::RollingStationary(index) = kind
            && self.rolls_on(index)
        {
            self.roll(index);
            return ControlFlow::Continue(());
        }
        if let EventKind::Lands(index) = kind {
            return self.land(index);
        }
        self.last_event = self.now;
        match kind {
            EventKind::BallBall(first, second) if self.is_aloft(first) || self.is_aloft(second) => {
                return self.collide_in_space(first, second);
            }
            EventKind::BallRail(index, rail) if self.is_aloft(index) => return self.rebound_in_space(index, rail),
            EventKind::BallBall(first, second) => {
                let [mut a, mut b] = [first, second].map(|ball| self.balls[ball].state.horizontal_state());
                self.law.balls.resolve(c.radius, &mut a, &mut b);
                self.launch(first, a);
                self.launch(second, b);
            }
            EventKind::BallRail(index, rail) => {
                let mut state = self.balls[index].state.horizontal_state();
                let impulse = self.law.cushion(rail).resolve(c.radius, rail.normal(), &mut state);
                if impulse.climb > c.least_climb {
                    let mut climbing = SpatialState::from(state);
                    climbing.velocity.z = impulse.climb;
                    self.observer.event(Event { time: self.now, kind })?;
                    return self.send_off(index, climbing);
                }
                self.launch(index, state);
            }
            // The ball rolls with its present velocity, even if the event is late.
            EventKind::SlidingRolling(index) => self.roll(index),
            EventKind::RollingStationary(index) => {
                let BallState { position, spin, .. } = self.balls[index].state.horizontal_state();
                let spin = DVec2::ZERO.extend(spin.z);
                self.launch(index, BallState { position, velocity: DVec2::ZERO, spin });
            }
            EventKind::LeavesTable(index) => self.leave(index),
            EventKind::ContactBegins(_) | EventKind::ContactEnds(_) | EventKind::Jumps(_) | EventKind::Lands(_) => {}
        }
        self.observer.event(Event { time: self.now, kind })
    }

    /// Whether a ball at the end of its segment continues to roll in the next deceleration band.
    fn rolls_on(&self, index: usize) -> bool {
        let segment = &self.balls[index].segment;
        segment.motion == Motion::Rolling && !segment.rolls_to_rest(&self.constants)
    }

    /// Makes a ball roll with its present velocity.
    fn roll(&mut self, index: usize) {
        let mut state = self.balls[index].state.horizontal_state();
        state.spin = rolling_spin(self.constants.radius, state.velocity).extend(state.spin.z);
        self.launch(index, state);
    }

    fn launch(&mut self, index: usize, state: BallState) {
        self.close(index);
        self.balls[index] = Ball::launched(&self.constants, self.now, state);
    }

    fn close(&mut self, index: usize) {
        if self.observer.wants_segments() {
            self.observer.segment(index, &self.balls[index].segment, self.now);
        }
    }

    fn finish(mut self) -> End {
        (0..BALLS).for_each(|index| self.close(index));
        let off_table = std::array::from_fn(|index| self.balls[index].segment.motion == Motion::OffTable);
        End {
            time: self.last_event,
            balls: self.balls.map(|ball| ball.state.horizontal_state()),
            off_table,
            is_exhausted: false,
        }
    }
}

/// Returns the time in `[0, span)` at which a gap closes, if it is closed at the end: by bisection, to the last bit.
fn closing(gap: impl Fn(f64) -> f64, span: f64) -> Option<f64> {
    if gap(span) >= 0.0 {
        return None;
    }
    // Closed already, as between balls that press each other: bisection would go down to the smallest number.
    if gap(0.0) < 0.0 {
        return Some(0.0);
    }
    let (mut low, mut high) = (0.0, span);
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            return Some(high);
        }
        if gap(middle) < 0.0 {
            high = middle;
        } else {
            low = middle;
        }
    }
}

#[cfg(test)]
mod tests;
