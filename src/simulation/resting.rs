//! Resting contacts in time: adaptive integration of balls pressed against cushions or each other.
//!
//! The equations have no closed form, since the slip turns under the friction of cloth and cushion together. They are
//! integrated with an estimated error of at most [`TOLERANCE`] a step, from one change of regime to the next; a contact
//! takes some tens of steps, so that it adds less than 1e-11 m to a ball's place.

use std::cmp::Ordering;

use glam::DVec2;

use super::{
    Constants, Rail,
    extrapolation::{State, Step, extrapolate},
    segment::Curve,
    touches::{SLOWEST_OPENING, Touches},
};
use crate::{
    physics::{
        BallState, ENDING_SLIP, Forces, Laws, SLIP_TOLERANCE, Touch, contact_forces, forces_in_regime, rolling_spin,
        slip, stop_by_impulses,
    },
    table::{BALLS, Table},
};

/// Estimated error that a step may make in metres, m/s, or R times rad/s, in a shot that does not go on and on.
const TOLERANCE: f64 = 1e-13;

/// Forces per mass that are broken or missing by less than this count as rounding, m/s².
const SLACK: f64 = 1e-11;

/// The same for accelerations where forces are not unique, m/s².
const SHARED_SLACK: f64 = 1e-8;

/// Shortest step, s. In it a speed changes by less than the tolerance of what is called slip.
const SHORTEST_STEP: f64 = 1e-13;

/// Shortest and longest step in which something begins to slip, s: its friction has no direction yet, and is wrong by less
/// than what changes a speed by [`SLIP_TOLERANCE`].
const SHORTEST_DEPARTURE: f64 = 1e-10;
const LONGEST_DEPARTURE: f64 = 1e-5;

/// A slip or speed may use up this share of itself in a step, so that its direction stays known.
const STOPPING_SHARE: f64 = 0.9;

/// Longest step in s for a slip that turns in a time of one second; it grows with the time's power 2/3. The course is
/// handed on as a polynomial of degree five, which strays by about `a h⁶/(2000 turn⁴)` in a step of `h` seconds: less
/// than 1e-10 m for accelerations `a` of a few m/s².
const LONGEST_STEP: f64 = 0.06;

/// Longest step of all, s: courses along which nothing slips bend, too.
const LONGEST_CURVE: f64 = 0.02;

/// In steps shorter than this many seconds the places at both ends, rounded to 1e-16 m, say less about the velocity than
/// the velocities themselves.
const SHORTEST_QUINTIC: f64 = 1e-4;

/// Most guesses at the moment at which a law breaks; false position needs about ten.
const MAX_GUESSES: usize = 60;

/// Steps that needed more rounds of extrapolation than this are followed by shorter ones, those with fewer by longer.
const GOOD_ROUNDS: usize = 5;

/// Balls in resting contact that are all slower than this many m/s are at rest. They would go on for less than 1e-10 m,
/// in ever smaller steps as their slips fade with their speeds.
pub const STILL_AT_REST: f64 = 3e-6;

/// One step of the balls that rest against something.
#[derive(Clone, Debug)]
pub struct Resting {
    /// The balls that take part.
    pub members: [bool; BALLS],
    /// Time at which the step begins, s.
    pub start: f64,
    /// Length of the step, s.
    pub step: f64,
    /// State at its beginning: what has stopped slipping there has stopped exactly.
    pub begin: State,
    /// State at its end.
    pub end: State,
    touches: Touches,
    laws: Laws,
    first: Forces,
    last: Forces,
    /// Step that is tried next, s.
    next_step: f64,
    /// Estimated error that a step may make in metres, m/s, or R times rad/s.
    tolerance: f64,
}

/// A step that is tried, and the forces at its end in the regime of its beginning.
#[derive(Clone, Copy, Debug)]
struct Trial {
    length: f64,
    step: Step,
    forces: Forces,
}

