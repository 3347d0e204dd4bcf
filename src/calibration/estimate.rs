//! The constants that the marks of some trials speak for: first the most likely ones with the strokes that were really struck
//! and the normal distribution around them (Laplace's approximation), then what [`Posterior`] makes of it.

use super::{
    belief::Belief,
    forward::{Hand, STROKE},
    posterior::Posterior,
    protocol::Test,
    robust::{NEVER, soften},
};
use crate::{
    statistics::{Minimum, Problem, half_log_determinant, identity, minimize, normal_matrix, solve},
    table::Table,
};

/// A number that was marked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// Which of the test's marks.
    pub mark: usize,
    /// Its value, in its unit.
    pub value: f64,
    /// Its standard error.
    pub sure: f64,
}

/// A stroke of a test and what was marked.
#[derive(Clone, Debug, PartialEq)]
pub struct Trial {
    /// The test.
    pub test: &'static Test,
    /// Whether it was played from the far end.
    pub is_turned: bool,
    /// What was marked; marks may be left out.
    pub readings: Vec<Reading>,
}

/// Where derivatives by differences are taken, in deviations of the unknowns.
pub const STEP: f64 = 0.02;

/// Rounds of the fit; it takes about ten.
const ROUNDS: usize = 60;

/// How many times as unsure marks are taken to be at first: from far off, a few misread ones could lead astray. Where a ball has
/// turned at a rail once more than it should, one way leads into another valley than the other.
const FIRST: [f64; 2] = [3.0, 10.0];

/// The speeds at which strokes are first looked for, in deviations from the one that is asked for.
const SPEEDS: [f64; 9] = [-2.0, -1.5, -1.0, -0.5, 0.0, 0.5, 1.0, 1.5, 2.0];

/// The constant that has several valleys: a ball that a rail throws back a little more, or a little earlier, can come the same
/// way. The fit begins at each of these places of it too, in deviations of what was held before.
const VALLEYS: (&str, [f64; 2]) = ("rail.kappa", [-1.4, 1.4]);

/// Minima whose unknowns differ by no more than this are one.
const SAME: f64 = 0.2;

/// A valley counts that is at least so likely against the likeliest.
const LEAST: f64 = 0.01;

/// What was found.
#[derive(Clone, Debug)]
pub struct Estimate {
    /// The means of the unknowns of [`Belief`].
    pub unknowns: Vec<f64>,
    /// Their covariance.
    pub covariance: Vec<Vec<f64>>,
    /// The most likely unknowns: with the most likely strokes they come nearest to the marks, which means need not.
    pub likely: Vec<f64>,
    /// The most likely strokes of the trials.
    pub strokes: Vec<[f64; STROKE]>,
    /// The normal matrix of unknowns and strokes there.
    normal: Vec<Vec<f64>>,
}

impl Estimate {
    /// The distribution around the likeliest of some minima, and around others as far as they are likely: each has the weight of its
    /// normal distribution (Laplace), and what all have together is told by its means and its covariance.
    fn of(belief: &Belief, trials: &[Trial], minima: &[Minimum]) -> Option<Self> {
        let count = belief.count();
        let mut problem = Joint { belief, trials, unsure: 1.0 };
        let valley = |found: &Minimum| {
            let mut residuals = Vec::new();
            problem.residuals(&found.parameters, &mut residuals);
            let normal = normal_matrix(&problem.derivatives(&found.parameters, &residuals));
            Some((-0.5 * found.squares - half_log_determinant(&normal)?, normal))
        };
        let valleys: Vec<Option<(f64, Vec<Vec<f64>>)>> = minima.iter().map(valley).collect();
        let evidence = |valley: &Option<(f64, Vec<Vec<f64>>)>| valley.as_ref().map_or(f64::NEG_INFINITY, |one| one.0);
        let (best, highest) = (0..minima.len())
            .map(|index| (index, evidence(&valleys[index])))
            .max_by(|one, other| one.1.total_cmp(&other.1))?;
        let mut mixture = Vec::new();
        for (found, valley) in minima.iter().zip(&valleys) {
            let weight = (evidence(valley) - highest).exp();
            if let Some((_, normal)) = valley.as_ref().filter(|_| weight >= LEAST) {
                let first = Posterior { mean: found.parameters.clone(), normal: normal.clone() };
                mixture.push((weight, first.settled(belief, trials).of_the_first(count)));
            }
        }
        let (unknowns, covariance) = moments(count, &mixture);
        let (likely, strokes) = minima[best].parameters.split_at(count);
        let strokes = strokes.as_chunks::<STROKE>().0.to_vec();
        let normal = valleys[best].clone()?.1;
        Some(Self { unknowns, covariance, likely: likely.to_vec(), strokes, normal })
    }

