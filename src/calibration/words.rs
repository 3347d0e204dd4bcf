//! Describes the result of a calibration in a player's words.

use super::{
    calibrate::{Calibration, Change, MarkCheck, OutlierStroke},
    protocol::Test,
};
use crate::table::Rail;

/// Word for a constant about which the tests contain hardly any information.
pub const NO_BETTER: &str = "no better";

/// Names of the constants with their descriptions: a longer one, and one of at most twelve characters. Constants of single rails are not
/// included.
const CONSTANTS: [(&str, [&str; 2]); 14] = [
    ("e_rail", ["bounce of the rails", "rail bounce"]),
    ("mu_rail", ["grip of the rails", "rail grip"]),
    ("rail.height", ["height of the rubber, m", "rail height"]),
    ("rail.kappa", ["how the rubber yields", "rail give"]),
    ("rail.fade.slope", ["loss of fast balls at rails", "fast bounce"]),
    ("mu_s", ["friction of sliding balls", "sliding"]),
    ("mu_r", ["friction of rolling balls", "rolling"]),
    ("c1", ["growth of mu_r with speed", "fast rolling"]),
    ("mu_sp", ["how soon side is lost", "loss of side"]),
    ("tilt.x", ["lean along the table, m/s²", "lean along"]),
    ("tilt.y", ["lean across it, m/s²", "lean across"]),
    ("e_ball", ["bounce of the balls", "ball bounce"]),
    ("mu_b", ["throw between balls", "throw"]),
    ("m_end", ["squirt: mass of the cue's end", "squirt"]),
];

/// Formats a value and its error with as many decimals as give the error two significant digits.
fn round_to_error(value: f64, error: f64) -> [String; 2] {
    let first = error.abs().log10().floor();
    let decimals = if first.is_finite() { (1.0 - first).clamp(0.0, 9.0) as usize } else { 5 };
    [value, error].map(|number| format!("{number:.decimals$}"))
}

impl Change {
    /// Returns a word for how well the constant is known after the trials, if the marks agree.
    fn certainty(&self) -> &'static str {
        match self.after_deviation / self.before_deviation {
            left if left < 0.5 => "well",
            left if left < 0.9 => "better",
            _ => NO_BETTER,
        }
    }

    /// Returns the prior mean and standard deviation as text.
    pub fn before_text(&self) -> [String; 2] {
        round_to_error(self.before, self.before_deviation)
    }

    /// Returns the posterior mean and standard deviation as text.
    pub fn after_text(&self) -> [String; 2] {
        round_to_error(self.after, self.after_deviation)
    }

    /// Describes the constant's meaning at the table, compared with the prior table, which is called `before`. `None` if the tests contain
    /// hardly any information about it, if a player cannot notice it, or if the percentage would be relative to zero: to the prior
    /// value or, for `mu_r`, whose percentage is inverse, to the posterior value.
    fn meaning(&self, before: &str) -> Option<String> {
        let (what, [less, same, more], is_inverse) = match self.name.as_str() {
            // Inverse, because the distance that a ball rolls is inversely proportional to the friction.
            "mu_r" => ("the cloth is", ["slower than", "as fast as", "faster than"], true),
            "e_rail" => ("the rails give back", ["less speed than", "as much speed as", "more speed than"], false),
            "mu_rail" => ("the rails grip", ["less than", "as much as", "more than"], false),
            "mu_sp" => ("side is lost", ["later than", "as soon as", "sooner than"], false),
            _ => return None,
        };
        let known = Some(self.certainty()).filter(|known| *known != NO_BETTER)?;
        let (from, to) = if is_inverse { (self.after, self.before) } else { (self.before, self.after) };
        // There is no percentage of zero.
        if from == 0.0 {
            return None;
        }
        let ratio = to / from;
        let spread = self.after_deviation / from * if is_inverse { ratio } else { 1.0 };
        let (change, error) = (100.0 * (ratio - 1.0), 100.0 * spread.abs());
        let number = |share: f64| if share < 0.95 { format!("{share:.1}") } else { format!("{share:.0}") };
        let end = format!("on {before} (± {} %), known {known}", number(error));
        Some(match change {
            // A change smaller than its error counts as no difference.
            _ if change.abs() < error => format!("{what} {same} {end}"),
            _ => format!("{what} {} % {} {end}", number(change.abs()), if change > 0.0 { more } else { less }),
        })
    }

    /// Describes the constant in at most twelve characters; empty for a constant that no test measures.
    pub fn short_name(&self) -> String {
        match self.rail_constant() {
            Some((rail, own)) => format!("{} {}", rail_names(rail)[1], if own == "e" { "bounce" } else { "grip" }),
            None => self.common_words()[1].to_owned(),
        }
    }

    /// Returns the descriptions in [`CONSTANTS`]; empty if the constant is not among them.
    fn common_words(&self) -> [&'static str; 2] {
        CONSTANTS.iter().find(|(name, _)| *name == self.name).map_or([""; 2], |(_, words)| *words)
    }

    /// Returns the rail and the kind, `e` or `mu`, of a single rail's constant.
    fn rail_constant(&self) -> Option<(Rail, &str)> {
        let own = |rail: &Rail| Some((*rail, self.name.strip_prefix("rail.")?.strip_prefix(rail.name())?));
        let (rail, own) = Rail::ALL.iter().find_map(own)?;
        [".e", ".mu"].contains(&own).then(|| (rail, &own[1..]))
    }

    /// Describes the constant.
    pub fn words(&self) -> String {
        match self.rail_constant() {
            Some((rail, "e")) => format!("bounce of {}", rail_names(rail)[0]),
            Some((rail, _)) => format!("grip of {}", rail_names(rail)[0]),
            None => self.common_words()[0].to_owned(),
        }
    }
}

