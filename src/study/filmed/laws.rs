//! How much each law of the rails is to be believed after the film: by how well it predicts shots that it was not fitted to.

use super::{
    chains,
    constants::{Fitted, fit_constants},
    film::FilmedShot,
};
use crate::{
    study::statistics::Spread,
    table::{RailModel, Table},
};

/// A law of the rails, and what the film says of it.
#[derive(Clone, Debug)]
pub struct Weighed {
    /// The law with its own best constants on the whole film.
    pub fitted: Fitted,
    /// How likely it is that the law predicts a meeting with a rail, among those that were weighed together.
    pub weight: f64,
    /// By how much it misses the rails that it predicts on shots it was not fitted to: median, diamonds. A rail that is not met counts as 9 m off.
    pub median: f64,
    /// How many of these there are.
    pub predicted: usize,
}

/// Rounds of the weights' search, which converges to the one maximum.
const ROUNDS: usize = 2000;

/// Weighs laws by stacking (Yao, Vehtari, Simpson and Gelman 2018): the weights are those of the mixture that makes the filmed rails
/// most likely that were predicted by the constants of the other half of the film.
///
/// As many meetings of each law count as if `sure` of them had been predicted equally well by all: few stretches shall
/// not rule out a law.
pub fn weigh(table: &Table, models: &[RailModel], film: &[FilmedShot], sure: f64) -> Vec<Weighed> {
    let half = |rest: usize| -> Vec<FilmedShot> { film.iter().skip(rest).step_by(2).cloned().collect() };
    let halves = [half(0), half(1)];
    let misses: Vec<Vec<f64>> = models
        .iter()
        .map(|model| {
            let on = |fit_on: usize| {
                let table = fit_constants(table, *model, &halves[fit_on]).table;
                let diamond = table.diamond();
                let miss = move |chain: chains::Chain| {
                    let played = chain.play(&table);
                    played.places[played.places.len() - 1] / diamond
                };
                chains::all(&Table::default(), &halves[1 - fit_on], 4).into_iter().map(miss).collect::<Vec<_>>()
            };
            [on(1), on(0)].concat()
        })
        .collect();
    let median = |misses: &Vec<f64>| Spread::of(misses.clone()).map_or(f64::NAN, |spread| spread.median);
    // Half of a Cauchy distribution lies within its scale: a ball that slips in place of sticking is far off.
    let scale = median(&misses.concat());
    let likely: Vec<Vec<f64>> =
        misses.iter().map(|misses| misses.iter().map(|miss| 1.0 / (1.0 + (miss / scale).powi(2))).collect()).collect();
    let weights = stacked(&likely, sure);
    let weighed = |((model, weight), misses): ((&RailModel, f64), &Vec<f64>)| Weighed {
        fitted: fit_constants(table, *model, film),
        weight,
        median: median(misses),
        predicted: misses.len(),
    };
    models.iter().zip(weights).zip(&misses).map(weighed).collect()
}

/// The weights with which a mixture makes what was seen most likely, by expectation maximization; `likely` has a row a law.
fn stacked(likely: &[Vec<f64>], sure: f64) -> Vec<f64> {
    let laws = likely.len() as f64;
    let seen = likely.first().map_or(0, Vec::len);
    let mut weights = vec![1.0 / laws; likely.len()];
    for _ in 0..ROUNDS {
        let mut shares = vec![sure / laws; likely.len()];
        for index in 0..seen {
            let all: f64 = likely.iter().zip(&weights).map(|(row, weight)| weight * row[index]).sum();
            for ((share, row), weight) in shares.iter_mut().zip(likely).zip(&weights) {
                *share += weight * row[index] / all;
            }
        }
        weights = shares.iter().map(|share| share / (seen as f64 + sure)).collect();
    }
    weights
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_law_that_predicts_better_weighs_more_and_few_cases_rule_out_none() {
        let (good, bad) = (vec![0.9; 20], vec![0.1; 20]);
        let [first, second] = stacked(&[good.clone(), bad.clone()], 0.0)[..] else { panic!() };
        assert!(first > 0.999 && (first + second - 1.0).abs() < 1e-9);
        let sure = stacked(&[good, bad], 20.0);
        assert!((0.2..0.35).contains(&sure[1]), "{sure:?}");
        // Each right on half of the cases: the mixture needs both.
        let [one, other]: [Vec<f64>; 2] =
            [0, 1].map(|rest| (0..20).map(|index| if index % 2 == rest { 0.9 } else { 0.1 }).collect());
        let both = stacked(&[one, other], 0.0);
        assert!((both[0] - 0.5).abs() < 1e-6, "{both:?}");
    }
}
