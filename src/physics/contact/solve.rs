//! The one solver of the complementarity problem: semismooth Newton steps on the laws' projections (Alart and Curnier
//! 1991), with projected Gauss-Seidel sweeps (Jourdan, Alart and Jean 1998) where they do not get on.
//!
//! Each law says that a force is the projection, on to what it may be, of itself less a multiple of the rate that it
//! resists: a normal force on to what pushes, a friction on to its disk. The residual is the largest difference of the two
//! sides; it is zero where every law holds, and the solution tells whether it came to that.

use glam::DVec2;

use super::{
    Effort,
    linear::{PROXIMITY, factorize, substitute},
    problem::{Limit, MOST_UNKNOWNS, NO_SIZES, PER_BALL, Place, Problem, Sizes, Unknown},
};
use crate::table::BALLS;

/// Forces per mass by which laws may be broken, as a share of the largest force or acceleration: some hundred roundings.
const ROUNDING: f64 = 256.0 * f64::EPSILON;

/// Newton steps before sweeps are tried. From a near active set it takes two or three, from anywhere about eight.
const NEWTON_STEPS: usize = 24;

/// A step that takes the error below this share of itself is as good as any.
const ENOUGH: f64 = 0.1;

/// A step that takes it below this share only is tried at double length, too: so does a whole step at a double root.
const DOUBLED: f64 = 0.5;

/// Halvings of a Newton step that are tried.
const MOST_HALVINGS: i32 = 14;

/// Whole Newton steps that are tried at last, and what they add to the diagonal: where a friction turns along the circle of its limit to a
/// double root, what it leaves in the laws on the way makes damped steps short.
const WHOLE_STEPS: usize = 48;
const NEXT_TO_NO_PROXIMITY: f64 = 1e-13;

/// Rounds of sweeps and Newton steps; the sweeps double from one to the next.
const ATTEMPTS: u32 = 7;
const FIRST_SWEEPS: u32 = 8;

/// Errors below this share of the largest force that a round has not halved are left as they are: such forces are at the edge of what
/// may hold them, and no round finds better ones.
const NEARLY: f64 = 1e-7;

/// What a search takes beside its steps, in multiplications: its problem is put together and copied.
const SEARCH: u64 = 2000;

/// Multiplications for one entry of its matrix: the product of two rows of all velocities and spins.
const ENTRY: usize = PER_BALL * BALLS;

/// What a law asks at present.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Side {
    /// It holds its rate at zero.
    Holds,
    /// It acts at its limit, in this direction.
    Limited(DVec2),
    /// A contact that does not push, or its friction.
    Absent,
}

/// Forces that obey the laws.
#[derive(Clone, Debug)]
pub struct Solution {
    /// Size of each scalar unknown, m/s².
    pub sizes: Sizes,
    /// What each unknown's law asks.
    pub sides: Sides,
    /// Whether every law holds to rounding.
    pub converged: bool,
}

/// The forces of a search that break the laws least so far.
struct Best {
    error: f64,
    sizes: Sizes,
}

/// What each unknown's law asks.
pub type Sides = [Side; MOST_UNKNOWNS];

/// Forces and frictions that obey all laws, sought from `guess` on.
pub fn solve(problem: &Problem, guess: &Sizes, effort: &Effort) -> Solution {
    solve_in(problem, guess, ATTEMPTS, effort)
}

/// The same if they are near to the `guess`.
pub fn solve_near(problem: &Problem, guess: &Sizes, effort: &Effort) -> Solution {
    solve_in(problem, guess, 1, effort)
}

fn solve_in(problem: &Problem, guess: &Sizes, attempts: u32, effort: &Effort) -> Solution {
    let system = System::new(problem, effort);
    let mut best = Best { error: f64::INFINITY, sizes: *guess };
    for attempt in 0..attempts {
        let error_before = best.error;
        let begin = if attempt == 0 {
            *guess
        } else {
            let (mut sizes, sweeps) = (best.sizes, FIRST_SWEEPS << (attempt - 1));
            (0..sweeps).for_each(|_| system.sweep(&mut sizes));
            sizes
        };
        if let Some(solution) = system.newton(&begin, &mut best, NEWTON_STEPS, MOST_HALVINGS, PROXIMITY) {
            return solution;
        }
        if best.error > 0.5 * error_before && best.error <= NEARLY * system.scale(&best.sizes) {
            break;
        }
    }
    let begin = best.sizes;
    if attempts > 1
        && let Some(solution) = system.newton(&begin, &mut best, WHOLE_STEPS, 1, NEXT_TO_NO_PROXIMITY)
    {
        return solution;
    }
    let mut end = Point::NOWHERE;
    system.put(&mut end, |index| best.sizes[index]);
    Solution { sizes: end.sizes, sides: end.sides, converged: false }
}

