//! The only solver of the complementarity problem: semismooth Newton steps on the projection form of the laws (Alart and Curnier 1991),
//! with projected Gauss-Seidel sweeps (Jourdan, Alart and Jean 1998) when Newton makes no progress.
//!
//! Each law states that a force equals its projection onto its admissible set after a multiple of the resisted rate is subtracted: for a
//! normal force the set is the half-line of pushes, for a friction its disk. The error is the Euclidean norm of the differences of the two
//! sides. It is zero if every law holds; the solution states whether that was reached.

use glam::DVec2;

use super::{
    Effort,
    linear::{PROXIMITY, factorize, substitute},
    problem::{ForceKind, Limit, MAX_UNKNOWNS, Problem, Unknown, Values, ZERO_VALUES},
};

/// Accepted violation of the laws, as a share of the largest force or acceleration per mass: some hundred roundings.
const ROUNDING: f64 = 256.0 * f64::EPSILON;

/// Newton steps before sweeps are tried. From a nearby active set two or three are enough, from an arbitrary one about eight.
const NEWTON_STEPS: usize = 24;

/// Newton steps without a smaller error after which the search stops. In the slowest shots, one in a thousand of the searches
/// that succeed has more such steps, and three in four of those that fail.
const MAX_FAILURES: u32 = 6;

/// A step that reduces the error below this share is accepted at once.
const ENOUGH: f64 = 0.1;

/// A step that reduces the error only below this share is also tried at double length: at a double root, a whole step behaves like this.
const DOUBLED: f64 = 0.5;

/// Bound on the halvings of a Newton step.
const MAX_HALVINGS: i32 = 14;

/// Number of undamped Newton steps as a last resort, and their regularization of the diagonal. If a friction rotates along its limit circle
/// towards a double root, the residual along the way would make damped steps short.
const WHOLE_STEPS: usize = 48;
const NEXT_TO_NO_PROXIMITY: f64 = 1e-13;

/// Rounds of sweeps and Newton steps; the number of sweeps doubles in each round.
pub const ATTEMPTS: u32 = 7;
const FIRST_SWEEPS: u32 = 8;

/// If the error is below this share of the largest force and a round has not halved it, the search stops: such forces are at the edge of
/// their admissible sets, and no round finds better ones.
const NEARLY: f64 = 1e-7;

/// Costs, ns (see [`Effort`]): of an entry of the matrix, and of a Newton step, a sweep, and an evaluation of the laws for each scalar
/// unknown. They are measured as described in `simulation::guards`; in systems of this size, the squares and cubes of the number of unknowns
/// take no measurable time.
const ENTRY_COST: usize = 25;
const NEWTON_COST: usize = 170;
const SWEEP_COST: usize = 50;
const LAWS_COST: usize = 4;

/// Active branch of a law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Branch {
    /// The force keeps its rate at zero.
    Holds,
    /// The force is at its limit, in this direction.
    Limited(DVec2),
    /// A contact that does not push, or its friction.
    Absent,
}

/// Result of the solver.
#[derive(Clone, Debug)]
pub struct Solution {
    /// Value of each scalar unknown, m/s².
    pub values: Values,
    /// Active branch of each unknown's law.
    pub branches: Branches,
    /// Whether every law holds to rounding.
    pub converged: bool,
}

/// Forces with the smallest error of a search so far.
struct Best {
    error: f64,
    values: Values,
}

/// Active branch of each unknown's law.
pub type Branches = [Branch; MAX_UNKNOWNS];

/// Searches forces and frictions that obey all laws, starting from `guess`, in up to this number of `attempts`.
pub fn solve(problem: &Problem, guess: &Values, attempts: u32, effort: &Effort) -> Solution {
    let system = System::new(problem, effort);
    let mut best = Best { error: f64::INFINITY, values: *guess };
    for attempt in 0..attempts {
        let error_before = best.error;
        let begin = if attempt == 0 {
            *guess
        } else {
            let (mut values, sweeps) = (best.values, FIRST_SWEEPS << (attempt - 1));
            (0..sweeps).for_each(|_| system.sweep(&mut values));
            values
        };
        if let Some(solution) = system.newton(&begin, &mut best, NEWTON_STEPS, MAX_HALVINGS, PROXIMITY) {
            return solution;
        }
        if best.error > 0.5 * error_before && best.error <= NEARLY * system.scale(&best.values) {
            break;
        }
    }
    let begin = best.values;
    if attempts > 1
        && let Some(solution) = system.newton(&begin, &mut best, WHOLE_STEPS, 1, NEXT_TO_NO_PROXIMITY)
    {
        return solution;
    }
    let mut end = Point::NOWHERE;
    system.put(&mut end, |index| best.values[index]);
    Solution { values: end.values, branches: end.branches, converged: false }
}

/// An iterate of the search.
struct Point {
    values: Values,
    /// What the forces resist, m/s².
    rates: Values,
    /// Forces minus their projections.
    residual: Values,
    branches: Branches,
    /// Euclidean norm of the residual: how far the laws are from being satisfied.
    error: f64,
}

