//! The named levels: each is called after what it averages at three-cushion, found by self-play.

use super::{Growth, Skill};

/// What a player averages at three-cushion whose errors are an expert's at the reference stroke, and the power by which the
/// average falls with their size: the line through what the coach's shots made on `match`, table and placing in doubt, with
/// errors of 1.27, 1.49, 2.18, 3.63, 3.7, 7.85 and 9.2 times an expert's (averages 2.51, 2.32, 1.17, 0.69, 0.52, 0.18 and 0.10
/// in 200 to 600 innings each), if both are drawn on logarithmic axes. `carom evaluate --self-play --rule three-cushion
/// --skill club --layouts 300 --simulations 90000` measures one.
const AVERAGE_OF_EXPERTS_ERRORS: f64 = 3.86;
const FALL: f64 = 1.49;

impl Skill {
    /// Averages about 2 points an inning at three-cushion.
    pub const WORLD_CLASS: Self = Self::level(1.55);

    /// Averages about 1.
    pub const NATIONAL: Self = Self::level(2.45);

    /// Averages about 0.5.
    pub const CLUB: Self = Self::level(3.95);

    /// Averages about 0.15.
    pub const BEGINNER: Self = Self::level(8.8);

    /// A player whose errors at the reference stroke are so many times an expert's, and grow as usual.
    pub const fn level(scale: f64) -> Self {
        Self { growth: Growth::USUAL, ..Self::EXPERT.scaled(scale) }
    }

    /// The averages at three-cushion that were measured, about; beyond them nobody knows which errors a player has.
    pub const AVERAGES: (f64, f64) = (0.1, 2.5);

    /// The level that averages so much at three-cushion; `None` where none was measured.
    pub fn of_average(average: f64) -> Option<Self> {
        let (least, most) = Self::AVERAGES;
        let scale = (AVERAGE_OF_EXPERTS_ERRORS / average).powf(1.0 / FALL);
        (least..=most).contains(&average).then(|| Self::level(scale))
    }

    /// The average of which [`Skill::of_average`] makes this player; the named ones have none.
    pub fn as_average(&self) -> Option<f64> {
        // Nobody knows more digits of his own.
        let average = (1e4 * Self::average(self.scale())).round() / 1e4;
        (Self::of_average(average) == Some(*self)).then_some(average)
    }

    /// What such a player averages at three-cushion.
    pub fn average(scale: f64) -> f64 {
        AVERAGE_OF_EXPERTS_ERRORS * scale.powf(-FALL)
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
            assert!((measured / average - 1.0).abs() < 0.05, "{skill}: {measured}");
        }
        let all: Vec<f64> = (1..200).map(|step| Skill::average(0.1 * f64::from(step))).collect();
        assert!(all.is_sorted_by(|one, other| one > other) && all[198] > 0.0, "{all:?}");
    }
}
