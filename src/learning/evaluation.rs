//! How well a player does on held-out layouts.

use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;

use crate::table::{Layout, Table};

/// Seed of the layouts that training measures itself on.
pub const HELD_OUT_SEED: u64 = 2026;

/// Seed of the layouts that `carom evaluate` measures on: no training run and no setting was ever chosen by them.
pub const EVALUATION_SEED: u64 = 1867;

/// Steps of resting contacts that are followed while an agent trains; a shot that needs more counts for what it has earned so
/// far. Of 12,000 shots at a ball on the `thesis` table all but one earned the same as when followed to the end, and training takes a
/// sixth less time.
pub const CONTACT_STEPS: u32 = 20;

/// `count` layouts drawn from `seed`.
pub fn held_out_layouts(table: &Table, count: usize, seed: u64) -> Vec<Layout> {
    // Jumped ahead by 2^192 numbers: no training run of the same seed reaches these layouts.
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
    rng.long_jump();
    (0..count).map(|_| Layout::random(table, &mut rng)).collect()
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

impl Score {
    /// From what the first choice earned on each layout, and whether any proposal earned at least one there.
    pub fn of(played: &[(f64, bool)]) -> Self {
        let count = played.len().max(1) as f64;
        let total = played.iter().fold(0.0, |total, (first, _)| total + first);
        let reached = played.iter().filter(|(_, is_reached)| *is_reached).count();
        Self { mean_reward: total / count, best_of_k: reached as f64 / count }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn held_out_layouts_repeat_and_differ_from_what_the_same_seed_trains_on() {
        let table = Table::default();
        let layouts = held_out_layouts(&table, 3, 1);
        assert_eq!(layouts, held_out_layouts(&table, 3, 1));
        assert_ne!(layouts[0], Layout::random(&table, &mut Xoshiro256PlusPlus::seed_from_u64(1)));
    }
}