impl Point {
    const NOWHERE: Self = Self {
        values: ZERO_VALUES,
        rates: ZERO_VALUES,
        residual: ZERO_VALUES,
        branches: [Branch::Absent; MAX_UNKNOWNS],
        error: f64::INFINITY,
    };
}

/// The problem in matrix form: the rates are `matrix · values + bias`.
struct System<'a> {
    problem: &'a Problem,
    effort: &'a Effort,
    count: usize,
    /// The matrix row by row, and column by column.
    rows: Vec<f64>,
    columns: Vec<f64>,
    bias: Values,
    /// Diagonal response of each rate to its force: for both components of a friction the larger one, which preserves its direction.
    responses: Values,
}

impl<'a> System<'a> {
    fn new(problem: &'a Problem, effort: &'a Effort) -> Self {
        let count = problem.rates.len();
        effort.add((ENTRY_COST * count * count) as u64);
        let columns =
            problem.forces.iter().flat_map(|force| problem.rates.iter().map(|rate| rate.dot(force))).collect();
        let mut system =
            Self { problem, effort, count, rows: Vec::new(), columns, bias: ZERO_VALUES, responses: ZERO_VALUES };
        let transposed = (0..count).flat_map(|row| (0..count).map(move |column| column * count + row));
        system.rows = transposed.map(|index| system.columns[index]).collect();
        for ((total, rate), bias) in system.bias.iter_mut().zip(&problem.rates).zip(&problem.bias) {
            *total = rate.dot(&problem.known) + bias;
        }
        for unknown in &problem.unknowns {
            let rows = unknown.first..unknown.first + unknown.count;
            let response = rows.clone().map(|index| system.row(index)[index]).fold(f64::MIN_POSITIVE, f64::max);
            system.responses[rows].fill(response);
        }
        system
    }

    /// Takes at most `steps` Newton steps from `values`, with fewer than `most_halvings` halvings each; updates the `best` forces.
    fn newton(
        &self,
        values: &Values,
        best: &mut Best,
        steps: usize,
        most_halvings: i32,
        proximity: f64,
    ) -> Option<Solution> {
        // Points are large: references to them are swapped instead of moving them.
        let mut points = [Point::NOWHERE; 3];
        let [here, next, spare] = &mut points;
        let (mut here, mut next, mut spare) = (here, next, spare);
        let mut jacobian = Vec::with_capacity(self.count * self.count);
        self.put(here, |index| values[index]);
        let mut failures = 0;
        for _ in 0..steps {
            if here.error < best.error {
                (best.error, best.values) = (here.error, here.values);
            }
            if here.error <= ROUNDING * self.scale(&here.values) {
                return Some(Solution { values: here.values, branches: here.branches, converged: true });
            }
            let change = self.newton_step(here, &mut jacobian, proximity)?;
            (next, spare) = self.step(here, &change, most_halvings, [next, spare]);
            if next.error >= here.error {
                failures += 1;
                if failures > MAX_FAILURES {
                    break;
                }
            }
            std::mem::swap(&mut here, &mut next);
        }
        None
    }

    /// Takes the whole step if it nearly removes the error, or the better of the whole and the doubled step if one halves the error;
    /// otherwise halves the step too. Returns the new point first. At a double root, the whole step leaves a quarter of the error and
    /// the doubled step hardly any (Rall 1966).
    fn step<'p>(
        &self,
        here: &Point,
        change: &Values,
        most_halvings: i32,
        [mut best, mut other]: [&'p mut Point; 2],
    ) -> (&'p mut Point, &'p mut Point) {
        let go = |share: f64, point: &mut Point| self.put(point, |index| here.values[index] + share * change[index]);
        go(1.0, best);
        if best.error < ENOUGH * here.error {
            return (best, other);
        }
        if best.error < DOUBLED * here.error {
            go(2.0, other);
            return if other.error < best.error { (other, best) } else { (best, other) };
        }
        let mut share = 1.0;
        for _ in 1..most_halvings {
            share *= 0.5;
            go(share, other);
            if other.error < best.error {
                std::mem::swap(&mut best, &mut other);
            } else if best.error < here.error {
                break;
            }
        }
        (best, other)
    }

    /// Evaluates a point with the given values.
    fn put(&self, point: &mut Point, size: impl Fn(usize) -> f64) {
        for (index, value) in point.values[..self.count].iter_mut().enumerate() {
            *value = size(index);
        }
        self.residual(point);
        point.error = point.residual[..self.count].iter().fold(0.0, |sum, x| sum + x * x).sqrt();
    }

    fn row(&self, index: usize) -> &[f64] {
        &self.rows[index * self.count..][..self.count]
    }

    /// Computes all rates.
    fn rates(&self, values: &Values, rates: &mut Values) {
        let rates = &mut rates[..self.count];
        rates.fill(0.0);
        for (column, x) in self.columns.chunks_exact(self.count.max(1)).zip(values) {
            for (rate, w) in rates.iter_mut().zip(column) {
                *rate += w * x;
            }
        }
        for (rate, bias) in rates.iter_mut().zip(&self.bias) {
            *rate += bias;
        }
    }