    /// What is expected of a mark, with its deviation: the mark itself has a say in it only as far as it is believed.
    pub fn expected(&self, belief: &Belief, trials: &[Trial], trial: usize, mark: usize) -> Option<(f64, f64)> {
        let Trial { test, is_turned, .. } = trials[trial];
        let seen = |unknowns: &[f64], stroke: &[f64; STROKE]| {
            Hand::ASSUMED.seen(&belief.table(unknowns), test, is_turned, stroke)[mark]
        };
        let stroke = self.strokes[trial];
        let at = seen(&self.likely, &stroke)?;
        let mut slope = vec![0.0; self.normal.len()];
        let (count, own) = (belief.count(), belief.count() + trial * STROKE);
        for (index, seen) in (0..count).chain(own..).zip(moved(&self.likely, &stroke, seen)) {
            slope[index] = (seen? - at) / STEP;
        }
        let spread = solve(&self.normal, &slope)?;
        Some((at, slope.iter().zip(spread).map(|(x, y)| x * y).sum::<f64>().max(0.0).sqrt()))
    }
}

/// Means and covariance.
type Moments = (Vec<f64>, Vec<Vec<f64>>);

/// Those of a mixture of normal distributions of `count` numbers, each with a weight.
fn moments(count: usize, mixture: &[(f64, Moments)]) -> Moments {
    let all = mixture.iter().fold(0.0, |all, (weight, _)| all + weight);
    let mean = |row: usize| mixture.iter().fold(0.0, |sum, (weight, (mean, _))| sum + weight * mean[row]) / all;
    let means: Vec<f64> = (0..count).map(mean).collect();
    let entry = |row: usize, column: usize| {
        let product = |(weight, (mean, covariance)): &(f64, Moments)| {
            weight * (covariance[row][column] + mean[row] * mean[column])
        };
        mixture.iter().fold(0.0, |sum, one| sum + product(one)) / all - means[row] * means[column]
    };
    let covariance = (0..count).map(|row| (0..count).map(|column| entry(row, column)).collect()).collect();
    (means, covariance)
}

/// What is seen where one of the unknowns, and then one of the stroke's numbers, is a [`STEP`] further on.
pub fn moved<T>(
    unknowns: &[f64],
    stroke: &[f64; STROKE],
    seen: impl Fn(&[f64], &[f64; STROKE]) -> T,
) -> impl Iterator<Item = T> {
    (0..unknowns.len() + STROKE).map(move |index| {
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
        // Where no minimum has a width, nothing is told: all is as it was held to be before.
        let (count, all) = (belief.count(), belief.count() + STROKE * trials.len());
        let nought = vec![0.0; count];
        Estimate {
            unknowns: nought.clone(),
            covariance: identity(count),
            likely: nought,
            strokes: vec![[0.0; STROKE]; trials.len()],
            normal: identity(all),
        }
    })
}

/// The different minima that are found from what was held of the table before, the lowest first.
fn descend(belief: &Belief, trials: &[Trial]) -> Vec<Minimum> {
    let nought = vec![0.0; belief.count()];
    let (name, places) = VALLEYS;
    let others = places.into_iter().filter_map(|place| belief.unknowns_at(name, place));
    let starts = FIRST.map(|first| (nought.clone(), first)).into_iter().chain(others.map(|start| (start, FIRST[0])));
    let mut found: Vec<Minimum> = starts.map(|(start, first)| descend_from(belief, trials, start, first)).collect();
    found.sort_by(|one, other| one.squares.total_cmp(&other.squares));
    let mut minima: Vec<Minimum> = Vec::new();
    for minimum in found {
        let constants = |minimum: &Minimum| minimum.parameters[..belief.count()].to_vec();
        let apart = |one: &Minimum| {
            constants(one).iter().zip(constants(&minimum)).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max)
        };
        if minima.iter().all(|one| apart(one) > SAME) {
            minima.push(minimum);
        }
    }
    minima
}

