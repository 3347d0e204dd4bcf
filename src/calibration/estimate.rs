//! Estimates a table's constants from the marks of trials: first the most probable constants and actual strokes, with the normal
//! distribution around them (Laplace's approximation), then the refinement by [`Posterior`].

use super::{
    belief::Belief,
    forward::{STROKE_PARAMETERS, StrokeSpread},
    posterior::Posterior,
    protocol::Test,
    robust::{UNREACHED_RESIDUAL, robust_residual},
};
use crate::{
    statistics::{LeastSquaresProblem, Minimum, dot, half_log_determinant, identity, minimize, normal_matrix, solve},
    table::Table,
};

/// A number that was marked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// Index of the mark in its test.
    pub mark: usize,
    /// Its value, in its unit.
    pub value: f64,
    /// Its standard error.
    pub standard_error: f64,
}

/// A stroke of a test and its marks.
#[derive(Clone, Debug, PartialEq)]
pub struct Trial {
    /// The test.
    pub test: &'static Test,
    /// Whether it was played from the far end.
    pub is_turned: bool,
    /// The readings; marks may be missing.
    pub readings: Vec<Reading>,
}

/// Step of finite differences, in standard deviations of the unknowns.
pub const STEP: f64 = 0.02;

/// Limit on the iterations of a fit; about ten are typical.
const MAX_ITERATIONS: usize = 60;

/// Factors on the standard errors in the first stage of a fit, because far from the minimum a few misread marks could mislead it. If a
/// ball has hit one rail more than expected, the factors can lead to different minima.
const WIDENINGS: [f64; 2] = [3.0, 10.0];

/// Initial speeds tried for a stroke, in standard deviations from the requested one.
const SPEEDS: [f64; 9] = [-2.0, -1.5, -1.0, -0.5, 0.0, 0.5, 1.0, 1.5, 2.0];

/// The constant that causes several minima: a ball that a rail throws back a little more, or a little earlier, can take the same
/// path. The fit also starts from each of these values, in prior standard deviations.
const VALLEYS: (&str, [f64; 2]) = ("rail.kappa", [-1.4, 1.4]);

/// Largest difference of the unknowns at which two minima count as one.
const SAME_MINIMUM: f64 = 0.2;

/// Smallest weight of a minimum, relative to the most probable one, at which it counts.
const MIN_WEIGHT: f64 = 0.01;

/// The estimate from the trials.
#[derive(Clone, Debug)]
pub struct Estimate {
    /// The means of the unknowns of [`Belief`].
    pub unknowns: Vec<f64>,
    /// Their covariance.
    pub covariance: Vec<Vec<f64>>,
    /// The most probable unknowns. Unlike the means, they and the most probable strokes fit the marks best.
    pub most_probable: Vec<f64>,
    /// The most probable strokes of the trials.
    pub strokes: Vec<[f64; STROKE_PARAMETERS]>,
    /// The normal matrix of unknowns and strokes at the most probable point.
    normal: Vec<Vec<f64>>,
}

impl Estimate {
    /// Combines the distributions around some minima, weighted by the evidence of each (Laplace), to the means and the covariance of the
    /// mixture. `None` if no minimum has a regular normal matrix.
    fn of(belief: &Belief, trials: &[Trial], minima: &[Minimum]) -> Option<Self> {
        let count = belief.count();
        let mut problem = Joint { belief, trials, widening: 1.0 };
        let valley = |found: &Minimum| {
            let mut residuals = Vec::new();
            problem.residuals(&found.parameters, &mut residuals);
            let normal = normal_matrix(&problem.derivatives(&found.parameters, &residuals));
            let evidence = -0.5 * found.squares - half_log_determinant(&normal)?;
            Some((evidence, Posterior { mean: found.parameters.clone(), normal }))
        };
        let valleys: Vec<(f64, Posterior)> = minima.iter().filter_map(valley).collect();
        let (highest, best) = valleys.iter().max_by(|one, other| one.0.total_cmp(&other.0))?;
        let weighted = valleys.iter().map(|(evidence, first)| ((evidence - highest).exp(), first));
        let mixture: Vec<(f64, Moments)> = weighted
            .filter(|(weight, _)| *weight >= MIN_WEIGHT)
            .map(|(weight, first)| (weight, first.clone().refined(belief, trials).marginal(count)))
            .collect();
        let (unknowns, covariance) = moments(count, &mixture);
        let (likely, strokes) = best.mean.split_at(count);
        let strokes = strokes.as_chunks::<STROKE_PARAMETERS>().0.to_vec();
        Some(Self { unknowns, covariance, most_probable: likely.to_vec(), strokes, normal: best.normal.clone() })
    }

