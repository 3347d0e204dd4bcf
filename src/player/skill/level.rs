//! The named levels: each has the errors that lead to a certain three-cushion average, found by self-play.

use super::{Growth, Skill};

/// Three-cushion average of a player with an expert's errors at the reference stroke, and the power by which the
/// average falls with the size of the errors. Fitted as a line on logarithmic axes to self-play of the coach's shots on
/// `match`, with table and placing in doubt.
/// The errors were 1.27, 1.49, 2.18, 3.63, 3.7, 7.85 and 9.2 times an expert's, and the averages 2.51, 2.32, 1.17,
/// 0.69, 0.52, 0.18 and 0.10 in 200 to 600 innings each. `carom evaluate --self-play --rule three-cushion --skill club
/// --layouts 300 --simulations 90000` measures one of them.
const AVERAGE_OF_EXPERTS_ERRORS: f64 = 3.86;
const AVERAGE_EXPONENT: f64 = 1.49;

impl Skill {
    /// Averages about 2 points per inning at three-cushion.
    pub const WORLD_CLASS: Self = Self::level(1.55);

    /// Averages about 1.
    pub const NATIONAL: Self = Self::level(2.45);

    /// Averages about 0.5.
    pub const CLUB: Self = Self::level(3.95);

    /// Averages about 0.15.
    pub const BEGINNER: Self = Self::level(8.8);

    /// Returns a player whose errors at the reference stroke are `scale` times an expert's, with the usual growth.
    pub const fn level(scale: f64) -> Self {
        Self { growth: Growth::USUAL, ..Self::EXPERT.scaled(scale) }
    }

    /// Range of the three-cushion averages that were measured, approximately; outside it, the errors of a player are unknown.
    pub const AVERAGES: (f64, f64) = (0.1, 2.5);

    /// Returns the level with this three-cushion average; `None` if it is outside the measured range.
    pub fn of_average(average: f64) -> Option<Self> {
        let (least, most) = Self::AVERAGES;
        let scale = (AVERAGE_OF_EXPERTS_ERRORS / average).powf(1.0 / AVERAGE_EXPONENT);
        (least..=most).contains(&average).then(|| Self::level(scale))
    }

    /// Returns the average for which [`Skill::of_average`] returns this player; `None` for the named levels.
    pub fn as_average(&self) -> Option<f64> {
        // More digits would have no meaning.
        let average = (1e4 * Self::average(self.scale())).round() / 1e4;
        (Self::of_average(average) == Some(*self)).then_some(average)
    }

    /// Returns the three-cushion average of such a player.
    pub fn average(scale: f64) -> f64 {
        AVERAGE_OF_EXPERTS_ERRORS * scale.powf(-AVERAGE_EXPONENT)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn named_levels_have_their_averages_in_decreasing_order() {
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
