//! How well a player does on held-out layouts.

use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;
use serde::Serialize;

use crate::table::{Layout, Table};

/// Seed of the layouts that training measures itself on.
pub const HELD_OUT_SEED: u64 = 2026;

/// Seed of the layouts that `carom evaluate` measures on: no training run and no setting was ever chosen by them.
pub const EVALUATION_SEED: u64 = 1867;

/// Steps of resting contacts that are followed while an agent trains; a shot that needs more counts for what it has earned so
/// far. Of 12,000 shots at a ball on the `thesis` table all but one earned the same as when followed to the end, in a
/// twentieth of the time.
pub const CONTACT_STEPS: u32 = 20;

/// `count` layouts drawn from `seed`.
pub fn held_out_layouts(table: &Table, count: usize, seed: u64) -> Vec<Layout> {
    // Jumped ahead by 2^192 numbers: no training run of the same seed reaches these layouts.
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
    rng.long_jump();
    (0..count).map(|_| Layout::random(table, &mut rng)).collect()
}

/// A share of successes and the interval in which the true one lies with 95 % confidence.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SuccessRate {
    /// Trials: layouts of a policy, or attempts of a player at one shot.
    #[serde(rename = "layouts")]
    pub trials: usize,
    /// Successes among them.
    pub successes: usize,
    /// Their share.
    pub rate: f64,
    /// Lower end of the interval.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

impl SuccessRate {
    /// The share of `successes` among `trials`, with Wilson's score interval: unlike the textbook's it stays within
    /// 0 to 1 and holds near its ends.
    pub fn new(successes: usize, trials: usize) -> Self {
        const Z: f64 = 1.959_963_984_540_054;
        if trials == 0 {
            return Self { trials, successes, rate: 0.0, low: 0.0, high: 1.0 };
        }
        let (n, rate) = (trials as f64, successes as f64 / trials as f64);
        let centre = rate + Z * Z / (2.0 * n);
        let spread = Z * (rate * (1.0 - rate) / n + Z * Z / (4.0 * n * n)).sqrt();
        let scale = 1.0 + Z * Z / n;
        let bound = |value: f64| (value / scale).clamp(0.0, 1.0);
        // Exact at the ends, where rounding would spoil it.
        let low = if successes == 0 { 0.0 } else { bound(centre - spread) };
        let high = if successes == trials { 1.0 } else { bound(centre + spread) };
        Self { trials, successes, rate, low, high }
    }
}

/// What a policy earned on a set of layouts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Score {
    /// Mean reward of its first choice.
    pub mean_reward: f64,
    /// Share of layouts in which any of its proposals earns at least one: what a perfect choice would reach, but for
    /// proposals that leave balls pressed together for long.
    pub best_of_k: f64,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wilsons_interval_matches_published_values_and_stays_within_nought_to_one() {
        // Newcombe 1998, table I: 81 of 263 gives 0.2553 to 0.3662, 0 of 20 gives 0 to 0.1611.
        let rate = SuccessRate::new(81, 263);
        assert!((rate.low - 0.2553).abs() < 5e-5 && (rate.high - 0.3662).abs() < 5e-5, "{rate:?}");
        let none = SuccessRate::new(0, 20);
        assert!(none.low == 0.0 && (none.high - 0.1611).abs() < 5e-5, "{none:?}");
        assert_eq!((SuccessRate::new(0, 0).low, SuccessRate::new(0, 0).high), (0.0, 1.0));
    }

    #[test]
    fn held_out_layouts_repeat_and_differ_from_what_the_same_seed_trains_on() {
        let table = Table::default();
        let layouts = held_out_layouts(&table, 3, 1);
        assert_eq!(layouts, held_out_layouts(&table, 3, 1));
        assert_ne!(layouts[0], Layout::random(&table, &mut Xoshiro256PlusPlus::seed_from_u64(1)));
    }
}
