//! Platt scaling: what a critic says of the strokes that it chose itself, against how often they are made.
//!
//! Whoever takes the best of many estimates takes those that are too high (the winner's curse), so that a critic which is right
//! on average promises too much of its choice.

use glam::{DMat3, DVec3};
use serde::{Deserialize, Serialize};

/// Steps of Newton's method, and halvings of one, at most: the logarithm of the likelihood is concave, and most trials need five whole
/// steps.
const STEPS: i32 = 25;

/// Weight of the square by which factors differ from those that change nothing: next to thousands of attempts it decides only where
/// these say nothing.
const PRIOR: f64 = 10.0;

/// From the critic's logit to a probability (Platt 1999), for players without errors and for those who err: factors of 1, of the
/// logit, and of the logarithm of the player's errors in multiples of an expert's.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Calibration {
    flawless: DVec3,
    erring: DVec3,
}

/// A stroke that was chosen and tried.
#[derive(Clone, Copy, Debug)]
pub struct Trial {
    /// The critic's logit of success.
    pub logit: f64,
    /// The player's errors as a multiple of an expert's.
    pub errors: f64,
    /// How often it was struck.
    pub attempts: f64,
    /// How often it succeeded.
    pub successes: f64,
}

impl Default for Calibration {
    /// The critic is taken at its word.
    fn default() -> Self {
        Self { flawless: DVec3::Y, erring: DVec3::Y }
    }
}

impl Calibration {
    /// The likeliest one by what was made in these trials. One that would turn the critic's order round is not used.
    pub fn of(trials: &[Trial]) -> Self {
        let of = |errs: bool| {
            let some: Vec<&Trial> = trials.iter().filter(|trial| (trial.errors > 0.0) == errs).collect();
            Some(likeliest(&some)).filter(|factors| factors.is_finite() && factors.y > 0.0).unwrap_or(DVec3::Y)
        };
        Self { flawless: of(false), erring: of(true) }
    }

    /// The probability of success by the critic's `logit`, for a player with so many times an expert's errors.
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

/// The factors of greatest likelihood, a priori near those that change nothing.
fn likeliest(trials: &[&Trial]) -> DVec3 {
    let mut factors = DVec3::Y;
    for _ in 0..STEPS {
        let (mut slope, mut curvature) = (PRIOR * (DVec3::Y - factors), DMat3::from_diagonal(DVec3::splat(PRIOR)));
        for Trial { logit, errors, attempts, successes } in trials {
            let inputs = inputs(*logit, *errors);
            let said = logistic(factors.dot(inputs));
            slope += (successes - attempts * said) * inputs;
            let weighted = attempts * said * (1.0 - said) * inputs;
            curvature += DMat3::from_cols(weighted * inputs.x, weighted * inputs.y, weighted * inputs.z);
        }
        let step = curvature.inverse() * slope;
        let here = log_posterior(trials, factors);
        let mut shares = (0..STEPS).map(|halvings| 0.5_f64.powi(halvings));
        // Where nearly all is made a whole step leads too far.
        let Some(share) = shares.find(|share| log_posterior(trials, factors + *share * step) >= here) else {
            break;
        };
        factors += share * step;
    }
    factors
}

/// Logarithm of how likely the factors are, but for what is the same for all.
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

    /// Trials of which as many succeed as `truth` says.
    fn trials(errors: f64, truth: impl Fn(f64) -> f64) -> impl Iterator<Item = Trial> {
        (-40..=40).map(move |step| {
            let (logit, attempts) = (0.1 * f64::from(step), 1000.0);
            Trial { logit, errors, attempts, successes: attempts * truth(logit) }
        })
    }

    #[test]
    fn what_was_promised_too_high_is_told_as_it_is_made() {
        let [flawless, expert, beginner] = [
            |logit| logistic(0.8 * logit - 0.3),
            |logit| logistic(0.9 * logit - 0.1),
            |logit| logistic(0.9 * logit - 0.4),
        ];
        let all = trials(0.0, flawless).chain(trials(1.0, expert)).chain(trials(8.0, beginner));
        let calibration = Calibration::of(&all.collect::<Vec<_>>());
        for logit in [-3.0, -0.5, 0.0, 2.0] {
            for (errors, truth) in [(0.0, flawless(logit)), (1.0, expert(logit)), (8.0, beginner(logit))] {
                let told = calibration.probability(logit, errors);
                assert!((told - truth).abs() < 1e-3, "{errors} {logit}: {told} for {truth}");
            }
        }
    }

    #[test]
    fn nothing_changes_without_trials_or_where_the_order_would_turn_round() {
        let turned: Vec<Trial> = trials(1.0, |logit| logistic(-logit)).collect();
        for calibration in [Calibration::default(), Calibration::of(&[]), Calibration::of(&turned)] {
            for errors in [0.0, 1.0, 9.0] {
                assert!((calibration.probability(1.5, errors) - logistic(1.5)).abs() < 1e-15);
            }
        }
    }

    #[test]
    fn where_all_strokes_are_made_a_probability_is_told_nonetheless() {
        let certain = Calibration::of(&trials(0.0, |_| 1.0).collect::<Vec<_>>());
        assert!((0.9..=1.0).contains(&certain.probability(2.0, 0.0)), "{certain:?}");
    }
}