impl Resting {
    /// One step from `balls` at time `start`, or `None` where no contact presses. The `previous` step, if there is one,
    /// tells how long the step may be.
    pub fn begin(
        table: &Table,
        constants: &Constants,
        start: f64,
        balls: &State,
        previous: Option<&Self>,
        coarseness: f64,
    ) -> Option<Self> {
        let mut touches = Touches::of(constants, balls, SLOWEST_OPENING * coarseness.min(1e3));
        let ending = ENDING_SLIP * coarseness.min(1e4);
        let (begin, laws, first) = loop {
            if touches.as_slice().is_empty() {
                return None;
            }
            let (begin, laws, first) = lawful(table, balls, touches.as_slice(), ending);
            // A contact that does not push holds nothing: it is no part of the step, and its opening goes on.
            let mut normals = first.normal.iter();
            if !touches.retain(|_| normals.next().is_some_and(|normal| *normal > SLACK)) {
                break (begin, laws, first);
            }
        };
        let mut members = [false; BALLS];
        for touch in touches.as_slice() {
            members[touch.first] = true;
            if let Some(second) = touch.second {
                members[second] = true;
            }
        }
        let next_step = previous.map_or(f64::INFINITY, |previous| previous.next_step);
        let tolerance = TOLERANCE * coarseness.min(1e4);
        let mut resting = Self {
            members,
            start,
            step: 0.0,
            end: begin,
            begin,
            touches,
            laws,
            first,
            last: first,
            next_step,
            tolerance,
        };
        resting.advance(table);
        Some(resting)
    }

    /// Chooses the step and takes it.
    fn advance(&mut self, table: &Table) {
        let mut trial = self.attempt(table, self.longest_step(table.radius).min(self.next_step).max(SHORTEST_STEP));
        while trial.step.error > self.tolerance && trial.length > SHORTEST_STEP {
            trial = self.attempt(table, (0.4 * trial.length).max(SHORTEST_STEP));
        }
        let growth = match trial.step.rounds.cmp(&GOOD_ROUNDS) {
            Ordering::Less => 2.0,
            Ordering::Equal => 1.2,
            Ordering::Greater => 0.7,
        };
        // Never so short that a long series of steps could not grow out of it.
        self.next_step = (growth * trial.length).max(1e3 * SHORTEST_STEP);
        // A step in which something begins to slip is too short for laws to matter.
        let settled = self.first.departure == 0.0;
        let doubtful = trial.forces.slack < -SLACK || self.first.is_shared();
        if settled && doubtful && !self.holds(table, &trial) {
            trial = self.until_a_law_breaks(table, &trial);
        }
        self.step = trial.length;
        self.last = trial.forces;
        self.end = self.settled(table, trial.step.end);
    }

    fn attempt(&self, table: &Table, length: f64) -> Trial {
        let step = self.integrate(table, length);
        Trial { length, step, forces: self.forces(table, &step.end) }
    }

    /// Shortens a step at whose end a law of its regime is broken to just after the moment when that happened.
    fn until_a_law_breaks(&self, table: &Table, whole: &Trial) -> Trial {
        if whole.forces.slack < -SLACK {
            let shorter = self.until_the_slack_ends(table, whole);
            if !self.holds(table, &shorter) {
                return shorter;
            }
        }
        self.while_it_holds(table, whole)
    }

    /// Finds the zero of `slack + SLACK`, by false position with the Illinois rule.
    fn until_the_slack_ends(&self, table: &Table, whole: &Trial) -> Trial {
        let mut after = *whole;
        let (mut low, mut low_value) = (0.0, (self.first.slack + SLACK).max(0.0));
        let mut high_value = after.forces.slack + SLACK;
        for _ in 0..MAX_GUESSES {
            if high_value >= -SLACK || after.length - low <= SHORTEST_STEP {
                break;
            }
            let share = (low_value / (low_value - high_value)).clamp(0.01, 0.99);
            let middle = self.attempt(table, low + share * (after.length - low));
            let value = middle.forces.slack + SLACK;
            if value < 0.0 {
                (after, high_value) = (middle, value);
                low_value *= 0.5;
            } else {
                (low, low_value) = (middle.length, value);
                high_value *= 0.5;
            }
        }
        after
    }