/// Returns a rail's name for a player who stands at the left end, and the same in one word.
const fn rail_names(rail: Rail) -> [&'static str; 2] {
    match rail {
        Rail::Left => ["your own short rail", "near"],
        Rail::Right => ["the far short rail", "far"],
        Rail::Bottom => ["the right long rail", "right"],
        Rail::Top => ["the left long rail", "left"],
    }
}

impl MarkCheck {
    /// Explains why a mark of the stroke called `stroke` looks misread.
    pub fn misread_text(&self, stroke: &str) -> String {
        let Self { test, mark, marked, expected, rails, .. } = self;
        let unit = Test::named(test)
            .and_then(|test| test.marks.iter().find(|one| one.name == *mark))
            .map_or_else(String::new, |mark| format!(" {}", mark.unit().sign()));
        let after = |rails: usize| format!(" after {rails} {}", if rails == 1 { "rail" } else { "rails" });
        let [after_marked, after_expected] = match rails {
            Some((marked, expected)) if marked != expected => [after(*marked), after(*expected)],
            _ => [String::new(), String::new()],
        };
        let expectation = expected.map_or_else(
            || "no stroke of this test gets there".to_owned(),
            |(value, deviation)| format!("expected {value:.1} ± {deviation:.1}{after_expected}"),
        );
        format!("{stroke} looks misread: you marked {mark} {marked:.1}{unit}{after_marked}, {expectation}")
    }
}

impl OutlierStroke {
    /// Describes the difference of the stroke called `stroke` from the requested one.
    pub fn words(&self, stroke: &str) -> String {
        let Self { what, off, .. } = self;
        format!("{stroke} was far from the requested stroke ({what}: {off:+.1} deviations), or a mark is misread")
    }
}

impl Calibration {
    /// Describes the rails that differ from the others.
    pub fn differing_rails(&self) -> Vec<String> {
        let constant = |name: &str| self.constants.iter().find(|one| one.name == name);
        let differs = |rail: Rail| {
            let part = |own: &str, common: &str, [less, more]: [&str; 2]| {
                let (own, all) = (constant(&format!("rail.{}.{own}", rail.name()))?, constant(common)?);
                let word = if own.after < all.after { less } else { more };
                let ([value, deviation], [others, _]) = (own.after_text(), all.after_text());
                Some(format!("{word} ({value} ± {deviation}, the others {others})"))
            };
            let parts = [
                part("e", "e_rail", ["gives back less", "gives back more"]),
                part("mu", "mu_rail", ["grips less", "grips more"]),
            ];
            let parts: Vec<String> = parts.into_iter().flatten().collect();
            (!parts.is_empty()).then(|| {
                format!("{} ({}) is unlike the others: it {}", rail_names(rail)[0], rail.name(), parts.join(" and "))
            })
        };
        Rail::ALL.into_iter().filter_map(differs).collect()
    }

