//! The one solver of the complementarity problem: semismooth Newton steps on the laws' projections (Alart and Curnier
//! 1991), with projected Gauss-Seidel sweeps (Jourdan, Alart and Jean 1998) where they do not get on.
//!
//! Each law says that a force is the projection, on to what it may be, of itself less a multiple of the rate that it
//! resists: a normal force on to what pushes, a friction on to its disk. The residual is the largest difference of the two
//! sides; it is zero where every law holds, and the solution tells whether it came to that.

use glam::DVec2;

use super::{
    linear::{factorize, substitute},
    problem::{Limit, MOST_UNKNOWNS, NO_SIZES, Place, Problem, Sizes, Unknown},
};

/// Forces per mass by which laws may be broken, as a share of the largest force or acceleration: some hundred roundings.
const ROUNDING: f64 = 256.0 * f64::EPSILON;

/// Newton steps before sweeps are tried. From a near active set it takes two or three, from anywhere about eight.
const NEWTON_STEPS: usize = 24;

/// A step that takes the error below this share of itself is as good as any.
const ENOUGH: f64 = 0.1;

/// Halvings of a Newton step that are tried.
const MOST_HALVINGS: i32 = 14;

/// Whole Newton steps that are tried at last, and what they add to the diagonal: where a friction turns along the circle of its limit to a
/// double root, what it leaves in the laws on the way makes damped steps short.
const WHOLE_STEPS: usize = 48;
const NEXT_TO_NO_PROXIMITY: f64 = 1e-13;

/// Rounds of sweeps and Newton steps; the sweeps double from one to the next.
const ATTEMPTS: u32 = 7;
const FIRST_SWEEPS: usize = 8;

/// Errors below this share of the largest force that a round has not halved are left as they are: such forces are at the edge of what
/// may hold them, and no round finds better ones.
const NEARLY: f64 = 1e-7;

/// Added to the system's diagonal, whose entries are 1 to 10. A ball that sticks to several things at once is held more
/// often than needed, so that forces are not unique; this picks those nearest to what they were. Further steps take its
/// effect out again.
const PROXIMITY: f64 = 1e-7;

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

/// What each unknown's law asks.
pub type Sides = [Side; MOST_UNKNOWNS];

/// Forces and frictions that obey all laws, sought from `guess` on.
pub fn solve(problem: &Problem, guess: &Sizes) -> Solution {
    solve_in(problem, guess, ATTEMPTS)
}

/// The same if they are near to the `guess`.
pub fn solve_near(problem: &Problem, guess: &Sizes) -> Solution {
    solve_in(problem, guess, 1)
}

fn solve_in(problem: &Problem, guess: &Sizes, attempts: u32) -> Solution {
    let system = System::new(problem);
    let mut best = (f64::INFINITY, *guess);
    for attempt in 0..attempts {
        let error_before = best.0;
        let begin = if attempt == 0 {
            *guess
        } else {
            let mut sizes = best.1;
            (0..FIRST_SWEEPS << (attempt - 1)).for_each(|_| system.sweep(&mut sizes));
            sizes
        };
        if let Some(solution) = system.newton(&begin, &mut best, NEWTON_STEPS, MOST_HALVINGS, PROXIMITY) {
            return solution;
        }
        if best.0 > 0.5 * error_before && best.0 <= NEARLY * system.scale(&best.1) {
            break;
        }
    }
    let begin = best.1;
    if attempts > 1
        && let Some(solution) = system.newton(&begin, &mut best, WHOLE_STEPS, 1, NEXT_TO_NO_PROXIMITY)
    {
        return solution;
    }
    let (_, sides) = system.residual(&best.1);
    Solution { sizes: best.1, sides, converged: false }
}

fn length(residual: &Sizes) -> f64 {
    residual.iter().fold(0.0, |sum, x| sum + x * x).sqrt()
}

/// Where a step leads: how far the laws are from holding there, the sizes, the residual and the sides.
type Point = (f64, Sizes, Sizes, Sides);

/// The problem as numbers: rates are `matrix · sizes + bias`.
struct System<'a> {
    problem: &'a Problem,
    count: usize,
    matrix: Vec<f64>,
    bias: Sizes,
}

impl<'a> System<'a> {
    fn new(problem: &'a Problem) -> Self {
        let count = problem.rates.len();
        let mut system = Self { problem, count, matrix: Vec::with_capacity(count * count), bias: NO_SIZES };
        for (row, (rate, bias)) in problem.rates.iter().zip(&problem.bias).enumerate() {
            system.bias[row] = rate.dot(&problem.known) + bias;
            system.matrix.extend(problem.forces.iter().map(|force| rate.dot(force)));
        }
        system
    }