    /// Returns the expected value of a mark and its standard deviation. The mark itself contributes only as far as it looks correct.
    pub fn expected(&self, belief: &Belief, trials: &[Trial], trial: usize, mark: usize) -> Option<(f64, f64)> {
        let Trial { test, is_turned, .. } = trials[trial];
        let seen = |unknowns: &[f64], stroke: &[f64; STROKE_PARAMETERS]| {
            StrokeSpread::ASSUMED.simulate_marks(&belief.table(unknowns), test, is_turned, stroke)[mark]
        };
        let stroke = self.strokes[trial];
        let at = seen(&self.most_probable, &stroke)?;
        let mut slope = vec![0.0; self.normal.len()];
        let (count, own) = (belief.count(), belief.count() + trial * STROKE_PARAMETERS);
        for (index, seen) in (0..count).chain(own..).zip(perturbed(&self.most_probable, &stroke, seen)) {
            slope[index] = (seen? - at) / STEP;
        }
        let spread = solve(&self.normal, &slope)?;
        Some((at, dot(&slope, &spread).max(0.0).sqrt()))
    }
}

/// Means and covariance.
type Moments = (Vec<f64>, Vec<Vec<f64>>);

/// Returns the moments of a weighted mixture of normal distributions of `count` numbers.
fn moments(count: usize, mixture: &[(f64, Moments)]) -> Moments {
    let total = mixture.iter().fold(0.0, |total, (weight, _)| total + weight);
    let mean = |row: usize| mixture.iter().fold(0.0, |sum, (weight, (mean, _))| sum + weight * mean[row]) / total;
    let means: Vec<f64> = (0..count).map(mean).collect();
    let entry = |row: usize, column: usize| {
        let product = |(weight, (mean, covariance)): &(f64, Moments)| {
            weight * (covariance[row][column] + mean[row] * mean[column])
        };
        mixture.iter().fold(0.0, |sum, one| sum + product(one)) / total - means[row] * means[column]
    };
    let covariance = (0..count).map(|row| (0..count).map(|column| entry(row, column)).collect()).collect();
    (means, covariance)
}

/// Evaluates `seen` with each of the unknowns, then each of the stroke's numbers, increased by one [`STEP`].
pub fn perturbed<T>(
    unknowns: &[f64],
    stroke: &[f64; STROKE_PARAMETERS],
    seen: impl Fn(&[f64], &[f64; STROKE_PARAMETERS]) -> T,
) -> impl Iterator<Item = T> {
    (0..unknowns.len() + STROKE_PARAMETERS).map(move |index| {
        let (mut unknowns, mut stroke) = (unknowns.to_vec(), *stroke);
        if let Some(number) = unknowns.iter_mut().chain(&mut stroke).nth(index) {
            *number += STEP;
        }
        seen(&unknowns, &stroke)
    })
}

/// Fits constants and strokes to the trials.
pub fn estimate(belief: &Belief, trials: &[Trial]) -> Estimate {
    let minima = descend(belief, trials);
    Estimate::of(belief, trials, &minima).unwrap_or_else(|| {
        // Without a regular minimum the marks contain no information: the estimate is the prior.
        let (count, all) = (belief.count(), belief.count() + STROKE_PARAMETERS * trials.len());
        let zeros = vec![0.0; count];
        Estimate {
            unknowns: zeros.clone(),
            covariance: identity(count),
            most_probable: zeros,
            strokes: vec![[0.0; STROKE_PARAMETERS]; trials.len()],
            normal: identity(all),
        }
    })
}

/// Finds the distinct minima from several starting points in the prior, the lowest first.
fn descend(belief: &Belief, trials: &[Trial]) -> Vec<Minimum> {
    let zeros = vec![0.0; belief.count()];
    let (name, deviations) = VALLEYS;
    let others = deviations.into_iter().filter_map(|deviation| belief.unknowns_at(name, deviation));
    let starts = WIDENINGS
        .map(|widening| (zeros.clone(), widening))
        .into_iter()
        .chain(others.map(|start| (start, WIDENINGS[0])));
    let mut found: Vec<Minimum> =
        starts.map(|(start, widening)| descend_from(belief, trials, start, widening)).collect();
    found.sort_by(|one, other| one.squares.total_cmp(&other.squares));
    let mut minima: Vec<Minimum> = Vec::new();
    for minimum in found {
        let constants = |minimum: &Minimum| minimum.parameters[..belief.count()].to_vec();
        let distance = |one: &Minimum| {
            constants(one).iter().zip(constants(&minimum)).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max)
        };
        if minima.iter().all(|one| distance(one) > SAME_MINIMUM) {
            minima.push(minimum);
        }
    }
    minima
}

/// Finds the minimum from these unknowns of the table, first with standard errors multiplied by `widening`, then with the true ones.
fn descend_from(belief: &Belief, trials: &[Trial], mut start: Vec<f64>, widening: f64) -> Minimum {
    let mut problem = Joint { belief, trials, widening };
    let table = belief.table(&start);
    start.extend(trials.iter().flat_map(|trial| {
        let squares = |speed: f64| -> f64 {
            let stroke = [speed, 0.0, 0.0, 0.0, 0.0, 0.0];
            problem.mark_residuals(&table, trial, &stroke).map(|residual| residual * residual).sum::<f64>()
                + speed * speed
        };
        let tried = SPEEDS.map(|speed| (squares(speed), speed));
        let (_, best) = tried.into_iter().min_by(|one, other| one.0.total_cmp(&other.0)).unwrap_or_default();
        [best, 0.0, 0.0, 0.0, 0.0, 0.0]
    }));
    let first = minimize(&start, MAX_ITERATIONS, &mut problem);
    problem.widening = 1.0;
    minimize(&first.parameters, MAX_ITERATIONS, &mut problem)
}

