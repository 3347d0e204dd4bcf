//! Make probability of the chosen shots, with errors that took no part in the choice.

use std::fmt;

use serde::Serialize;

use super::spec::Spec;
use crate::{
    coach::{Doubt, Shooter, Skill, layout_seed, make_probability},
    commands::output::plural,
    game::Rule,
    physics::{CueInputs, has_room},
    statistics::mean_and_deviation,
    table::{Layout, Table},
};

/// Number of independent attempts at each shot.
const ATTEMPTS: usize = 1000;

/// Two-sided 95 % quantile of the normal distribution.
pub const Z: f64 = 1.96;

/// Minimum number of layouts for a statement about other layouts.
pub const MIN_LAYOUTS: usize = 10;

/// The make probability over all layouts.
#[derive(Debug, Serialize)]
pub struct Robustness {
    skill: Skill,
    doubt: Doubt,
    /// Mean make probability.
    make_probability: f64,
    /// Its 95 % interval, from the spread between layouts; `None` for fewer than [`MIN_LAYOUTS`].
    make_interval: Option<[f64; 2]>,
    /// The first decile of the make probability over the layouts; `None` for fewer than [`MIN_LAYOUTS`].
    worst_tenth: Option<f64>,
    /// The predictions, if there were any.
    #[serde(flatten)]
    reliability: Option<Reliability>,
}

/// Predictions of the recommender or the networks, compared with the observations.
#[derive(Debug, Serialize)]
pub struct Reliability {
    /// Mean of the predictions; a layout without a shot counts as a predicted miss.
    #[serde(rename = "claimed")]
    predicted: f64,
    /// By tenths of the prediction; only those that contain a layout.
    #[serde(rename = "tenths")]
    bins: Vec<Bin>,
}

impl Reliability {
    /// Compares the predictions with the observations, layout by layout.
    pub fn new(predicted: &[Option<f64>], observed: &[f64]) -> Self {
        let tenth = |predicted: f64| ((10.0 * predicted) as usize).min(9);
        let bins = (0..10).filter_map(|which| {
            let pairs = predicted.iter().map(|predicted| predicted.unwrap_or(0.0)).zip(observed);
            let among: Vec<_> = pairs.filter(|(predicted, _)| tenth(*predicted) == which).collect();
            let mean = |sum: f64| sum / among.len() as f64;
            (!among.is_empty()).then(|| Bin {
                layouts: among.len(),
                predicted: mean(among.iter().map(|(predicted, _)| predicted).sum()),
                observed: mean(among.iter().map(|(_, observed)| **observed).sum()),
            })
        });
        let all: f64 = predicted.iter().flatten().sum();
        Self { predicted: all / predicted.len().max(1) as f64, bins: bins.collect() }
    }
}

impl fmt::Display for Reliability {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "predicted: {:.2} %", 100.0 * self.predicted)?;
        for Bin { layouts, predicted, observed } in &self.bins {
            write!(
                formatter,
                "\npredicted {:.1} %, observed {:.1} % ({})",
                100.0 * predicted,
                100.0 * observed,
                plural(*layouts, "layout")
            )?;
        }
        Ok(())
    }
}

/// The layouts with about the same prediction.
#[derive(Debug, Serialize)]
struct Bin {
    layouts: usize,
    #[serde(rename = "claimed")]
    predicted: f64,
    #[serde(rename = "made")]
    observed: f64,
}

/// Returns the make probability of a shot on the layout with number `index`; 0 if the cue has no room for it.
pub fn chance(
    spec: &Spec,
    rule: Rule,
    table: &Table,
    (index, layout): (u32, &Layout),
    skill: Skill,
    cue: &CueInputs,
) -> f64 {
    if !has_room(table, layout, cue) {
        return 0.0;
    }
    // Not the recommender's random stream, which also uses the measurement's seed. Each layout has its own errors: common errors would
    // correlate the chances, and the interval, which assumes independent layouts, would be too narrow.
    let shooter = Shooter { skill, doubt: spec.doubt };
    make_probability(shooter, rule, table, layout, cue, ATTEMPTS, !layout_seed(spec.seed, index)).rate
}

