//! Paired comparison of two measurements on the same layouts: differences between the layouts cancel.

use std::{fmt, path::PathBuf};

use serde::Serialize;

use super::{
    robustness::{MIN_LAYOUTS, Z},
    shots::ShotRecord,
    spec::{Records, Spec, merge},
};
use crate::{
    commands::{Failure, output::plural},
    statistics::mean_and_deviation,
};

/// The difference between two measurements.
#[derive(Debug, PartialEq, Serialize)]
pub struct Comparison {
    /// The compared quantity: the make probability if both measured it, otherwise the reward without errors.
    compared: &'static str,
    layouts: usize,
    /// Mean of the differences.
    difference: f64,
    /// Its 95 % interval, from their spread; `None` for too few layouts, or if all differences are equal.
    difference_interval: Option<[f64; 2]>,
    /// Number of layouts on which the first measurement is better, and on which it is worse.
    better: usize,
    worse: usize,
}

impl Comparison {
    /// Compares the measurement `records` with the one in the files `others`.
    pub fn of(spec: &Spec, records: &Records, others: &[PathBuf]) -> Result<Self, Failure> {
        let (other, theirs) = merge(others)?;
        let (Records::Shots(own), Records::Shots(theirs)) = (records, &theirs) else {
            return Err(Failure::wrong_input(
                "innings of self-play cannot be compared: --against needs one shot per layout",
            ));
        };
        if let Some(what) = spec.layout_difference(&other) {
            return Err(Failure::wrong_input(format_args!(
                "only measurements on the same layouts are compared: {what}"
            )));
        }
        // For players with different errors, only the rewards without errors are comparable.
        let is_same_player = (spec.skill, spec.doubt) == (other.skill, other.doubt);
        Ok(Self::between(own, theirs, is_same_player))
    }

    /// Compares records of the same layouts in the same order.
    fn between(own: &[ShotRecord], theirs: &[ShotRecord], is_same_player: bool) -> Self {
        let pairs = || own.iter().zip(theirs);
        let chances = pairs().map(|(own, theirs)| Some(own.chance? - theirs.chance?)).collect::<Option<Vec<f64>>>();
        let (compared, differences) = match chances.filter(|_| is_same_player) {
            Some(differences) => ("make_probability", differences),
            None => ("reward", pairs().map(|(own, theirs)| own.earned - theirs.earned).collect()),
        };
        let (mean, deviation) = mean_and_deviation(&differences);
        let spread = student_quantile(differences.len()) * deviation.unwrap_or(0.0) / (differences.len() as f64).sqrt();
        let is_meaningful = differences.len() >= MIN_LAYOUTS && spread > 0.0;
        Self {
            compared,
            layouts: differences.len(),
            difference: mean,
            difference_interval: is_meaningful.then_some([mean - spread, mean + spread]),
            better: differences.iter().filter(|difference| **difference > 0.0).count(),
            worse: differences.iter().filter(|difference| **difference < 0.0).count(),
        }
    }
}

/// Returns the 97.5 % quantile of Student's distribution for the mean of `count` numbers, by the expansion of Cornish and Fisher; accurate
/// to 0.2 % from [`MIN_LAYOUTS`] on.
fn student_quantile(count: usize) -> f64 {
    let freedom = count.saturating_sub(1).max(1) as f64;
    let (third, fifth) = (Z.powi(3), Z.powi(5));
    Z + (third + Z) / (4.0 * freedom) + (5.0 * fifth + 16.0 * third + 3.0 * Z) / (96.0 * freedom.powi(2))
}

impl fmt::Display for Comparison {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { layouts, difference, better, worse, .. } = self;
        let compared = if self.compared == "reward" { "mean reward" } else { "make probability" };
        write!(formatter, "difference of {compared} on the same {}: {difference:+.4}", plural(*layouts, "layout"))?;
        match self.difference_interval {
            Some([low, high]) => write!(formatter, " (95 % interval {low:+.4} to {high:+.4})")?,
            None => write!(formatter, " (too little to say anything about other layouts)")?,
        }
        write!(formatter, ", better on {better}, worse on {worse}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn student_quantiles_match_published_tables() {
        for (count, quantile) in [(10, 2.2622), (31, 2.0423), (1001, 1.9623)] {
            assert!((student_quantile(count) - quantile).abs() < 4e-3, "{count}: {}", student_quantile(count));
        }
    }

    #[test]
    fn shared_variation_does_not_widen_the_interval() {
        let record = |layout: u32, chance| ShotRecord { layout, chance, ..ShotRecord::default() };
        // Layouts differ by up to 0.6, and the first measurement is better by 0.05 or 0.07 on each.
        let of = |more: f64, less: f64| -> Vec<ShotRecord> {
            let chance =
                |layout: u32| 0.2 + 0.006 * f64::from(layout) + if layout.is_multiple_of(2) { more } else { less };
            (0..100).map(|layout| record(layout, Some(chance(layout)))).collect()
        };
        let (own, theirs) = (of(0.05, 0.07), of(0.0, 0.0));
        let Comparison { difference, difference_interval, better, worse, .. } =
            Comparison::between(&own, &theirs, true);
        let [low, high] = difference_interval.unwrap();
        assert!((difference - 0.06).abs() < 1e-12 && (high - low - 0.00394).abs() < 1e-4, "{low} to {high}");
        assert_eq!((better, worse), (100, 0));
        assert_eq!(Comparison::between(&own, &own, true).difference_interval, None, "the same shots");
        assert_eq!(Comparison::between(&own, &theirs, false).compared, "reward");
    }
}