/// The joint least-squares problem. Its parameters are the constants' unknowns, then the numbers of each trial's stroke.
struct Joint<'a> {
    belief: &'a Belief,
    trials: &'a [Trial],
    /// Factor on the standard errors of all marks.
    widening: f64,
}

impl Joint<'_> {
    /// Returns the softened residuals of a trial's marks for this stroke.
    fn mark_residuals(
        &self,
        table: &Table,
        trial: &Trial,
        stroke: &[f64; STROKE_PARAMETERS],
    ) -> impl Iterator<Item = f64> {
        standardized_residuals(table, trial, stroke).into_iter().map(|off| robust_residual(off / self.widening))
    }

    fn stroke(&self, parameters: &[f64], trial: usize) -> [f64; STROKE_PARAMETERS] {
        let first = self.belief.count() + trial * STROKE_PARAMETERS;
        std::array::from_fn(|index| parameters[first + index])
    }

    /// Returns the offset of each trial's residuals, and the end of the last.
    fn offsets(&self) -> Vec<usize> {
        let mut offset = self.belief.count() + self.trials.len() * STROKE_PARAMETERS;
        let mut offsets = vec![offset];
        for trial in self.trials {
            offset += trial.readings.len();
            offsets.push(offset);
        }
        offsets
    }
}

impl LeastSquaresProblem for Joint<'_> {
    /// The residuals of the prior on each parameter, then those of the marks.
    fn residuals(&mut self, parameters: &[f64], out: &mut Vec<f64>) {
        out.clear();
        out.extend(parameters);
        let table = self.belief.table(&parameters[..self.belief.count()]);
        for (index, trial) in self.trials.iter().enumerate() {
            out.extend(self.mark_residuals(&table, trial, &self.stroke(parameters, index)));
        }
    }

    fn derivatives(&mut self, parameters: &[f64], residuals: &[f64]) -> Vec<Vec<f64>> {
        let count = self.belief.count();
        let offsets = self.offsets();
        let table = self.belief.table(&parameters[..count]);
        let column = |index: usize| {
            let mut column = vec![0.0; residuals.len()];
            column[index] = 1.0;
            let mut moved = parameters.to_vec();
            moved[index] += STEP;
            let changed = (index < count).then(|| self.belief.table(&moved[..count]));
            for (number, trial) in self.trials.iter().enumerate() {
                let is_of_this_trial = index >= count && (index - count) / STROKE_PARAMETERS == number;
                if changed.is_none() && !is_of_this_trial {
                    continue;
                }
                let stroke = self.stroke(&moved, number);
                let moved_residuals = self.mark_residuals(changed.as_ref().unwrap_or(&table), trial, &stroke);
                for (row, residual) in (offsets[number]..).zip(moved_residuals) {
                    column[row] = (residual - residuals[row]) / STEP;
                }
            }
            column
        };
        (0..parameters.len()).map(column).collect()
    }
}

/// Returns the residuals of a trial's marks for this stroke, expected minus marked, in standard errors.
pub fn standardized_residuals(table: &Table, trial: &Trial, stroke: &[f64; STROKE_PARAMETERS]) -> Vec<f64> {
    let expected = expected(table, trial, stroke);
    let off = |(reading, mark): (&Reading, Option<f64>)| {
        mark.map_or(UNREACHED_RESIDUAL, |mark| (mark - reading.value) / reading.standard_error)
    };
    trial.readings.iter().zip(expected).map(off).collect()
}

/// Returns the expected values of a trial's readings for this stroke; `None` for a mark to which the ball never gets.
pub fn expected(table: &Table, trial: &Trial, stroke: &[f64; STROKE_PARAMETERS]) -> Vec<Option<f64>> {
    let seen = StrokeSpread::ASSUMED.simulate_marks(table, trial.test, trial.is_turned, stroke);
    trial.readings.iter().map(|reading| seen[reading.mark]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_variance_of_two_minima_includes_their_distance() {
        let valley = |weight: f64, mean: f64| (weight, (vec![mean, 0.0], vec![vec![0.5, 0.1], vec![0.1, 1.0]]));
        let (means, covariance) = moments(2, &[valley(3.0, 1.0), valley(1.0, -3.0)]);
        assert_eq!(means, [0.0, 0.0]);
        // Three quarters at 1 and one quarter at -3 add a variance of 3 to their own.
        assert_eq!(covariance, [vec![3.5, 0.1], vec![0.1, 1.0]]);
    }
}
