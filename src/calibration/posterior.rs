//! The posterior of constants and strokes as a normal distribution, by posterior linearization (García-Fernández, Svensson and Särkkä
//! 2015): the marks are linearized over the whole width of the distribution. Slopes are central differences of that width (Nørgaard,
//! Poulsen and Ravn 2000); the deviations from the line come from points drawn from the distribution.
//! Derivatives at the most probable point alone would be overconfident for nonlinear marks, which depend on whether a ball slips or
//! sticks at a rail.

use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;

use super::{
    belief::Belief,
    estimate::{Trial, expected},
    forward::STROKE_PARAMETERS,
    robust::weight,
};
use crate::statistics::{back_substitute, cholesky, dot, identity, inverse, normal_pair, solve};

/// Width of the differences, in standard deviations: that of a quadrature that is exact for polynomials of the fifth degree.
const WIDTH: f64 = 1.732_050_807_568_877_2;

/// Pairs of random points at which deviations from the line are measured, and their seed.
const PAIRS: usize = 12;
const SEED: u64 = 0x6d61_726b_7321;

/// Limit on the iterations, and the change, in prior standard deviations, below which they end.
const MAX_ITERATIONS: usize = 12;
const TOLERANCE: f64 = 0.01;

/// Absolute value of a mean, in prior standard deviations, from which the iteration counts as diverged.
const DIVERGED: f64 = 6.0;

/// A normal distribution of the unknowns and the strokes of the trials, in this order.
#[derive(Clone, Debug)]
pub struct Posterior {
    /// The means.
    pub mean: Vec<f64>,
    /// The inverse of the covariance.
    pub normal: Vec<Vec<f64>>,
}

impl Posterior {
    /// Returns the means and the covariance of the first `count` numbers.
    pub fn marginal(mut self, count: usize) -> (Vec<f64>, Vec<Vec<f64>>) {
        let mut covariance = inverse(&self.normal).unwrap_or_else(|| vec![vec![f64::NAN; count]; count]);
        covariance.truncate(count);
        for line in &mut covariance {
            line.truncate(count);
        }
        self.mean.truncate(count);
        (self.mean, covariance)
    }

    /// Iterates from the most probable point until the distribution agrees with the linearization over its width. Returns the initial
    /// distribution if the iteration fails or diverges.
    pub fn refined(self, belief: &Belief, trials: &[Trial]) -> Self {
        let mut now = self.clone();
        for _ in 0..MAX_ITERATIONS {
            let Some(next) = now.next(belief, trials) else { return self };
            let change = now.mean.iter().zip(&next.mean).map(|(one, other)| (one - other).abs()).fold(0.0, f64::max);
            now = next;
            if change < TOLERANCE {
                break;
            }
        }
        if now.mean.iter().all(|value| value.abs() < DIVERGED) { now } else { self }
    }

    /// Makes one iteration; `None` if a matrix is singular or a number is not finite.
    fn next(&self, belief: &Belief, trials: &[Trial]) -> Option<Self> {
        let (constants, size) = (belief.count(), self.mean.len());
        let covariance = inverse(&self.normal)?;
        // The prior: independent numbers with standard deviation 1.
        let mut normal = identity(size);
        let mut right = vec![0.0; size];
        for (number, trial) in trials.iter().enumerate() {
            let first = constants + number * STROKE_PARAMETERS;
            let own: Vec<usize> = (0..constants).chain(first..first + STROKE_PARAMETERS).collect();
            let mean: Vec<f64> = own.iter().map(|index| self.mean[*index]).collect();
            let part = |row: &usize| own.iter().map(|column| covariance[*row][*column]).collect();
            let factor = cholesky(&own.iter().map(part).collect::<Vec<_>>(), 0.0).ok()?;
            let line = Linearization::of(belief, trial, &mean, &factor);
            let count = line.readings.len();
            let noise: Vec<Vec<f64>> = (0..count)
                .map(|row| {
                    let reading = trial.readings[line.readings[row]];
                    let own = reading.standard_error * reading.standard_error
                        / weight((line.at[row] - reading.value) / reading.standard_error);
                    (0..count)
                        .map(|column| line.nonlinearity[row][column] + if row == column { own } else { 0.0 })
                        .collect()
                })
                .collect();
            let precision = inverse(&noise)?;
            // Difference of each mark from the line's value at zero.
            let off: Vec<f64> = (0..count)
                .map(|row| trial.readings[line.readings[row]].value - line.middle[row] + dot(&line.slope[row], &mean))
                .collect();
            for (row, reading) in precision.iter().enumerate() {
                for (column, entry) in reading.iter().enumerate() {
                    for (i, one) in own.iter().enumerate() {
                        right[*one] += line.slope[row][i] * entry * off[column];
                        for (j, other) in own.iter().enumerate() {
                            normal[*one][*other] += line.slope[row][i] * entry * line.slope[column][j];
                        }
                    }
                }
            }
        }
        let mean = solve(&normal, &right)?;
        mean.iter().all(|value| value.is_finite()).then_some(Self { mean, normal })
    }
}