/// Where a step leads.
struct Point {
    sizes: Sizes,
    /// Forces less their projections.
    residual: Sizes,
    sides: Sides,
    /// The residual's length: how far the laws are from holding.
    error: f64,
}

impl Point {
    const NOWHERE: Self =
        Self { sizes: NO_SIZES, residual: NO_SIZES, sides: [Side::Absent; MOST_UNKNOWNS], error: f64::INFINITY };
}

/// The problem as numbers: rates are `matrix · sizes + bias`.
struct System<'a> {
    problem: &'a Problem,
    effort: &'a Effort,
    count: usize,
    matrix: Vec<f64>,
    bias: Sizes,
}

impl<'a> System<'a> {
    fn new(problem: &'a Problem, effort: &'a Effort) -> Self {
        let count = problem.rates.len();
        effort.add(SEARCH + (ENTRY * count * count) as u64);
        let mut system = Self { problem, effort, count, matrix: Vec::with_capacity(count * count), bias: NO_SIZES };
        for (row, (rate, bias)) in problem.rates.iter().zip(&problem.bias).enumerate() {
            system.bias[row] = rate.dot(&problem.known) + bias;
            system.matrix.extend(problem.forces.iter().map(|force| rate.dot(force)));
        }
        system
    }

    /// Newton steps from `sizes` on, with so many halvings at most; keeps the `best` of all forces.
    fn newton(
        &self,
        sizes: &Sizes,
        best: &mut Best,
        steps: usize,
        most_halvings: i32,
        proximity: f64,
    ) -> Option<Solution> {
        // Points are large: they change places rather than being moved.
        let mut points = [Point::NOWHERE; 3];
        let [here, next, spare] = &mut points;
        let (mut here, mut next, mut spare) = (here, next, spare);
        let mut jacobian = Vec::with_capacity(self.count * self.count);
        self.put(here, |index| sizes[index]);
        for _ in 0..steps {
            if here.error < best.error {
                (best.error, best.sizes) = (here.error, here.sizes);
            }
            if here.error <= ROUNDING * self.scale(&here.sizes) {
                return Some(Solution { sizes: here.sizes, sides: here.sides, converged: true });
            }
            let change = self.newton_step(here, &mut jacobian, proximity)?;
            (next, spare) = self.step(here, &change, most_halvings, [next, spare]);
            std::mem::swap(&mut here, &mut next);
        }
        None
    }

    /// Takes the whole step where it brings the laws nearer to hold, else the share of it that does so most: the first of the two points
    /// that it returns. At a double root the whole step leaves a quarter of the error, and the doubled one hardly any (Rall 1966).
    fn step<'p>(
        &self,
        here: &Point,
        change: &Sizes,
        most_halvings: i32,
        [mut best, mut other]: [&'p mut Point; 2],
    ) -> (&'p mut Point, &'p mut Point) {
        let go = |share: f64, point: &mut Point| self.put(point, |index| here.sizes[index] + share * change[index]);
        go(1.0, best);
        if best.error < ENOUGH * here.error {
            return (best, other);
        }
        if best.error < DOUBLED * here.error {
            go(2.0, other);
            return if other.error < best.error { (other, best) } else { (best, other) };
        }
        for halvings in 1..most_halvings {
            go(0.5_f64.powi(halvings), other);
            if other.error < best.error {
                std::mem::swap(&mut best, &mut other);
            } else if best.error < here.error {
                break;
            }
        }
        (best, other)
    }

    /// Puts a point where the sizes are these.
    fn put(&self, point: &mut Point, size: impl Fn(usize) -> f64) {
        for (index, place) in point.sizes[..self.count].iter_mut().enumerate() {
            *place = size(index);
        }
        self.residual(&point.sizes, &mut point.residual, &mut point.sides);
        point.error = point.residual[..self.count].iter().fold(0.0, |sum, x| sum + x * x).sqrt();
    }

    fn row(&self, index: usize) -> &[f64] {
        &self.matrix[index * self.count..][..self.count]
    }

    fn rate(&self, index: usize, sizes: &Sizes) -> f64 {
        self.bias[index] + self.row(index).iter().zip(sizes).map(|(w, x)| w * x).sum::<f64>()
    }

    /// The largest of all forces and accelerations, m/s², whose rounding the residual has.
    fn scale(&self, sizes: &Sizes) -> f64 {
        self.bias[..self.count]
            .iter()
            .chain(&sizes[..self.count])
            .fold(f64::MIN_POSITIVE, |largest, x| largest.max(x.abs()))
    }

    /// How strongly an unknown's rates answer to its force: the same for both rows of a friction, which keeps its direction.
    fn response(&self, unknown: &Unknown) -> f64 {
        let rows = unknown.first..unknown.first + unknown.count;
        rows.map(|index| self.row(index)[index]).fold(f64::MIN_POSITIVE, f64::max)
    }

    /// The force of which a law takes the projection: `z = f - rate/w` with the response `w`.
    fn wanted(&self, sizes: &Sizes, index: usize, response: f64) -> f64 {
        sizes[index] - self.rate(index, sizes) / response
    }