impl Robustness {
    /// Computes the statistics from the make probability on every layout, and compares it with the predictions, if there were any;
    /// `chances` must not be empty.
    pub fn new(skill: Skill, doubt: Doubt, chances: &[f64], predicted: Option<&[Option<f64>]>) -> Self {
        let mut sorted = chances.to_vec();
        sorted.sort_by(f64::total_cmp);
        // One layout at either extreme is added, as Agresti and Coull (1998) add attempts: a small sample of rates near 1 seldom contains
        // the rare layouts that are missed, so its own deviation is too small.
        let padded: Vec<f64> = chances.iter().copied().chain([0.0, 1.0]).collect();
        let (middle, deviation) = mean_and_deviation(&padded);
        let spread = Z * deviation.unwrap_or(0.0) / (padded.len() as f64).sqrt();
        let interval = [(middle - spread).max(0.0), (middle + spread).min(1.0)];
        let is_enough = chances.len() >= MIN_LAYOUTS;
        Self {
            skill,
            doubt,
            make_probability: mean_and_deviation(chances).0,
            make_interval: is_enough.then_some(interval),
            worst_tenth: is_enough.then(|| sorted[sorted.len() / 10]),
            reliability: predicted.map(|predicted| Reliability::new(predicted, chances)),
        }
    }
}

impl fmt::Display for Robustness {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let made = 100.0 * self.make_probability;
        write!(
            formatter,
            "a player of skill \"{}\" (doubt \"{}\") makes them {made:.2} % of the time",
            self.skill, self.doubt
        )?;
        match (self.make_interval, self.worst_tenth) {
            (Some([low, high]), Some(worst)) => write!(
                formatter,
                " (95 % interval {:.2} to {:.2} %), on a tenth of the layouts at most {:.1} %",
                100.0 * low,
                100.0 * high,
                100.0 * worst
            )?,
            _ => write!(formatter, "; fewer than {MIN_LAYOUTS} layouts say nothing about others")?,
        }
        self.reliability.as_ref().map_or(Ok(()), |reliability| write!(formatter, "\n{reliability}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_layouts_give_no_interval() {
        let of = |chances: &[f64]| Robustness::new(Skill::CLUB, Doubt::FULL, chances, None);
        let few = of(&[0.737; 9]);
        assert_eq!((few.make_interval, few.worst_tenth), (None, None));
        assert!(
            few.to_string().ends_with("73.70 % of the time; fewer than 10 layouts say nothing about others"),
            "{few}"
        );
        let [low, high] = of(&[1.0; 20]).make_interval.unwrap();
        assert!(low < 0.9 && high == 1.0, "20 of 20 can be luck: {low}");
        let [nearly, _] = of(&[[0.999].repeat(19), vec![1.0]].concat()).make_interval.unwrap();
        assert!((nearly - low).abs() < 1e-2, "a rate of 99.9 % says no more than one of 100 %: {nearly}");
        let spread = of(&[0.2, 0.8].repeat(50));
        let [low, high] = spread.make_interval.unwrap();
        assert!((low - 0.441).abs() < 1e-3 && (high - 0.559).abs() < 1e-3, "{low} to {high}");
        assert_eq!(spread.worst_tenth, Some(0.2));
    }

    #[test]
    fn every_layout_has_its_own_errors_and_tables() {
        let layout = Layout::opening(&Table::default());
        for doubt in [Doubt::FULL, Doubt::NONE] {
            let spec = Spec { doubt, ..Spec::of_random_search(4) };
            let on = |index, cue: &CueInputs| {
                chance(&spec, Rule::StraightRail, &spec.table, (index, &layout), Skill::CLUB, cue)
            };
            let cue = |step| CueInputs { a: 0.0, b: 0.2, theta: 0.1, phi: 0.02 * f64::from(step), speed: 3.0 };
            let uncertain = (-157..157).map(cue).find(|cue| (0.02..0.98).contains(&on(0, cue))).unwrap();
            let chances: Vec<f64> = (0..4).map(|index| on(index, &uncertain)).collect();
            assert!(chances.iter().any(|chance| *chance != chances[0]), "the same errors on each: {chances:?}");
            assert_eq!(chances, (0..4).map(|index| on(index, &uncertain)).collect::<Vec<_>>());
        }
    }

    #[test]
    fn predictions_and_observations_are_compared_by_tenths() {
        let predicted = [Some(0.05), Some(0.93), Some(0.97), None, Some(1.0)];
        let reliability = Reliability::new(&predicted, &[0.0, 1.0, 0.5, 1.0, 1.0]);
        let bins: Vec<_> = reliability.bins.iter().map(|bin| (bin.layouts, bin.observed)).collect();
        assert_eq!(bins, [(2, 0.5), (3, 2.5 / 3.0)], "a layout without a shot is one of which nothing was predicted");
        assert!((reliability.predicted - 2.95 / 5.0).abs() < 1e-12);
        assert!(reliability.to_string().starts_with("predicted: 59.00 %"), "{reliability}");
        // Scripts read these names.
        let json = serde_json::to_value(&reliability).unwrap();
        assert!(json["claimed"].is_f64() && json["tenths"][0]["made"] == 0.5, "{json}");
    }
}
