//! Platt scaling: calibrates the critic's probabilities for the strokes that it chose itself to their actual success.
//!
//! The best of many estimates is usually too high (the winner's curse). So a critic that is right on average predicts too much success
//! for its choice.

use glam::{DMat3, DVec3};
use serde::{Deserialize, Serialize};

/// Limit on the steps of Newton's method, and on the halvings of one step. The log-likelihood is concave, and most fits need five full
/// steps.
const STEPS: i32 = 25;

/// Weight of the squared deviation of the factors from the identity. Compared with thousands of attempts it matters only where these
/// contain no information.
const PRIOR: f64 = 10.0;

/// Maps the critic's logit to a probability (Platt 1999), for players without and with errors: factors of 1, of the
/// logit, and of the logarithm of the player's errors in multiples of an expert's.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Calibration {
    flawless: DVec3,
    erring: DVec3,
}

/// A stroke that the critic chose, and its attempts.
#[derive(Clone, Copy, Debug)]
pub struct Trial {
    /// The critic's logit of success.
    pub logit: f64,
    /// The player's errors as a multiple of an expert's.
    pub errors: f64,
    /// Number of attempts.
    pub attempts: f64,
    /// Number of successes.
    pub successes: f64,
}

impl Default for Calibration {
    /// The identity: the critic's own probability.
    fn default() -> Self {
        Self { flawless: DVec3::Y, erring: DVec3::Y }
    }
}

impl Calibration {
    /// Fits the calibration to these trials. A fit that would reverse the critic's order is replaced by the identity.
    pub fn of(trials: &[Trial]) -> Self {
        let of = |has_errors: bool| {
            let some: Vec<&Trial> = trials.iter().filter(|trial| (trial.errors > 0.0) == has_errors).collect();
            Some(fit(&some)).filter(|factors| factors.is_finite() && factors.y > 0.0).unwrap_or(DVec3::Y)
        };
        Self { flawless: of(false), erring: of(true) }
    }

    /// Returns the probability of success for the critic's `logit` and a player whose errors are `errors` times an expert's.
    pub fn probability(&self, logit: f64, errors: f64) -> f64 {
        let factors = if errors > 0.0 { self.erring } else { self.flawless };
        logistic(factors.dot(inputs(logit, errors)))
    }
}

fn inputs(logit: f64, errors: f64) -> DVec3 {
    DVec3::new(1.0, logit, if errors > 0.0 { libm::log(errors) } else { 0.0 })
}

fn logistic(logit: f64) -> f64 {
    1.0 / (1.0 + libm::exp(-logit))
}

/// Returns the factors of the highest posterior density; the prior is centred on the identity.
fn fit(trials: &[&Trial]) -> DVec3 {
    let mut factors = DVec3::Y;
    for _ in 0..STEPS {
        let (mut slope, mut curvature) = (PRIOR * (DVec3::Y - factors), DMat3::from_diagonal(DVec3::splat(PRIOR)));
        for Trial { logit, errors, attempts, successes } in trials {
            let inputs = inputs(*logit, *errors);
            let predicted = logistic(factors.dot(inputs));
            slope += (successes - attempts * predicted) * inputs;
            let weighted = attempts * predicted * (1.0 - predicted) * inputs;
            curvature += DMat3::from_cols(weighted * inputs.x, weighted * inputs.y, weighted * inputs.z);
        }
        let step = curvature.inverse() * slope;
        let current = log_posterior(trials, factors);
        let mut shares = (0..STEPS).map(|halvings| 0.5_f64.powi(halvings));
        // A full step goes too far if nearly all attempts succeed.
        let Some(share) = shares.find(|share| log_posterior(trials, factors + *share * step) >= current) else {
            break;
        };
        factors += share * step;
    }
    factors
}

/// Returns the log posterior of the factors up to a constant.
fn log_posterior(trials: &[&Trial], factors: DVec3) -> f64 {
    let log_likelihood = trials.iter().map(|Trial { logit, errors, attempts, successes }| {
        let logit = factors.dot(inputs(*logit, *errors));
        successes * logit - attempts * (logit.max(0.0) + libm::log1p(libm::exp(-logit.abs())))
    });
    log_likelihood.sum::<f64>() - 0.5 * PRIOR * factors.distance_squared(DVec3::Y)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Trials whose share of successes is `truth` of the logit.
    fn trials(errors: f64, truth: impl Fn(f64) -> f64) -> impl Iterator<Item = Trial> {
        (-40..=40).map(move |step| {
            let (logit, attempts) = (0.1 * f64::from(step), 1000.0);
            Trial { logit, errors, attempts, successes: attempts * truth(logit) }
        })
    }

    #[test]
    fn overconfident_predictions_are_corrected() {
        let [flawless, expert, beginner] = [
            |logit| logistic(0.8 * logit - 0.3),
            |logit| logistic(0.9 * logit - 0.1),
            |logit| logistic(0.9 * logit - 0.4),
        ];
        let all = trials(0.0, flawless).chain(trials(1.0, expert)).chain(trials(8.0, beginner));
        let calibration = Calibration::of(&all.collect::<Vec<_>>());
        for logit in [-3.0, -0.5, 0.0, 2.0] {
            for (errors, truth) in [(0.0, flawless(logit)), (1.0, expert(logit)), (8.0, beginner(logit))] {
                let predicted = calibration.probability(logit, errors);
                assert!((predicted - truth).abs() < 1e-3, "{errors} {logit}: {predicted} for {truth}");
            }
        }
    }

    #[test]
    fn unusable_fits_leave_the_probabilities_unchanged() {
        let turned: Vec<Trial> = trials(1.0, |logit| logistic(-logit)).collect();
        for calibration in [Calibration::default(), Calibration::of(&[]), Calibration::of(&turned)] {
            for errors in [0.0, 1.0, 9.0] {
                assert!((calibration.probability(1.5, errors) - logistic(1.5)).abs() < 1e-15);
            }
        }
    }

    #[test]
    fn a_fit_to_successes_alone_gives_a_probability() {
        let certain = Calibration::of(&trials(0.0, |_| 1.0).collect::<Vec<_>>());
        assert!((0.9..=1.0).contains(&certain.probability(2.0, 0.0)), "{certain:?}");
    }
}