/// The minimum that is found from these unknowns of the table with marks that are taken to be so many times as unsure at first.
fn descend_from(belief: &Belief, trials: &[Trial], mut start: Vec<f64>, first: f64) -> Minimum {
    let mut problem = Joint { belief, trials, unsure: first };
    let table = belief.table(&start);
    start.extend(trials.iter().flat_map(|trial| {
        let squares = |speed: f64| -> f64 {
            let stroke = [speed, 0.0, 0.0, 0.0, 0.0, 0.0];
            problem.misses(&table, trial, &stroke).map(|miss| miss * miss).sum::<f64>() + speed * speed
        };
        let tried = SPEEDS.map(|speed| (squares(speed), speed));
        let (_, best) = tried.into_iter().min_by(|one, other| one.0.total_cmp(&other.0)).unwrap_or_default();
        [best, 0.0, 0.0, 0.0, 0.0, 0.0]
    }));
    let first = minimize(&start, ROUNDS, &mut problem);
    problem.unsure = 1.0;
    minimize(&first.parameters, ROUNDS, &mut problem)
}

/// Constants and strokes at once: first the constants' unknowns, then those of each trial's stroke.
struct Joint<'a> {
    belief: &'a Belief,
    trials: &'a [Trial],
    unsure: f64,
}

impl Joint<'_> {
    /// How far the marks of a trial are off with this stroke, softened.
    fn misses(&self, table: &Table, trial: &Trial, stroke: &[f64; STROKE]) -> impl Iterator<Item = f64> {
        off(table, trial, stroke).into_iter().map(|off| soften(off / self.unsure))
    }

    fn stroke(&self, parameters: &[f64], trial: usize) -> [f64; STROKE] {
        let first = self.belief.count() + trial * STROKE;
        std::array::from_fn(|index| parameters[first + index])
    }

    /// Where the residuals of each trial's marks begin, and of what follows the last.
    fn places(&self) -> Vec<usize> {
        let mut place = self.belief.count() + self.trials.len() * STROKE;
        let mut places = vec![place];
        for trial in self.trials {
            place += trial.readings.len();
            places.push(place);
        }
        places
    }
}

impl Problem for Joint<'_> {
    /// First what the belief and the hand hold against each parameter, then the marks.
    fn residuals(&mut self, parameters: &[f64], out: &mut Vec<f64>) {
        out.clear();
        out.extend(parameters);
        let table = self.belief.table(&parameters[..self.belief.count()]);
        for (index, trial) in self.trials.iter().enumerate() {
            out.extend(self.misses(&table, trial, &self.stroke(parameters, index)));
        }
    }

    fn derivatives(&mut self, parameters: &[f64], residuals: &[f64]) -> Vec<Vec<f64>> {
        let count = self.belief.count();
        let places = self.places();
        let table = self.belief.table(&parameters[..count]);
        let column = |index: usize| {
            let mut column = vec![0.0; residuals.len()];
            column[index] = 1.0;
            let mut moved = parameters.to_vec();
            moved[index] += STEP;
            let changed = (index < count).then(|| self.belief.table(&moved[..count]));
            for (number, trial) in self.trials.iter().enumerate() {
                let is_its_own = index >= count && (index - count) / STROKE == number;
                if changed.is_none() && !is_its_own {
                    continue;
                }
                let stroke = self.stroke(&moved, number);
                let misses = self.misses(changed.as_ref().unwrap_or(&table), trial, &stroke);
                for (place, miss) in (places[number]..).zip(misses) {
                    column[place] = (miss - residuals[place]) / STEP;
                }
            }
            column
        };
        (0..parameters.len()).map(column).collect()
    }
}

/// How far the marks of a trial are off with this stroke, in their standard errors.
pub fn off(table: &Table, trial: &Trial, stroke: &[f64; STROKE]) -> Vec<f64> {
    let expected = expected(table, trial, stroke);
    let off =
        |(reading, mark): (&Reading, Option<f64>)| mark.map_or(NEVER, |mark| (mark - reading.value) / reading.sure);
    trial.readings.iter().zip(expected).map(off).collect()
}

/// What the marks of a trial are with this stroke, reading by reading.
pub fn expected(table: &Table, trial: &Trial, stroke: &[f64; STROKE]) -> Vec<Option<f64>> {
    let seen = Hand::ASSUMED.seen(table, trial.test, trial.is_turned, stroke);
    trial.readings.iter().map(|reading| seen[reading.mark]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_valleys_apart_are_as_wide_as_their_distance_says() {
        let valley = |weight: f64, mean: f64| (weight, (vec![mean, 0.0], vec![vec![0.5, 0.1], vec![0.1, 1.0]]));
        let (means, covariance) = moments(2, &[valley(3.0, 1.0), valley(1.0, -3.0)]);
        assert_eq!(means, [0.0, 0.0]);
        // Three quarters at 1, a quarter at -3: a variance of 3 besides their own.
        assert_eq!(covariance, [vec![3.5, 0.1], vec![0.1, 1.0]]);
    }
}
