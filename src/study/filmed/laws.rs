//! Weighs the models of the rails by how well they predict filmed shots that they were not fitted to.

use super::{
    chains,
    constants::{Fitted, fit_constants},
    film::FilmedShot,
};
use crate::{
    study::statistics::Spread,
    table::{RailModel, Table},
};

/// A model of the rails and its weight.
#[derive(Clone, Debug)]
pub struct WeightedModel {
    /// The model with its constants fitted to the whole film.
    pub fitted: Fitted,
    /// Weight of the model in the mixture of all weighed models that predicts the rail impacts best.
    pub weight: f64,
    /// Median error on rails of shots outside the fit, diamonds. A rail that the ball does not reach counts as 9 m off.
    pub median: f64,
    /// Number of predicted rails.
    pub predicted: usize,
}

/// Iterations of the search for the weights, which converges to the only maximum.
const ROUNDS: usize = 2000;

/// Weighs models by stacking (Yao, Vehtari, Simpson and Gelman 2018): the weights are those of the mixture that maximizes the
/// likelihood of the filmed rail impacts, each predicted with constants fitted to the other half of the film.
///
/// `sure` is the strength of the prior: the number of additional impacts that count as predicted equally well by all models. A
/// few stretches therefore cannot rule out a model.
pub fn weigh_models(table: &Table, models: &[RailModel], film: &[FilmedShot], sure: f64) -> Vec<WeightedModel> {
    let half = |rest: usize| -> Vec<FilmedShot> { film.iter().skip(rest).step_by(2).cloned().collect() };
    let halves = [half(0), half(1)];
    let misses: Vec<Vec<f64>> = models
        .iter()
        .map(|model| {
            let on = |fit_on: usize| {
                let fitted = fit_constants(table, *model, &halves[fit_on]).table;
                let diamond = fitted.diamond();
                let miss = move |chain: chains::Chain| chain.predict(&fitted).distance / diamond;
                chains::all(table, &halves[1 - fit_on], 4).into_iter().map(miss).collect::<Vec<_>>()
            };
            [on(1), on(0)].concat()
        })
        .collect();
    let median = |misses: &Vec<f64>| Spread::of(misses.clone()).map_or(f64::NAN, |spread| spread.median);
    // The likelihood is a Cauchy distribution, half of which lies within its scale: a ball that slips instead of sticking is
    // far off.
    let scale = median(&misses.concat());
    let likelihoods: Vec<Vec<f64>> =
        misses.iter().map(|misses| misses.iter().map(|miss| 1.0 / (1.0 + (miss / scale).powi(2))).collect()).collect();
    let weights = stacking_weights(&likelihoods, sure);
    let weighed = |((model, weight), misses): ((&RailModel, f64), &Vec<f64>)| WeightedModel {
        fitted: fit_constants(table, *model, film),
        weight,
        median: median(misses),
        predicted: misses.len(),
    };
    models.iter().zip(weights).zip(&misses).map(weighed).collect()
}

/// Returns the weights of the mixture with the greatest likelihood, by expectation maximization. `likelihoods` has a row per model.
fn stacking_weights(likelihoods: &[Vec<f64>], sure: f64) -> Vec<f64> {
    let laws = likelihoods.len() as f64;
    let seen = likelihoods.first().map_or(0, Vec::len);
    let mut weights = vec![1.0 / laws; likelihoods.len()];
    for _ in 0..ROUNDS {
        let mut shares = vec![sure / laws; likelihoods.len()];
        for index in 0..seen {
            let all: f64 = likelihoods.iter().zip(&weights).map(|(row, weight)| weight * row[index]).sum();
            for ((share, row), weight) in shares.iter_mut().zip(likelihoods).zip(&weights) {
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
    fn better_law_weighs_more_and_the_prior_excludes_none() {
        let (good, bad) = (vec![0.9; 20], vec![0.1; 20]);
        let [first, second] = stacking_weights(&[good.clone(), bad.clone()], 0.0)[..] else { panic!() };
        assert!(first > 0.999 && (first + second - 1.0).abs() < 1e-9);
        let sure = stacking_weights(&[good, bad], 20.0);
        assert!((0.2..0.35).contains(&sure[1]), "{sure:?}");
        // Each model is right on half of the cases: the mixture needs both.
        let [one, other]: [Vec<f64>; 2] =
            [0, 1].map(|rest| (0..20).map(|index| if index % 2 == rest { 0.9 } else { 0.1 }).collect());
        let both = stacking_weights(&[one, other], 0.0);
        assert!((both[0] - 0.5).abs() < 1e-6, "{both:?}");
    }
}
