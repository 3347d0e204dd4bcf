//! The normal distribution of constants and strokes after the trials, from the marks as they are over the whole width of that
//! distribution: posterior linearization (García-Fernández, Svensson and Särkkä 2015), with slopes from central differences of that
//! width (Nørgaard, Poulsen and Ravn 2000), and what marks are beside the line from places drawn from the distribution.
//! Derivatives at the most likely place alone promise too much of marks that bend: whether a ball slips or sticks at a rail.

use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;

use super::{
    belief::Belief,
    estimate::{Trial, expected},
    forward::STROKE,
    robust::weight,
};
use crate::statistics::{cholesky, dot, identity, inverse, normal_pair, solve, undo};

/// Width of the differences in standard deviations: that of a quadrature that is exact for polynomials of the fifth degree.
const WIDTH: f64 = 1.732_050_807_568_877_2;

/// Pairs of places at which it is seen how far marks are beside a line, and the seed of these.
const PAIRS: usize = 12;
const SEED: u64 = 0x6d61_726b_7321;

/// Rounds at most, and the change, in deviations of what was held before, below which there are no more.
const ROUNDS: usize = 12;
const SETTLED: f64 = 0.01;

/// From so many of those deviations on, an unknown is lost.
const LOST: f64 = 6.0;

/// Unknowns and strokes of the trials, in this order, with a covariance.
#[derive(Clone, Debug)]
pub struct Posterior {
    /// The means.
    pub mean: Vec<f64>,
    /// The inverse of the covariance.
    pub normal: Vec<Vec<f64>>,
}

impl Posterior {
    /// Means and covariance of so many unknowns.
    pub fn of_the_first(mut self, count: usize) -> (Vec<f64>, Vec<Vec<f64>>) {
        let mut covariance = inverse(&self.normal).unwrap_or_else(|| vec![vec![f64::NAN; count]; count]);
        covariance.truncate(count);
        for line in &mut covariance {
            line.truncate(count);
        }
        self.mean.truncate(count);
        (self.mean, covariance)
    }

    /// Goes on from the most likely place until the distribution agrees with the marks as they are over its width; stays
    /// there where that leads nowhere.
    pub fn settled(self, belief: &Belief, trials: &[Trial]) -> Self {
        let mut now = self.clone();
        for _ in 0..ROUNDS {
            let Some(next) = now.next(belief, trials) else { return self };
            let change = now.mean.iter().zip(&next.mean).map(|(one, other)| (one - other).abs()).fold(0.0, f64::max);
            now = next;
            if change < SETTLED {
                break;
            }
        }
        if now.mean.iter().all(|value| value.abs() < LOST) { now } else { self }
    }

    /// One round; `None` where its numbers come to nothing.
    fn next(&self, belief: &Belief, trials: &[Trial]) -> Option<Self> {
        let (constants, size) = (belief.count(), self.mean.len());
        let covariance = inverse(&self.normal)?;
        // What is held before the trials: independent numbers with deviation 1.
        let mut normal = identity(size);
        let mut right = vec![0.0; size];
        for (number, trial) in trials.iter().enumerate() {
            let first = constants + number * STROKE;
            let own: Vec<usize> = (0..constants).chain(first..first + STROKE).collect();
            let mean: Vec<f64> = own.iter().map(|index| self.mean[*index]).collect();
            let part = |row: &usize| own.iter().map(|column| covariance[*row][*column]).collect();
            let factor = cholesky(&own.iter().map(part).collect::<Vec<_>>(), 0.0).ok()?;
            let line = Line::of(belief, trial, &mean, &factor);
            let count = line.told.len();
            let noise: Vec<Vec<f64>> = (0..count)
                .map(|row| {
                    let reading = trial.readings[line.told[row]];
                    let own = reading.sure * reading.sure / weight((line.at[row] - reading.value) / reading.sure);
                    (0..count).map(|column| line.bend[row][column] + if row == column { own } else { 0.0 }).collect()
                })
                .collect();
            let precision = inverse(&noise)?;
            // How far each mark is off what the line through nought says.
            let off: Vec<f64> = (0..count)
                .map(|row| trial.readings[line.told[row]].value - line.middle[row] + dot(&line.slope[row], &mean))
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

/// What a trial's marks are, as a line over a distribution.
struct Line {
    /// Which readings there are.
    told: Vec<usize>,
    /// Their values at the middle of the distribution.
    at: Vec<f64>,
    /// Their means.
    middle: Vec<f64>,
    /// The slopes, reading by reading.
    slope: Vec<Vec<f64>>,
    /// Covariance of how far they are beside the line.
    bend: Vec<Vec<f64>>,
}

impl Line {
    fn of(belief: &Belief, trial: &Trial, mean: &[f64], factor: &[Vec<f64>]) -> Self {
        let size = mean.len();
        let seen = |place: &[f64]| {
            let (unknowns, stroke) = place.split_at(belief.count());
            let stroke: [f64; STROKE] = std::array::from_fn(|index| stroke[index]);
            expected(&belief.table(unknowns), trial, &stroke)
        };
        let place = |numbers: &[f64]| -> Vec<f64> {
            mean.iter().zip(factor).map(|(mean, line)| mean + dot(line, numbers)).collect()
        };
        let along = |column: usize, width: f64| -> Vec<f64> {
            (0..size).map(|index| if index == column { width } else { 0.0 }).collect()
        };
        let here = seen(mean);
        let sides: Vec<[Vec<Option<f64>>; 2]> =
            (0..size).map(|column| [WIDTH, -WIDTH].map(|width| seen(&place(&along(column, width))))).collect();
        let told: Vec<usize> = (0..here.len()).filter(|reading| here[*reading].is_some()).collect();
        let at: Vec<f64> = told.iter().filter_map(|reading| here[*reading]).collect();
        let mut rise = vec![vec![0.0; size]; at.len()];
        for (column, [above, below]) in sides.iter().enumerate() {
            for (row, reading) in told.iter().enumerate() {
                // Of a mark that is lost on one side, the other is taken for both.
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
        let beside = |place: &[f64], numbers: &[f64]| -> Vec<f64> {
            let there = seen(place);
            let off = |(row, reading): (usize, &usize)| {
                there[*reading].map_or(0.0, |value| value - at[row] - dot(&rise[row], numbers))
            };
            told.iter().enumerate().map(off).collect()
        };
        let all: Vec<Vec<f64>> = drawn(size).map(|numbers| beside(&place(&numbers), &numbers)).collect();
        let mean_of = |value: &dyn Fn(&[f64]) -> f64| all.iter().map(|off| value(off)).sum::<f64>() / all.len() as f64;
        let bent: Vec<f64> = (0..at.len()).map(|row| mean_of(&|off| off[row])).collect();
        let entry = |row: usize, column: usize| mean_of(&|off| (off[row] - bent[row]) * (off[column] - bent[column]));
        let bend = (0..at.len()).map(|row| (0..at.len()).map(|column| entry(row, column)).collect()).collect();
        let middle = at.iter().zip(&bent).map(|(at, bent)| at + bent).collect();
        let slope = rise.iter().map(|rise| undo(factor, rise)).collect();
        Self { told, at, middle, slope, bend }
    }
}

/// Independent standard normal numbers, so many at a time, each with its mirror image.
fn drawn(size: usize) -> impl Iterator<Item = Vec<f64>> {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(SEED);
    (0..PAIRS).flat_map(move |_| {
        let numbers: Vec<f64> = (0..size).map(|_| normal_pair(&mut rng)[0]).collect();
        [numbers.iter().map(|number| -number).collect(), numbers]
    })
}