    /// The same where what is held is held more than once, so that only trying tells how long it holds.
    fn while_it_holds(&self, table: &Table, whole: &Trial) -> Trial {
        let mut after = *whole;
        let mut low = 0.0;
        while after.length - low > SHORTEST_STEP.max(1e-9 * after.length) {
            let middle = self.attempt(table, 0.5 * (low + after.length));
            if self.holds(table, &middle) {
                low = middle.length;
            } else {
                after = middle;
            }
        }
        after
    }

    /// Whether the forces at a step's end are those that obey all laws.
    fn holds(&self, table: &Table, trial: &Trial) -> bool {
        let Trial { step, forces, .. } = trial;
        let lawful = contact_forces(table, &step.end, self.touches.as_slice(), &self.laws, Some(forces));
        forces.distance(&lawful, table.radius) <= SHARED_SLACK
    }

    /// Longest step after which every slip, speed and spin still has its direction, and whose course a polynomial can
    /// follow, s.
    fn longest_step(&self, radius: f64) -> f64 {
        let mut longest = LONGEST_CURVE;
        let mut limit = |size: DVec2, rate: DVec2| {
            let falling = -rate.dot(size) / size.length();
            if falling > 0.0 {
                longest = longest.min(STOPPING_SHARE * size.length() / falling);
            }
            let turns = size.length() / rate.length();
            longest = longest.min(LONGEST_STEP * turns.powf(2.0 / 3.0));
        };
        let rates: State = std::array::from_fn(|ball| BallState {
            position: self.begin[ball].position,
            velocity: self.first.linear[ball],
            spin: self.first.angular[ball],
        });
        for ball in (0..BALLS).filter(|&ball| self.members[ball]) {
            let (state, rate) = (&self.begin[ball], &rates[ball]);
            if self.laws.slips[ball] {
                limit(slip(radius, state.velocity, state.spin), slip(radius, rate.velocity, rate.spin));
            } else if self.laws.moves[ball] {
                limit(state.velocity, rate.velocity);
            }
            if self.laws.spins[ball] {
                limit(DVec2::new(state.spin.z, 0.0), DVec2::new(rate.spin.z, 0.0));
            }
        }
        for (touch, rubs) in self.touches.as_slice().iter().zip(self.laws.rubs) {
            if rubs {
                limit(touch.slip(radius, &self.begin), touch.slip(radius, &rates));
            }
        }
        if self.first.departure > 0.0 {
            // What begins to slip has no direction yet: it gets one.
            let long_enough = 3.0 * SLIP_TOLERANCE / self.first.departure;
            longest = longest.min(long_enough.clamp(SHORTEST_DEPARTURE, LONGEST_DEPARTURE));
        }
        longest
    }

    /// State `time` seconds after the start of the step, by one shorter step of the same method.
    pub fn after(&self, table: &Table, time: f64) -> State {
        if time >= self.step {
            return self.end;
        }
        self.settled(table, self.integrate(table, time).end)
    }

    /// Takes the rounding out of a later state.
    fn settled(&self, table: &Table, mut balls: State) -> State {
        let laws = Laws::of(table.radius, &balls, self.touches.as_slice(), SLIP_TOLERANCE);
        settle(table, &mut balls, self.touches.as_slice(), &laws);
        balls
    }

    fn integrate(&self, table: &Table, length: f64) -> Step {
        let slope = |state: &State| self.slope(state, &self.forces(table, state));
        extrapolate(&self.begin, &self.slope(&self.begin, &self.first), slope, length, table.radius, self.tolerance)
    }

    /// The forces in this step's regime.
    fn forces(&self, table: &Table, state: &State) -> Forces {
        forces_in_regime(table, state, self.touches.as_slice(), &self.laws, &self.first)
    }

    fn slope(&self, state: &State, forces: &Forces) -> State {
        std::array::from_fn(|ball| {
            if self.members[ball] {
                BallState { position: state[ball].velocity, velocity: forces.linear[ball], spin: forces.angular[ball] }
            } else {
                BallState::at_rest(DVec2::ZERO)
            }
        })
    }

