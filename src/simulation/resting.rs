//! Resting contacts in time: adaptive integration of balls pressed against cushions or each other.
//!
//! The equations have no closed form, since the slip turns under the friction of cloth and cushion together. They are
//! integrated by the fifth-order pair of Dormand and Prince (1980) with an error of at most [`TOLERANCE`] a step; a
//! contact takes some tens of steps, so that it adds less than 1e-11 m to a ball's place.

use glam::{DVec2, DVec3};

use super::{Constants, Rail, predict::TOUCHING, segment::Curve};
use crate::{
    physics::{BallState, Forces, Laws, MAX_TOUCHES, Touch, contact_forces, rolling_spin, slip},
    table::{BALLS, Table},
};

/// Estimated error that a step may make in metres, m/s, or R times rad/s.
const TOLERANCE: f64 = 1e-13;

/// Shortest step, s. In it a speed changes by less than the tolerance of what is called slip.
const SHORTEST_STEP: f64 = 1e-13;

/// Step that is tried first, s.
const FIRST_STEP: f64 = 2e-2;

/// A slip or speed may use up this share of itself in a step, so that its direction stays known.
const STOPPING_SHARE: f64 = 0.9;

/// Contacts that open more slowly than this and are pressed stay closed, m/s: they would close again within 1e-8 s, without
/// end where two of them feed each other.
const SLOWEST_OPENING: f64 = 1e-9;

/// Balls in resting contact that are all slower than this many m/s are at rest. They would go on for less than 1e-10 m,
/// in ever smaller steps as their slips fade with their speeds.
pub const STILL_AT_REST: f64 = 3e-6;

/// Pairs of balls, in the order used everywhere.
pub const PAIRS: [(usize, usize); 3] = [(0, 1), (0, 2), (1, 2)];

/// One step of the balls that rest against something.
#[derive(Clone, Debug)]
pub struct Resting {
    /// The balls that take part.
    pub members: [bool; BALLS],
    /// Time at which the step begins, s.
    pub start: f64,
    /// Length of the step, s.
    pub step: f64,
    /// State at its end.
    pub end: [BallState; BALLS],
    begin: [BallState; BALLS],
    touches: Touches,
    laws: Laws,
    first: Forces,
    last: Forces,
}

/// The contacts, in a fixed order.
#[derive(Clone, Copy, Debug)]
struct Touches {
    list: [Touch; MAX_TOUCHES],
    count: usize,
}

impl Touches {
    const NONE: Touch = Touch { first: 0, second: None, rail_normal: DVec2::ZERO };

    /// All contacts of the balls that do not open.
    fn of(constants: &Constants, balls: &[BallState; BALLS]) -> Self {
        let mut touches = Self { list: [Self::NONE; MAX_TOUCHES], count: 0 };
        for (first, ball) in balls.iter().enumerate() {
            for rail in Rail::ALL {
                let normal = rail.normal();
                let gap = normal.abs().dot(constants.reach) + ball.position.dot(normal);
                if gap <= TOUCHING {
                    touches.add(Touch { first, second: None, rail_normal: normal }, balls);
                }
            }
        }
        for (first, second) in PAIRS {
            let gap = balls[first].position.distance(balls[second].position) - 2.0 * constants.radius;
            if gap <= TOUCHING {
                touches.add(Touch { first, second: Some(second), rail_normal: DVec2::ZERO }, balls);
            }
        }
        touches
    }

    fn add(&mut self, touch: Touch, balls: &[BallState; BALLS]) {
        if touch.opening_speed(balls).abs() <= SLOWEST_OPENING && self.count < MAX_TOUCHES {
            self.list[self.count] = touch;
            self.count += 1;
        }
    }

    fn as_slice(&self) -> &[Touch] {
        &self.list[..self.count]
    }
}

