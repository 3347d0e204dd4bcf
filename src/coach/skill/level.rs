//! The named levels: each is called after what it averages at three-cushion, found by self-play.

use super::{Growth, Skill};

/// Errors in multiples of an expert's at the reference stroke, and the average at three-cushion that the coach's shots make
/// with them on `match`, table and placing in doubt: `carom evaluate --self-play --rule three-cushion --skill club`.
const AVERAGES: [(f64, f64); 7] =
    [(1.0, 2.23), (1.4, 1.88), (2.4, 0.88), (4.0, 0.47), (6.0, 0.27), (8.0, 0.13), (12.0, 0.085)];

impl Skill {
    /// Averages about 2 points an inning at three-cushion.
    pub const WORLD_CLASS: Self = Self::level(1.25);

    /// Averages about 1.
    pub const NATIONAL: Self = Self::level(2.15);

    /// Averages about 0.5.
    pub const CLUB: Self = Self::level(3.8);

    /// Averages about 0.15.
    pub const BEGINNER: Self = Self::level(7.6);

    /// A player whose errors at the reference stroke are so many times an expert's, and grow as usual.
    pub const fn level(scale: f64) -> Self {
        Self { growth: Growth::USUAL, ..Self::EXPERT.scaled(scale) }
    }

    /// What such a player averages at three-cushion: straight between the measured levels if both are drawn on logarithmic axes.
    pub fn average(scale: f64) -> f64 {
        let place = AVERAGES.windows(2).position(|pair| scale < pair[1].0).unwrap_or(AVERAGES.len() - 2);
        let [(low, above), (high, below)] = [AVERAGES[place], AVERAGES[place + 1]];
        above * (below / above).powf((scale / low).ln() / (high / low).ln())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_named_levels_average_what_they_are_named_after_and_who_errs_more_averages_less() {
        for (skill, average) in
            [(Skill::WORLD_CLASS, 2.0), (Skill::NATIONAL, 1.0), (Skill::CLUB, 0.5), (Skill::BEGINNER, 0.15)]
        {
            let measured = Skill::average(skill.scale());
            assert!((measured / average - 1.0).abs() < 0.2, "{skill}: {measured}");
        }
        let all: Vec<f64> = (1..200).map(|step| Skill::average(0.1 * f64::from(step))).collect();
        assert!(all.is_sorted_by(|one, other| one > other) && all[198] > 0.0, "{all:?}");
    }
}