/// The linearization of a trial's marks over a distribution.
struct Linearization {
    /// Indices of the readings with an expected value.
    readings: Vec<usize>,
    /// Their expected values at the mean of the distribution.
    at: Vec<f64>,
    /// Their means over the distribution.
    middle: Vec<f64>,
    /// Slopes, reading by reading.
    slope: Vec<Vec<f64>>,
    /// Covariance of the deviations from the line.
    nonlinearity: Vec<Vec<f64>>,
}

impl Linearization {
    fn of(belief: &Belief, trial: &Trial, mean: &[f64], factor: &[Vec<f64>]) -> Self {
        let size = mean.len();
        let seen = |point: &[f64]| {
            let (unknowns, stroke) = point.split_at(belief.count());
            let stroke: [f64; STROKE_PARAMETERS] = std::array::from_fn(|index| stroke[index]);
            expected(&belief.table(unknowns), trial, &stroke)
        };
        let point = |numbers: &[f64]| -> Vec<f64> {
            mean.iter().zip(factor).map(|(mean, line)| mean + dot(line, numbers)).collect()
        };
        let along = |column: usize, width: f64| -> Vec<f64> {
            (0..size).map(|index| if index == column { width } else { 0.0 }).collect()
        };
        let here = seen(mean);
        let sides: Vec<[Vec<Option<f64>>; 2]> =
            (0..size).map(|column| [WIDTH, -WIDTH].map(|width| seen(&point(&along(column, width))))).collect();
        let readings: Vec<usize> = (0..here.len()).filter(|reading| here[*reading].is_some()).collect();
        let at: Vec<f64> = readings.iter().filter_map(|reading| here[*reading]).collect();
        let mut rise = vec![vec![0.0; size]; at.len()];
        for (column, [above, below]) in sides.iter().enumerate() {
            for (row, reading) in readings.iter().enumerate() {
                // If a mark has no value on one side, the difference on the other side counts for both.
                let [above, below] = [above[*reading], below[*reading]].map(|value| value.map(|value| value - at[row]));
                let (above, below) = match (above, below) {
                    (Some(above), Some(below)) => (above, below),
                    (Some(above), None) => (above, -above),
                    (None, Some(below)) => (-below, below),
                    (None, None) => (0.0, 0.0),
                };
                rise[row][column] = (above - below) / (2.0 * WIDTH);
            }
        }
        let deviations = |point: &[f64], numbers: &[f64]| -> Vec<f64> {
            let there = seen(point);
            let off = |(row, reading): (usize, &usize)| {
                there[*reading].map_or(0.0, |value| value - at[row] - dot(&rise[row], numbers))
            };
            readings.iter().enumerate().map(off).collect()
        };
        let all: Vec<Vec<f64>> = drawn(size).map(|numbers| deviations(&point(&numbers), &numbers)).collect();
        let mean_of = |value: &dyn Fn(&[f64]) -> f64| all.iter().map(|off| value(off)).sum::<f64>() / all.len() as f64;
        let bias: Vec<f64> = (0..at.len()).map(|row| mean_of(&|off| off[row])).collect();
        let entry = |row: usize, column: usize| mean_of(&|off| (off[row] - bias[row]) * (off[column] - bias[column]));
        let nonlinearity = (0..at.len()).map(|row| (0..at.len()).map(|column| entry(row, column)).collect()).collect();
        let middle = at.iter().zip(&bias).map(|(at, bias)| at + bias).collect();
        let slope = rise.iter().map(|rise| back_substitute(factor, rise)).collect();
        Self { readings, at, middle, slope, nonlinearity }
    }
}

/// Draws vectors of `size` independent standard normal numbers, in pairs of mirror images.
fn drawn(size: usize) -> impl Iterator<Item = Vec<f64>> {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(SEED);
    (0..PAIRS).flat_map(move |_| {
        let numbers: Vec<f64> = (0..size).map(|_| normal_pair(&mut rng)[0]).collect();
        [numbers.iter().map(|number| -number).collect(), numbers]
    })
}