    /// Newton steps from `sizes` on, with so many halvings at most; keeps the `best` of all errors and sizes.
    fn newton(
        &self,
        sizes: &Sizes,
        best: &mut (f64, Sizes),
        steps: usize,
        most_halvings: i32,
        proximity: f64,
    ) -> Option<Solution> {
        let mut sizes = *sizes;
        let (mut residual, mut sides) = self.residual(&sizes);
        for _ in 0..steps {
            let error = length(&residual);
            if error < best.0 {
                *best = (error, sizes);
            }
            if error <= ROUNDING * self.scale(&sizes) {
                return Some(Solution { sizes, sides, converged: true });
            }
            let change = self.newton_step(&sizes, &residual, &sides, proximity)?;
            // The whole step where it brings the laws nearer to hold, else the share of it that does so most.
            let mut tried: Option<Point> = None;
            for halvings in 0..most_halvings {
                let share = 0.5_f64.powi(halvings);
                let there = std::array::from_fn(|index| sizes[index] + share * change[index]);
                let (residual, sides) = self.residual(&there);
                let reached = length(&residual);
                if tried.as_ref().is_none_or(|best| reached < best.0) {
                    tried = Some((reached, there, residual, sides));
                } else if tried.as_ref().is_some_and(|best| best.0 < error) {
                    break;
                }
                if halvings == 0 && reached < ENOUGH * error {
                    break;
                }
            }
            (_, sizes, residual, sides) = tried?;
        }
        None
    }

    fn row(&self, index: usize) -> &[f64] {
        &self.matrix[index * self.count..][..self.count]
    }

    fn rate(&self, index: usize, sizes: &Sizes) -> f64 {
        self.bias[index] + self.row(index).iter().zip(sizes).map(|(w, x)| w * x).sum::<f64>()
    }

    /// The largest of all forces and accelerations, m/s², whose rounding the residual has.
    fn scale(&self, sizes: &Sizes) -> f64 {
        self.bias.iter().chain(sizes).fold(f64::MIN_POSITIVE, |largest, x| largest.max(x.abs()))
    }

    /// How a law answers to its rates: the projected force, and which side it is on.
    fn project(&self, unknown: &Unknown, sizes: &Sizes) -> (DVec2, Side) {
        let first = unknown.first;
        // One step for both rows of a friction keeps its direction.
        let response = (first..first + unknown.count).map(|i| self.row(i)[i]).fold(f64::MIN_POSITIVE, f64::max);
        let wanted = |i: usize| sizes[i] - self.rate(i, sizes) / response;
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
    fn residual(&self, sizes: &Sizes) -> (Sizes, Sides) {
        let (mut residual, mut sides) = (NO_SIZES, [Side::Absent; MOST_UNKNOWNS]);
        for (unknown, side) in self.problem.unknowns.iter().zip(&mut sides) {
            let force;
            (force, *side) = self.project(unknown, sizes);
            for (axis, projected) in force.to_array().into_iter().take(unknown.count).enumerate() {
                residual[unknown.first + axis] = sizes[unknown.first + axis] - projected;
            }
        }
        (residual, sides)
    }

    /// A Newton step; `None` where its system is singular.
    fn newton_step(&self, sizes: &Sizes, residual: &Sizes, sides: &Sides, proximity: f64) -> Option<Sizes> {
        let n = self.count;
        let mut jacobian = vec![0.0; n * n];
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
        if factorize(&mut jacobian, &mut pivots[..n]) == 0.0 {
            return None;
        }
        substitute(&jacobian, &pivots[..n], &mut change[..n]);
        change.iter().all(|x| x.is_finite()).then_some(change)
    }

    /// A row of the derivative of `f - L z/|z|` with `z = f - rate/w`: the limit grows with its normal force, and the
    /// direction turns with `z`.
    fn limited(&self, unknown: &Unknown, axis: usize, direction: DVec2, sizes: &Sizes, entries: &mut [f64]) {
        let n = self.count;
        let response =
            (unknown.first..unknown.first + unknown.count).map(|i| self.row(i)[i]).fold(f64::MIN_POSITIVE, f64::max);
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
            let z = |i: usize| sizes[i] - self.rate(i, sizes) / response;
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
        for unknown in &self.problem.unknowns {
            let (force, _) = self.project(unknown, sizes);
            sizes[unknown.first..][..unknown.count].copy_from_slice(&force.to_array()[..unknown.count]);
        }
    }
}
