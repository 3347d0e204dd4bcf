//! Fits the weights: least squares over layouts whose miss rates are known.

use super::{FEATURES, LayoutDifficulty, features};
use crate::{
    statistics::solve,
    table::{Layout, Table},
};

/// Ridge term on the diagonal of the normal equations, relative to the mean square of the features. It changes the
/// weights in the sixth digit and keeps them finite if the layouts do not determine all weights.
const RIDGE: f64 = 1e-6;

/// Search interval for the stronger player's power.
const POWERS: (f64, f64) = (1.0, 10.0);

/// A layout and its miss rates with a good shot.
#[derive(Clone, Copy, Debug)]
pub struct DifficultySample {
    /// The layout.
    pub layout: Layout,
    /// Share of attempts that [`LayoutDifficulty::WEAK`] misses.
    pub missed: f64,
    /// Share of attempts that [`LayoutDifficulty::STRONG`] misses.
    pub missed_by_strong: f64,
}

impl LayoutDifficulty {
    /// Fits the weights to the miss rates by least squares, and the power so that the stronger player's total misses agree.
    pub fn fit(table: &Table, samples: &[DifficultySample]) -> Self {
        let mut equations = vec![vec![0.0; FEATURES]; FEATURES];
        let mut right = vec![0.0; FEATURES];
        for sample in samples {
            let numbers = features(table, &sample.layout);
            for (row, number) in numbers.iter().enumerate() {
                right[row] += number * sample.missed;
                for (entry, other) in equations[row].iter_mut().zip(&numbers) {
                    *entry += number * other;
                }
            }
        }
        for (index, row) in equations.iter_mut().enumerate() {
            row[index] += RIDGE * (1.0 + samples.len() as f64);
        }
        let weights = solve(&equations, &right).and_then(|found| found.try_into().ok());
        let mut difficulty = Self { weights: weights.unwrap_or([0.0; FEATURES]), power: 1.0 };
        let estimates: Vec<f64> = samples.iter().map(|sample| difficulty.miss_rate(table, &sample.layout)).collect();
        let best: f64 = samples.iter().map(|sample| sample.missed_by_strong).sum();
        let (mut low, mut high) = POWERS;
        for _ in 0..40 {
            difficulty.power = 0.5 * (low + high);
            // A higher power means fewer misses.
            if estimates.iter().map(|share| share.powf(difficulty.power)).sum::<f64>() > best {
                low = difficulty.power;
            } else {
                high = difficulty.power;
            }
        }
        difficulty
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_xoshiro::Xoshiro256PlusPlus;

    #[test]
    fn fit_recovers_known_weights() {
        let table = Table::default();
        let difficulty = LayoutDifficulty { weights: [0.1, 0.3, 0.2, -0.08, -0.05, 0.02, -0.06, 0.07], power: 2.5 };
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(5);
        let samples: Vec<DifficultySample> = (0..400)
            .map(|_| {
                let layout = Layout::random(&table, &mut rng);
                let missed = difficulty.miss_rate(&table, &layout);
                DifficultySample { layout, missed, missed_by_strong: missed.powf(difficulty.power) }
            })
            .collect();
        let fit = LayoutDifficulty::fit(&table, &samples);
        for (found, meant) in fit.weights.into_iter().zip(difficulty.weights) {
            assert!((found - meant).abs() < 1e-3, "{found} {meant}");
        }
        assert!((fit.power - difficulty.power).abs() < 0.01, "{}", fit.power);
        let few = LayoutDifficulty::fit(&table, &samples[..2]);
        assert!(few.weights.iter().all(|weight| weight.is_finite()) && few.power.is_finite());
    }
}