    /// Computes one rate, to the same bits.
    fn rate(&self, index: usize, values: &Values) -> f64 {
        self.bias[index] + self.row(index).iter().zip(values).map(|(w, x)| w * x).sum::<f64>()
    }

    /// Returns the largest of all forces and accelerations, m/s², which determines the rounding of the residual.
    fn scale(&self, values: &Values) -> f64 {
        self.bias[..self.count]
            .iter()
            .chain(&values[..self.count])
            .fold(f64::MIN_POSITIVE, |largest, x| largest.max(x.abs()))
    }

    /// Returns the projection that a law requires of a force, with the active branch. It is the projection of `f - rate/w` with the response
    /// `w`, where `rate` returns the rate of an index.
    fn project(&self, unknown: &Unknown, values: &Values, rate: impl Fn(usize) -> f64) -> (DVec2, Branch) {
        let first = unknown.first;
        let wanted = |index: usize| values[index] - rate(index) / self.responses[index];
        if let ForceKind::Normal(_) = unknown.kind {
            let force = wanted(first);
            let pushes = force > 0.0 && !matches!(unknown.limit, Limit::Fixed(0.0));
            return if pushes { (DVec2::new(force, 0.0), Branch::Holds) } else { (DVec2::ZERO, Branch::Absent) };
        }
        let force = DVec2::new(wanted(first), if unknown.count == 2 { wanted(first + 1) } else { 0.0 });
        let limit = match unknown.limit {
            Limit::Fixed(limit) => limit,
            Limit::Coulomb(_, contact) if values[contact] <= 0.0 => 0.0,
            Limit::Coulomb(mu, contact) => mu * values[contact],
        };
        if limit <= 0.0 {
            (DVec2::ZERO, Branch::Absent)
        } else if force.length_squared() <= limit * limit {
            (force, Branch::Holds)
        } else {
            let direction = force.normalize();
            (limit * direction, Branch::Limited(direction))
        }
    }

    /// Computes the rates, the forces minus their projections, and the branch of each law.
    fn residual(&self, point: &mut Point) {
        self.effort.add((LAWS_COST * self.count) as u64);
        let Point { values, rates, residual, branches, .. } = point;
        self.rates(values, rates);
        for (unknown, branch) in self.problem.unknowns.iter().zip(branches) {
            let force;
            (force, *branch) = self.project(unknown, values, |index| rates[index]);
            for (axis, projected) in force.to_array().into_iter().take(unknown.count).enumerate() {
                residual[unknown.first + axis] = values[unknown.first + axis] - projected;
            }
        }
    }

    /// Computes a Newton step; `None` if its system is singular.
    fn newton_step(&self, point: &Point, jacobian: &mut Vec<f64>, proximity: f64) -> Option<Values> {
        let Point { values, rates, residual, branches, .. } = point;
        let n = self.count;
        self.effort.add((NEWTON_COST * n) as u64);
        jacobian.clear();
        jacobian.resize(n * n, 0.0);
        let mut change = ZERO_VALUES;
        for (unknown, branch) in self.problem.unknowns.iter().zip(branches) {
            for axis in 0..unknown.count {
                let index = unknown.first + axis;
                let entries = &mut jacobian[index * n..][..n];
                match *branch {
                    Branch::Holds => {
                        entries.copy_from_slice(self.row(index));
                        entries[index] += proximity;
                        change[index] = -rates[index];
                    }
                    Branch::Absent => {
                        entries[index] = 1.0;
                        change[index] = -values[index];
                    }
                    Branch::Limited(direction) => {
                        change[index] = -residual[index];
                        self.limited(unknown, axis, direction, point, entries);
                    }
                }
            }
        }
        let mut pivots = [0; MAX_UNKNOWNS];
        if factorize(jacobian, &mut pivots[..n]) == 0.0 {
            return None;
        }
        substitute(jacobian, &pivots[..n], &mut change[..n]);
        change.iter().all(|x| x.is_finite()).then_some(change)
    }

    /// Fills a row of the derivative of `f - L z/|z|` with `z = f - rate/w`: the limit grows with its normal force, and the direction turns
    /// with `z`.
    fn limited(&self, unknown: &Unknown, axis: usize, direction: DVec2, point: &Point, entries: &mut [f64]) {
        let n = self.count;
        let Point { values, rates, .. } = point;
        let response = self.responses[unknown.first];
        let limit = match unknown.limit {
            Limit::Fixed(limit) => limit,
            Limit::Coulomb(mu, contact) => {
                entries[contact] -= mu * direction[axis];
                mu * values[contact]
            }
        };
        entries[unknown.first + axis] += 1.0;
        if unknown.count == 2 {
            let z = |index: usize| values[index] - rates[index] / response;
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

    /// Satisfies one law after another with the other forces fixed.
    fn sweep(&self, values: &mut Values) {
        self.effort.add((SWEEP_COST * self.count) as u64);
        for unknown in &self.problem.unknowns {
            let (force, _) = self.project(unknown, values, |index| self.rate(index, values));
            values[unknown.first..][..unknown.count].copy_from_slice(&force.to_array()[..unknown.count]);
        }
    }
}
