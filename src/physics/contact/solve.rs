//! The one solver of the complementarity problem: semismooth Newton steps on the laws' projections (Alart and Curnier
//! 1991), with projected Gauss-Seidel sweeps (Jourdan, Alart and Jean 1998) where they do not get on.
//!
//! Each law says that a force is the projection, on to what it may be, of itself less a multiple of the rate that it
//! resists: a normal force on to what pushes, a friction on to its disk. The residual is the largest difference of the two
//! sides; it is zero where every law holds, and the solution tells whether it came to that.

use glam::DVec2;

use super::{
    linear::Factorized,
    problem::{Limit, Place, Problem, Unknown},
};

/// Forces per mass by which laws may be broken, as a share of the largest force or acceleration: some hundred roundings.
pub const ROUNDING: f64 = 256.0 * f64::EPSILON;

/// Newton steps before sweeps are tried. From a near regime it takes two or three, from anywhere about eight.
const NEWTON_STEPS: usize = 24;

/// Halvings of a Newton step that are tried.
const MOST_HALVINGS: i32 = 14;

/// Rounds of sweeps and Newton steps; the sweeps double from one to the next.
const ATTEMPTS: u32 = 7;
const FIRST_SWEEPS: usize = 8;

/// Added to the system's diagonal, whose entries are 1 to 10. A ball that sticks to several things at once is held more
/// often than needed, so that forces are not unique; this picks those nearest to what they were. Further steps take its
/// effect out again.
pub const PROXIMITY: f64 = 1e-7;

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
    pub sizes: Vec<f64>,
    /// What each unknown's law asks.
    pub sides: Vec<Side>,
    /// Whether every law holds to rounding.
    pub converged: bool,
}

/// Forces and frictions that obey all laws, sought from `guess` on.
pub fn solve(problem: &Problem, guess: &[f64]) -> Solution {
    let system = System::new(problem);
    let mut best = (f64::INFINITY, guess.to_vec());
    let mut sizes = guess.to_vec();
    for attempt in 0..ATTEMPTS {
        let (mut residual, mut sides) = system.residual(&sizes);
        for _ in 0..NEWTON_STEPS {
            let error = length(&residual);
            if error < best.0 {
                best = (error, sizes.clone());
            }
            if error <= ROUNDING * system.scale(&sizes) {
                return Solution { sizes, sides, converged: true };
            }
            let Some(change) = system.newton_step(&sizes, &residual, &sides) else { break };
            // The whole step where it brings the laws nearer to hold, else the share of it that does so most.
            let mut tried: Option<Point> = None;
            for halvings in 0..MOST_HALVINGS {
                let share = 0.5_f64.powi(halvings);
                let there: Vec<f64> = sizes.iter().zip(&change).map(|(size, change)| size + share * change).collect();
                let (residual, sides) = system.residual(&there);
                let reached = length(&residual);
                if tried.as_ref().is_none_or(|best| reached < best.0) {
                    tried = Some((reached, there, residual, sides));
                } else if tried.as_ref().is_some_and(|best| best.0 < error) {
                    break;
                }
            }
            let Some((_, there, left, now)) = tried else { break };
            (sizes, residual, sides) = (there, left, now);
        }
        sizes.clone_from(&best.1);
        for _ in 0..FIRST_SWEEPS << attempt {
            system.sweep(&mut sizes);
        }
    }
    let (_, sides) = system.residual(&best.1);
    Solution { sizes: best.1, sides, converged: false }
}

fn length(residual: &[f64]) -> f64 {
    residual.iter().fold(0.0, |sum, x| sum + x * x).sqrt()
}

/// Where a step leads: how far the laws are from holding there, the sizes, the residual and the sides.
type Point = (f64, Vec<f64>, Vec<f64>, Vec<Side>);

/// The problem as numbers: rates are `matrix · sizes + bias`.
struct System<'a> {
    problem: &'a Problem,
    count: usize,
    matrix: Vec<f64>,
    bias: Vec<f64>,
}

impl<'a> System<'a> {
    fn new(problem: &'a Problem) -> Self {
        let bias =
            problem.rates.iter().zip(&problem.bias).map(|(rate, bias)| rate.dot(&problem.known) + bias).collect();
        Self { problem, count: problem.rates.len(), matrix: problem.matrix(), bias }
    }

    fn row(&self, index: usize) -> &[f64] {
        &self.matrix[index * self.count..][..self.count]
    }

    fn rate(&self, index: usize, sizes: &[f64]) -> f64 {
        self.bias[index] + self.row(index).iter().zip(sizes).map(|(w, x)| w * x).sum::<f64>()
    }

    /// The largest of all forces and accelerations, m/s², whose rounding the residual has.
    fn scale(&self, sizes: &[f64]) -> f64 {
        self.bias.iter().chain(sizes).fold(f64::MIN_POSITIVE, |largest, x| largest.max(x.abs()))
    }

    /// How a law answers to its rates: the projected force, and which side it is on.
    fn project(&self, unknown: &Unknown, sizes: &[f64]) -> (DVec2, Side) {
        let first = unknown.first;
        // One step for both rows of a friction keeps its direction.
        let response = (first..first + unknown.count).map(|i| self.row(i)[i]).fold(f64::MIN_POSITIVE, f64::max);
        let wanted = |i: usize| sizes[i] - self.rate(i, sizes) / response;
        if let Place::Normal(_) = unknown.place {
            let force = wanted(first);
            return if force > 0.0 { (DVec2::new(force, 0.0), Side::Holds) } else { (DVec2::ZERO, Side::Absent) };
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
    fn residual(&self, sizes: &[f64]) -> (Vec<f64>, Vec<Side>) {
        let mut residual = vec![0.0; self.count];
        let sides = self.problem.unknowns.iter().map(|unknown| {
            let (force, side) = self.project(unknown, sizes);
            for (axis, projected) in force.to_array().into_iter().take(unknown.count).enumerate() {
                residual[unknown.first + axis] = sizes[unknown.first + axis] - projected;
            }
            side
        });
        let sides = sides.collect();
        (residual, sides)
    }

    /// A Newton step; `None` where its system is singular.
    fn newton_step(&self, sizes: &[f64], residual: &[f64], sides: &[Side]) -> Option<Vec<f64>> {
        let n = self.count;
        let mut jacobian = vec![0.0; n * n];
        let mut change = vec![0.0; n];
        for (unknown, side) in self.problem.unknowns.iter().zip(sides) {
            for axis in 0..unknown.count {
                let index = unknown.first + axis;
                let entries = &mut jacobian[index * n..][..n];
                match *side {
                    Side::Holds => {
                        entries.copy_from_slice(self.row(index));
                        entries[index] += PROXIMITY;
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
        Factorized::new(n, jacobian)?.solve(&mut change);
        change.iter().all(|x| x.is_finite()).then_some(change)
    }

    /// A row of the derivative of `f - L z/|z|` with `z = f - rate/w`: the limit grows with its normal force, and the
    /// direction turns with `z`.
    fn limited(&self, unknown: &Unknown, axis: usize, direction: DVec2, sizes: &[f64], entries: &mut [f64]) {
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
    fn sweep(&self, sizes: &mut [f64]) {
        for unknown in &self.problem.unknowns {
            let (force, _) = self.project(unknown, sizes);
            sizes[unknown.first..][..unknown.count].copy_from_slice(&force.to_array()[..unknown.count]);
        }
    }
}
