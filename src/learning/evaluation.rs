//! Held-out layouts and the score of a policy on them.

use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;

use crate::table::{Layout, Table};

/// Seed of the held-out layouts on which a training run measures its progress.
pub const HELD_OUT_SEED: u64 = 2026;

/// Seed of the layouts that `carom evaluate` uses. No training run uses them, and a comparison that is to choose between networks should
/// name another seed.
pub const EVALUATION_SEED: u64 = 1867;

/// Limit on the steps of resting contacts that are simulated for a shot in training. A shot that needs more keeps the reward that it
/// has earned so far. Of 12,000 shots at a ball on the `thesis` table all but one earned the same reward as without the limit, and
/// training takes a sixth less time.
pub const CONTACT_STEPS: u32 = 20;

/// Draws `count` layouts from `seed`.
pub fn held_out_layouts(table: &Table, count: usize, seed: u64) -> Vec<Layout> {
    // A jump of 2^192 numbers: no training run with the same seed reaches these layouts.
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
    rng.long_jump();
    (0..count).map(|_| Layout::random(table, &mut rng)).collect()
}

/// Result of a policy on a set of layouts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Score {
    /// Mean reward of the policy's first choice.
    pub mean_reward: f64,
    /// Share of layouts on which at least one proposal earns a reward of 1 or more (best-of-k success). A perfect choice among the
    /// proposals would reach it, except for proposals that leave balls pressed together for long.
    pub best_of_k: f64,
}

impl Score {
    /// Computes the score from one pair per layout: the reward of the first choice, and whether any proposal earned 1 or more.
    pub fn of(played: &[(f64, bool)]) -> Self {
        let count = played.len().max(1) as f64;
        let total = played.iter().fold(0.0, |total, (first, _)| total + first);
        let successes = played.iter().filter(|(_, any_succeeds)| *any_succeeds).count();
        Self { mean_reward: total / count, best_of_k: successes as f64 / count }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn held_out_layouts_repeat_and_differ_from_training_layouts() {
        let table = Table::default();
        let layouts = held_out_layouts(&table, 3, 1);
        assert_eq!(layouts, held_out_layouts(&table, 3, 1));
        assert_ne!(layouts[0], Layout::random(&table, &mut Xoshiro256PlusPlus::seed_from_u64(1)));
    }
}