impl Resting {
    /// One step from `balls` at time `start`, or `None` where no contact presses.
    pub fn begin(table: &Table, constants: &Constants, start: f64, balls: &[BallState; BALLS]) -> Option<Self> {
        let mut begin = *balls;
        let mut touches = Touches::of(constants, &begin);
        settle(table, &mut begin, touches.as_slice());
        let mut laws = Laws::of(table.radius, &begin, touches.as_slice());
        let mut first = contact_forces(table, &begin, touches.as_slice(), &laws, None);
        // A contact that does not push holds nothing: it is no part of the step.
        let pushing: Vec<Touch> = touches
            .as_slice()
            .iter()
            .zip(first.normal)
            .filter_map(|(touch, normal)| (normal > TOLERANCE).then_some(*touch))
            .collect();
        if pushing.is_empty() {
            return None;
        }
        if pushing.len() < touches.count {
            touches.count = pushing.len();
            touches.list[..pushing.len()].copy_from_slice(&pushing);
            laws = Laws::of(table.radius, &begin, touches.as_slice());
            first = contact_forces(table, &begin, touches.as_slice(), &laws, None);
        }
        let mut members = [false; BALLS];
        for touch in touches.as_slice() {
            members[touch.first] = true;
            if let Some(second) = touch.second {
                members[second] = true;
            }
        }
        let mut resting = Self { members, start, step: 0.0, end: begin, begin, touches, laws, first, last: first };
        resting.advance(table);
        Some(resting)
    }

    /// Chooses the step and takes it.
    fn advance(&mut self, table: &Table) {
        let mut step = self.longest_step(table.radius).min(FIRST_STEP);
        loop {
            let (end, error) = self.dormand_prince(table, step);
            if error <= 1.0 || step <= SHORTEST_STEP {
                self.step = step;
                self.end = end;
                break;
            }
            step = (step * (0.9 * error.powf(-0.2)).max(0.1)).max(SHORTEST_STEP);
        }
        self.last = contact_forces(table, &self.end, self.touches.as_slice(), &self.laws, Some(&self.first));
        settle(table, &mut self.end, self.touches.as_slice());
    }

    /// Longest step after which every slip, speed and spin still has its direction, s.
    fn longest_step(&self, radius: f64) -> f64 {
        let mut longest = f64::INFINITY;
        let mut limit = |size: f64, rate: f64| {
            if rate < 0.0 {
                longest = longest.min(STOPPING_SHARE * size / -rate);
            }
        };
        for ball in (0..BALLS).filter(|&ball| self.members[ball]) {
            let state = &self.begin[ball];
            let (linear, angular) = (self.first.linear[ball], self.first.angular[ball]);
            if self.laws.slips[ball] {
                let u = slip(radius, state.velocity, state.spin);
                limit(u.length(), slip(radius, linear, angular).dot(u.normalize()));
            } else if self.laws.moves[ball] {
                limit(state.velocity.length(), linear.dot(state.velocity.normalize()));
            }
            if self.laws.spins[ball] {
                limit(state.spin.z.abs(), angular.z * state.spin.z.signum());
            }
        }
        longest.max(SHORTEST_STEP)
    }

    /// State `time` seconds after the start of the step, by one shorter step of the same method.
    pub fn after(&self, table: &Table, time: f64) -> [BallState; BALLS] {
        if time >= self.step {
            return self.end;
        }
        let (mut balls, _) = self.dormand_prince(table, time);
        settle(table, &mut balls, self.touches.as_slice());
        balls
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
        let position = [
            (20.0 * moved - h * (8.0 * v1 + 12.0 * v0) - h * h * (3.0 * a0 - a1)) / (2.0 * h.powi(3)),
            (-30.0 * moved + h * (14.0 * v1 + 16.0 * v0) + h * h * (3.0 * a0 - 2.0 * a1)) / (2.0 * h.powi(4)),
            (12.0 * moved - 6.0 * h * (v1 + v0) - h * h * (a0 - a1)) / (2.0 * h.powi(5)),
        ];
        let (w0, w1) = (self.first.angular[ball], self.last.angular[ball]);
        let mean = (p1.spin - p0.spin) / h;
        let spin = [w0, (3.0 * mean - 2.0 * w0 - w1) / h, (w0 + w1 - 2.0 * mean) / (h * h)];
        (0.5 * a0, Curve { position, spin })
    }

