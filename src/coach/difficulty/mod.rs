//! A quick estimate of how easy a layout is for the next shot, without any simulation.

mod fit;

pub use fit::DifficultySample;

use super::Skill;
use crate::{
    game::Rule,
    statistics::dot,
    table::{Layout, Table},
};

/// Number of features of a layout: a constant, distances and an angle.
const FEATURES: usize = 8;

/// Softplus width: a weighted sum near or below zero gives a small positive share instead of zero. No layout is
/// perfectly safe, and the easier of two very easy ones still ranks higher.
const SOFTNESS: f64 = 0.02;

/// Length of the `match` table, m: the weights apply to distances on a table of this length.
const MATCH_LENGTH: f64 = 2.84;

/// Smallest error scale: a player with smaller errors than this multiple of [`Skill::level`] 1 is treated as having these.
const SMALLEST_SCALE: f64 = 0.1;

/// The difficulty model of a rule: a weighted sum of layout features.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LayoutDifficulty {
    /// Weights for the share that [`LayoutDifficulty::WEAK`] misses: a constant;
    /// the cue ball's distance a from the nearer object ball and that ball's distance c from the other, 1/m; a², c² and
    /// a c, 1/m²; the cosine of the turn between these two paths, and its square.
    pub weights: [f64; FEATURES],
    /// The share that [`LayoutDifficulty::STRONG`] misses is the weak player's share raised to this power.
    pub power: f64,
}

impl LayoutDifficulty {
    /// The weaker of the two players that the weights are fitted to, between national and club level.
    pub const WEAK: Skill = Skill::level(3.8);

    /// The stronger one, about world class.
    pub const STRONG: Skill = Skill::level(1.25);

    /// Returns the current weights, from `cargo run --release --example ease -- 600`. Checked on 300 layouts per rule
    /// that took no part in the fit: the weaker player missed the easiest fifth 14, 33 and 58 % of the time (estimated:
    /// 13, 27 and 59), the hardest fifth 58, 58 and 76 % (estimated: 62, 57 and 74).
    pub const fn for_rule(rule: Rule) -> Self {
        let (weights, power) = match rule {
            Rule::StraightRail => ([-0.0987, 0.2365, 0.499, -0.0411, -0.1112, -0.013, -0.0735, -0.0161], 2.37),
            Rule::OneCushion => ([0.0545, 0.1459, 0.3684, -0.0139, -0.0805, 0.0069, 0.0094, 0.011], 2.31),
            Rule::ThreeCushion => ([0.5079, 0.1903, 0.107, -0.0549, -0.0261, -0.0112, 0.0518, 0.0037], 2.78),
        };
        Self { weights, power }
    }

    /// Estimates the probability of the point from `layout`, for a player of this skill who plays a good shot: a rough
    /// estimate for ranking.
    pub fn probability(&self, table: &Table, layout: &Layout, skill: Skill) -> f64 {
        1.0 - self.miss_rate(table, layout).powf(self.power_at(skill.scale()))
    }

    /// Returns the power for a player of this error scale: 1 for [`LayoutDifficulty::WEAK`], `power` for
    /// [`LayoutDifficulty::STRONG`], with linear interpolation and extrapolation on logarithmic axes.
    fn power_at(&self, scale: f64) -> f64 {
        let [weak, strong] = [Self::WEAK, Self::STRONG].map(|skill| skill.scale().ln());
        self.power.powf((weak - scale.max(SMALLEST_SCALE).ln()) / (weak - strong))
    }

    /// Whether the weights were fitted on this table. On other tables they still rank layouts, but the probabilities
    /// are unknown.
    pub fn is_known_on(table: &Table) -> bool {
        *table == Table::default()
    }

    /// Estimates the share of attempts that [`LayoutDifficulty::WEAK`] misses from `layout`.
    pub fn miss_rate(&self, table: &Table, layout: &Layout) -> f64 {
        let share = dot(&self.weights, &features(table, layout));
        (SOFTNESS * (share / SOFTNESS).exp().ln_1p()).min(1.0)
    }
}

/// Computes the features of the estimate, with distances scaled to the length of the `match` table.
fn features(table: &Table, layout: &Layout) -> [f64; FEATURES] {
    let [cue, mut near, mut far] = layout.balls.map(|ball| ball * (MATCH_LENGTH / table.length));
    if cue.distance_squared(near) > cue.distance_squared(far) {
        std::mem::swap(&mut near, &mut far);
    }
    let (to_near, onward) = (near - cue, far - near);
    let (a, c) = (to_near.length(), onward.length());
    // Cosine of the turn from the path to the nearer object ball to the path on to the other one.
    let straight = to_near.normalize_or_zero().dot(onward.normalize_or_zero());
    [1.0, a, c, a * a, c * c, a * c, straight, straight * straight]
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;

    #[test]
    fn gathered_balls_are_easier_than_scattered_ones() {
        let table = Table::default();
        let gathered = Layout::new([DVec2::new(0.0, 0.0), DVec2::new(0.1, 0.05), DVec2::new(0.15, -0.1)]);
        let scattered = Layout::new([DVec2::new(-1.2, 0.0), DVec2::new(0.2, 0.6), DVec2::new(1.3, -0.6)]);
        for rule in Rule::ALL {
            let [easy, hard] = [&gathered, &scattered]
                .map(|layout| LayoutDifficulty::for_rule(rule).probability(&table, layout, Skill::EXPERT));
            assert!(hard + 0.02 < easy && easy < 1.0, "{rule}: {easy} {hard}");
        }
    }

    #[test]
    fn difficulty_is_symmetric_in_balls_and_table_side() {
        let table = Table::default();
        let [a, b, c] = [DVec2::new(-0.3, 0.2), DVec2::new(0.4, 0.1), DVec2::new(0.2, -0.5)];
        for rule in Rule::ALL {
            let probability =
                |balls| LayoutDifficulty::for_rule(rule).probability(&table, &Layout::new(balls), Skill::EXPERT);
            assert!((probability([a, b, c]) - probability([-a, -c, -b])).abs() < 1e-12);
        }
    }

    #[test]
    fn larger_errors_mean_a_higher_miss_rate() {
        let table = Table::default();
        let layout = Layout::opening(&table);
        let missed = |skill| 1.0 - LayoutDifficulty::for_rule(Rule::ThreeCushion).probability(&table, &layout, skill);
        let all = [Skill::PERFECT, Skill::EXPERT, Skill::CLUB, Skill::BEGINNER].map(missed);
        assert!(all.is_sorted() && all[0] < 1e-4 && all[3] > 0.3 && all[3] < 1.0, "{all:?}");
        let fitted = LayoutDifficulty::for_rule(Rule::ThreeCushion).miss_rate(&table, &layout);
        assert!((missed(LayoutDifficulty::WEAK) - fitted).abs() < 1e-12);
    }
}