    /// How a law answers to its rates: the projected force, and which side it is on.
    fn project(&self, unknown: &Unknown, sizes: &Sizes) -> (DVec2, Side) {
        let first = unknown.first;
        let response = self.response(unknown);
        let wanted = |index: usize| self.wanted(sizes, index, response);
        if let Place::Normal(_) = unknown.place {
            let force = wanted(first);
            let pushes = force > 0.0 && !matches!(unknown.limit, Limit::Fixed(0.0));
            return if pushes { (DVec2::new(force, 0.0), Side::Holds) } else { (DVec2::ZERO, Side::Absent) };
        }
        let force = DVec2::new(wanted(first), if unknown.count == 2 { wanted(first + 1) } else { 0.0 });
        let limit = match unknown.limit {
            Limit::Fixed(limit) => limit,
            Limit::Coulomb(_, contact) if sizes[contact] <= 0.0 => 0.0,
            Limit::Coulomb(mu, contact) => mu * sizes[contact],
        };
        if limit <= 0.0 {
            (DVec2::ZERO, Side::Absent)
        } else if force.length_squared() <= limit * limit {
            (force, Side::Holds)
        } else {
            let direction = force.normalize();
            (limit * direction, Side::Limited(direction))
        }
    }

    /// Forces less their projections, and the side of each law.
    fn residual(&self, sizes: &Sizes, residual: &mut Sizes, sides: &mut Sides) {
        self.effort.add((self.count * self.count) as u64);
        for (unknown, side) in self.problem.unknowns.iter().zip(sides) {
            let force;
            (force, *side) = self.project(unknown, sizes);
            for (axis, projected) in force.to_array().into_iter().take(unknown.count).enumerate() {
                residual[unknown.first + axis] = sizes[unknown.first + axis] - projected;
            }
        }
    }

    /// A Newton step; `None` where its system is singular.
    fn newton_step(&self, point: &Point, jacobian: &mut Vec<f64>, proximity: f64) -> Option<Sizes> {
        let Point { sizes, residual, sides, .. } = point;
        let n = self.count;
        self.effort.add((n * n * (n + 6) / 3) as u64);
        jacobian.clear();
        jacobian.resize(n * n, 0.0);
        let mut change = NO_SIZES;
        for (unknown, side) in self.problem.unknowns.iter().zip(sides) {
            for axis in 0..unknown.count {
                let index = unknown.first + axis;
                let entries = &mut jacobian[index * n..][..n];
                match *side {
                    Side::Holds => {
                        entries.copy_from_slice(self.row(index));
                        entries[index] += proximity;
                        change[index] = -self.rate(index, sizes);
                    }
                    Side::Absent => {
                        entries[index] = 1.0;
                        change[index] = -sizes[index];
                    }
                    Side::Limited(direction) => {
                        change[index] = -residual[index];
                        self.limited(unknown, axis, direction, sizes, entries);
                    }
                }
            }
        }
        let mut pivots = [0; MOST_UNKNOWNS];
        if factorize(jacobian, &mut pivots[..n]) == 0.0 {
            return None;
        }
        substitute(jacobian, &pivots[..n], &mut change[..n]);
        change.iter().all(|x| x.is_finite()).then_some(change)
    }

    /// A row of the derivative of `f - L z/|z|` with `z = f - rate/w`: the limit grows with its normal force, and the
    /// direction turns with `z`.
    fn limited(&self, unknown: &Unknown, axis: usize, direction: DVec2, sizes: &Sizes, entries: &mut [f64]) {
        let n = self.count;
        let response = self.response(unknown);
        let mut limit = 0.0;
        match unknown.limit {
            Limit::Fixed(fixed) => limit = fixed,
            Limit::Coulomb(mu, contact) => {
                limit += mu * sizes[contact];
                entries[contact] -= mu * direction[axis];
            }
        }
        entries[unknown.first + axis] += 1.0;
        if unknown.count == 2 {
            let z = |index: usize| self.wanted(sizes, index, response);
            let length = DVec2::new(z(unknown.first), z(unknown.first + 1)).length();
            for other in 0..2 {
                let across = f64::from(u8::from(axis == other)) - direction[axis] * direction[other];
                let share = -limit / length * across;
                let index = unknown.first + other;
                entries[index] += share;
                for (entry, w) in entries[..n].iter_mut().zip(self.row(index)) {
                    *entry -= share / response * w;
                }
            }
        }
    }

    /// Satisfies one law after another with the others held.
    fn sweep(&self, sizes: &mut Sizes) {
        self.effort.add((self.count * self.count) as u64);
        for unknown in &self.problem.unknowns {
            let (force, _) = self.project(unknown, sizes);
            sizes[unknown.first..][..unknown.count].copy_from_slice(&force.to_array()[..unknown.count]);
        }
    }
}