    /// Whether these two balls press each other.
    pub fn holds_together(&self, pair: (usize, usize)) -> bool {
        self.touches.as_slice().iter().any(|touch| (touch.first, touch.second) == (pair.0, Some(pair.1)))
    }

    /// Whether this cushion holds the ball.
    pub fn holds_at(&self, ball: usize, rail: Rail) -> bool {
        let held = Touch { first: ball, second: None, rail_normal: rail.normal() };
        self.touches.as_slice().contains(&held)
    }

    /// Half the acceleration at the start of the step, and the rest of a ball's course as polynomials.
    pub fn course(&self, ball: usize) -> (DVec2, Curve) {
        let h = self.step;
        let (p0, p1) = (&self.begin[ball], &self.end[ball]);
        let (a0, a1) = (self.first.linear[ball], self.last.linear[ball]);
        let moved = p1.position - p0.position;
        let (v0, v1) = (p0.velocity, p1.velocity);
        let position = if h > SHORTEST_QUINTIC {
            [
                (20.0 * moved - h * (8.0 * v1 + 12.0 * v0) - h * h * (3.0 * a0 - a1)) / (2.0 * h.powi(3)),
                (-30.0 * moved + h * (14.0 * v1 + 16.0 * v0) + h * h * (3.0 * a0 - 2.0 * a1)) / (2.0 * h.powi(4)),
                (12.0 * moved - 6.0 * h * (v1 + v0) - h * h * (a0 - a1)) / (2.0 * h.powi(5)),
            ]
        } else {
            let mean = (v1 - v0) / h;
            [(3.0 * mean - 2.0 * a0 - a1) / (3.0 * h), (a0 + a1 - 2.0 * mean) / (4.0 * h * h), DVec2::ZERO]
        };
        let (w0, w1) = (self.first.angular[ball], self.last.angular[ball]);
        let mean = (p1.spin - p0.spin) / h;
        let spin = [w0, (3.0 * mean - 2.0 * w0 - w1) / h, (w0 + w1 - 2.0 * mean) / (h * h)];
        (0.5 * a0, Curve { position, spin })
    }
}

/// The state without the slips that end here, the laws that hold then, and the forces.
fn lawful(table: &Table, balls: &State, touches: &[Touch], ending: f64) -> (State, Laws, Forces) {
    let mut balls = *balls;
    if table.ball_friction.is_none() {
        // Balls that never slip stop slipping as soon as they press, however little: as in a collision of theirs (17),
        // where the cloth has no time to take part.
        stop_by_impulses(table, &mut balls, touches, &Laws::SLIPPING);
    }
    let stopped = |none: f64| {
        let laws = Laws::of(table.radius, &balls, touches, none);
        let mut begin = balls;
        settle(table, &mut begin, touches, &laws);
        let forces = contact_forces(table, &begin, touches, &laws, None);
        (begin, laws, forces)
    };
    let ended = stopped(ending);
    // What would begin to slip again at once has not ended.
    if ended.2.departure > 0.0 { stopped(SLIP_TOLERANCE) } else { ended }
}

/// Takes the rounding out of the state: contacts are closed and do not open, and what has stopped slipping, moving or
/// spinning by `laws` has stopped exactly.
fn settle(table: &Table, balls: &mut State, touches: &[Touch], laws: &Laws) {
    for touch in touches {
        if let Some(second) = touch.second {
            let n = touch.normal(balls);
            let gap = balls[touch.first].position.distance(balls[second].position) - 2.0 * table.radius;
            balls[touch.first].position -= 0.5 * gap * n;
            balls[second].position += 0.5 * gap * n;
        }
    }
    stop_by_impulses(table, balls, touches, laws);
    for (ball, state) in balls.iter_mut().enumerate() {
        if !touches.iter().any(|touch| touch.first == ball || touch.second == Some(ball)) {
            continue;
        }
        if !laws.spins[ball] {
            state.spin.z = 0.0;
        }
        if !laws.slips[ball] {
            if !laws.moves[ball] {
                state.velocity = DVec2::ZERO;
            }
            state.spin = rolling_spin(table.radius, state.velocity).extend(state.spin.z);
        }
    }
}