    /// Returns a word for how well a constant is known after the trials; "unsure" if the marks contradict each other.
    pub fn certainty(&self, change: &Change) -> &'static str {
        if self.is_contradictory() { "unsure" } else { change.certainty() }
    }

    /// Describes the meaning at the table of all constants about which the marks contain information.
    pub fn meanings(&self) -> Vec<String> {
        if self.is_contradictory() {
            return Vec::new();
        }
        self.constants.iter().filter_map(|change| change.meaning(&self.prior_name)).collect()
    }

    /// Describes whether the marks agree; `called` names a stroke by its number and test.
    pub fn agreement(&self, called: impl Fn(usize, &str) -> String) -> String {
        if self.is_contradictory() {
            let mut strokes: Vec<String> =
                self.mark_checks.iter().filter(|one| one.misread).map(|one| called(one.trial, one.test)).collect();
            strokes.dedup();
            if let [only] = &strokes[..] {
                let is_alone = self.mark_checks.iter().all(|one| one.trial == self.mark_checks[0].trial);
                return if is_alone {
                    format!(
                        "most marks of {only} look misread, and no other stroke tells which: play it again, or delete it"
                    )
                } else {
                    format!(
                        "{only} contradicts the others, and too few tell which is right: play more strokes, or delete the wrong one"
                    )
                };
            }
            return format!(
                "so many strokes contradict the others that no value can be relied on: {}; play them again, or delete those that are wrong",
                strokes.join(", ")
            );
        }
        if self.misread().is_empty() {
            return "all marks agree with each other".to_owned();
        }
        let (left_out, counted): (Vec<_>, Vec<_>) =
            self.mark_checks.iter().partition(|one| self.left_out.contains(&one.trial));
        let mut parts = Vec::new();
        if counted.iter().any(|one| !one.misread) {
            parts.push("the other marks agree with each other".to_owned());
        }
        if counted.iter().any(|one| one.misread) {
            parts.push("those above hardly count".to_owned());
        }
        let mut strokes: Vec<String> = left_out.iter().map(|one| called(one.trial, one.test)).collect();
        strokes.dedup();
        let [it_was, it] =
            if strokes.len() > 1 { ["they were other strokes", "them"] } else { ["it was another stroke", "it"] };
        if !strokes.is_empty() {
            let strokes = strokes.join(" and of ");
            parts.push(format!("most marks of {strokes} look misread: {it_was}, and nothing of {it} counts"));
        }
        parts.join("; ")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::table::{Table, TableDoubt};

    #[test]
    fn values_are_rounded_to_their_error() {
        let told = |value, error| round_to_error(value, error).join(" ");
        assert_eq!(told(1.27419, 0.17394), "1.27 0.17");
        assert_eq!(told(0.00493, 0.00039), "0.00493 0.00039");
        assert_eq!(told(0.118, 0.03), "0.118 0.030");
        assert_eq!(told(153.2, 24.7), "153 25");
        assert_eq!(told(0.25, 0.0), "0.25000 0.00000");
    }

    #[test]
    fn constants_are_described_in_a_players_words() {
        let change = |name: &str, after: f64, after_deviation: f64| Change {
            name: name.to_owned(),
            before: 0.005,
            before_deviation: 0.001,
            after,
            after_deviation,
        };
        let told = |name: &str, after: f64, deviation: f64| change(name, after, deviation).meaning("match");
        assert_eq!(told("mu_r", 0.004, 0.0002).unwrap(), "the cloth is 25 % faster than on match (± 6 %), known well");
        assert_eq!(told("mu_r", 0.0051, 0.0008).unwrap(), "the cloth is as fast as on match (± 15 %), known better");
        assert_eq!(
            told("mu_rail", 0.004, 0.0004).unwrap(),
            "the rails grip 20 % less than on match (± 8 %), known well"
        );
        assert_eq!((told("mu_r", 0.005, 0.00095), told("tilt.x", 0.1, 0.0001)), (None, None));
    }

    #[test]
    fn constants_of_zero_are_described_without_percentages_of_zero() {
        let change = |name: &str, before: f64, after: f64| {
            let name = name.to_owned();
            Change { name, before, before_deviation: 0.1, after, after_deviation: 0.02 }.meaning("match")
        };
        assert_eq!((change("mu_rail", 0.0, 0.1), change("mu_r", 0.1, 0.0)), (None, None));
        assert_eq!(
            change("mu_rail", 0.2, 0.0).unwrap(),
            "the rails grip 100 % less than on match (± 10 %), known well"
        );
    }

    #[test]
    fn one_rail_is_singular() {
        let check = MarkCheck {
            trial: 1,
            test: "slow-roll",
            mark: "stop",
            marked: 5.0,
            off: 9.0,
            misread: true,
            expected: Some((6.0, 0.1)),
            rails: Some((1, 0)),
        };
        let said = check.misread_text("slow-roll");
        assert!(said.contains("5.0 diamonds after 1 rail, expected 6.0 ± 0.1 after 0 rails"), "{said}");
    }

    #[test]
    fn every_constant_has_a_description_and_short_name() {
        let doubt = TableDoubt::of(&Table::default());
        let of_rails = Rail::ALL.iter().flat_map(|rail| ["e", "mu"].map(|own| format!("rail.{}.{own}", rail.name())));
        let names = doubt.deviations.into_keys().chain(of_rails);
        let mut told: Vec<String> = names
            .map(|name| {
                let change = Change { name, before: 0.0, before_deviation: 1.0, after: 0.0, after_deviation: 1.0 };
                let (words, short) = (change.words(), change.short_name());
                assert!(!words.is_empty() && (1..=12).contains(&short.len()), "{change:?}: {words}, {short}");
                short
            })
            .collect();
        let count = told.len();
        told.sort();
        told.dedup();
        assert_eq!(told.len(), count, "{told:?}");
    }
}