    /// One step of the Dormand–Prince pair; the error is in units of [`TOLERANCE`].
    fn dormand_prince(&self, table: &Table, h: f64) -> ([BallState; BALLS], f64) {
        let mut slopes = [[BallState::at_rest(DVec2::ZERO); BALLS]; 7];
        slopes[0] = slope(&self.begin, &self.first);
        let mut forces = self.first;
        let mut balls = self.begin;
        for stage in 1..7 {
            balls = self.combine(&slopes, A[stage - 1], h);
            forces = contact_forces(table, &balls, self.touches.as_slice(), &self.laws, Some(&forces));
            slopes[stage] = slope(&balls, &forces);
        }
        let mut error = 0.0_f64;
        for ball in (0..BALLS).filter(|&ball| self.members[ball]) {
            let mut difference = [DVec3::ZERO; 3];
            for (slopes, weight) in slopes.iter().zip(E) {
                difference[0] += weight * h * slopes[ball].position.extend(0.0);
                difference[1] += weight * h * slopes[ball].velocity.extend(0.0);
                difference[2] += weight * h * table.radius * slopes[ball].spin;
            }
            error = difference.iter().fold(error, |error, d| error.max(d.length()));
        }
        (balls, error / TOLERANCE)
    }

    fn combine(&self, slopes: &[[BallState; BALLS]; 7], weights: &[f64], h: f64) -> [BallState; BALLS] {
        let mut balls = self.begin;
        for ball in (0..BALLS).filter(|&ball| self.members[ball]) {
            for (slopes, weight) in slopes.iter().zip(weights) {
                balls[ball].position += h * weight * slopes[ball].position;
                balls[ball].velocity += h * weight * slopes[ball].velocity;
                balls[ball].spin += h * weight * slopes[ball].spin;
            }
        }
        balls
    }
}

fn slope(balls: &[BallState; BALLS], forces: &Forces) -> [BallState; BALLS] {
    std::array::from_fn(|ball| BallState {
        position: balls[ball].velocity,
        velocity: forces.linear[ball],
        spin: forces.angular[ball],
    })
}

/// Takes the rounding out of the state: contacts are closed and do not open, and what has stopped slipping, moving or
/// spinning has stopped exactly.
fn settle(table: &Table, balls: &mut [BallState; BALLS], touches: &[Touch]) {
    let laws = Laws::of(table.radius, balls, touches);
    for (ball, state) in balls.iter_mut().enumerate() {
        if !laws.slips[ball] {
            // What is left of the slip ends as sliding does.
            state.velocity -= slip(table.radius, state.velocity, state.spin) * (2.0 / 7.0);
            state.spin = rolling_spin(table.radius, state.velocity).extend(state.spin.z);
        }
        if !laws.spins[ball] {
            state.spin.z = 0.0;
        }
    }
    for (touch, rubs) in touches.iter().zip(laws.rubs) {
        let never_slips = touch.second.is_some() && table.ball_friction.is_none();
        if !rubs || never_slips {
            touch.stop_slip(table.radius, balls);
        }
    }
    // Corrections of one contact open another by less each time; three balls need a few rounds.
    for _ in 0..8 {
        for touch in touches {
            let n = touch.normal(balls);
            let opening = touch.opening_speed(balls);
            match touch.second {
                None => balls[touch.first].velocity -= opening * n,
                Some(second) => {
                    balls[touch.first].velocity -= 0.5 * opening * n;
                    balls[second].velocity += 0.5 * opening * n;
                    let gap = balls[touch.first].position.distance(balls[second].position) - 2.0 * table.radius;
                    balls[touch.first].position -= 0.5 * gap * n;
                    balls[second].position += 0.5 * gap * n;
                }
            }
        }
    }
}

/// Stages of the pair (Hairer, Nørsett and Wanner, Solving Ordinary Differential Equations I, table II.5.2).
const A: [&[f64]; 6] = [
    &[1.0 / 5.0],
    &[3.0 / 40.0, 9.0 / 40.0],
    &[44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0],
    &[19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0],
    &[9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0],
    &[35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0],
];

/// Difference of the fifth- and fourth-order weights.
const E: [f64; 7] =
    [71.0 / 57600.0, 0.0, -71.0 / 16695.0, 71.0 / 1920.0, -17253.0 / 339_200.0, 22.0 / 525.0, -1.0 / 40.0];
