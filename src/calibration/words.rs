//! What a calibration has found, in a player's words.

use super::{
    calibrate::{Calibration, Change, Strange, Verdict},
    protocol::Test,
};
use crate::table::Rail;

impl Change {
    /// In a word, how much the marks have told, if they agree.
    fn known(&self) -> &'static str {
        match self.after_deviation / self.before_deviation {
            left if left < 0.5 => "well",
            left if left < 0.9 => "better",
            _ => "as before",
        }
    }

    /// What the constant is, in twelve characters at most; nothing of one that no test measures.
    pub fn short_words(&self) -> String {
        let words = match (self.of_a_rail(), self.name.as_str()) {
            (Some((rail, own)), _) => return format!("{} {}", side(rail), if own == "e" { "bounce" } else { "grip" }),
            (None, "e_rail") => "rail bounce",
            (None, "mu_rail") => "rail grip",
            (None, "rail.height") => "rail height",
            (None, "rail.kappa") => "rail give",
            (None, "rail.fade.slope") => "fast bounce",
            (None, "mu_s") => "sliding",
            (None, "mu_r") => "rolling",
            (None, "c1") => "fast rolling",
            (None, "mu_sp") => "loss of side",
            (None, "tilt.x") => "lean along",
            (None, "tilt.y") => "lean across",
            (None, "e_ball") => "ball bounce",
            (None, "mu_b") => "throw",
            (None, "m_end") => "squirt",
            (None, _) => "",
        };
        words.to_owned()
    }

    /// The rail whose own constant it is, and which of the two: `e` or `mu`.
    fn of_a_rail(&self) -> Option<(Rail, &str)> {
        let own = |rail: &Rail| Some((*rail, self.name.strip_prefix("rail.")?.strip_prefix(rail.name())?));
        let (rail, own) = Rail::ALL.iter().find_map(own)?;
        [".e", ".mu"].contains(&own).then(|| (rail, &own[1..]))
    }

    /// What the constant is.
    pub fn words(&self) -> String {
        match self.of_a_rail() {
            Some((rail, "e")) => return format!("what {} gives back", whose(rail)),
            Some((rail, _)) => return format!("grip of {}", whose(rail)),
            None => {}
        }
        let words = match self.name.as_str() {
            "e_rail" => "what rails give back",
            "mu_rail" => "grip of the rails",
            "rail.height" => "height of the rubber, m",
            "rail.kappa" => "how the rubber yields",
            "rail.fade.slope" => "loss of fast balls at rails",
            "mu_s" => "friction of sliding balls",
            "mu_r" => "friction of rolling balls",
            "c1" => "growth of mu_r with speed",
            "mu_sp" => "how soon side is lost",
            "tilt.x" => "lean along the table, m/s²",
            "tilt.y" => "lean across it, m/s²",
            "e_ball" => "what balls give back",
            "mu_b" => "throw between balls",
            "m_end" => "squirt: mass of the cue's end",
            _ => "",
        };
        words.to_owned()
    }
}

/// Which rail it is for a player who stands on the left.
const fn whose(rail: Rail) -> &'static str {
    match rail {
        Rail::Left => "your own short rail",
        Rail::Right => "the far short rail",
        Rail::Bottom => "the right long rail",
        Rail::Top => "the left long rail",
    }
}

/// The same in a word.
const fn side(rail: Rail) -> &'static str {
    match rail {
        Rail::Left => "near",
        Rail::Right => "far",
        Rail::Bottom => "right",
        Rail::Top => "left",
    }
}

impl Verdict {
    /// What speaks against a mark that looks misread, of a stroke that is called this.
    pub fn doubtful(&self, stroke: &str) -> String {
        let Self { test, mark, marked, expected, rails, .. } = self;
        let unit = Test::named(test)
            .and_then(|test| test.marks.iter().find(|one| one.name == *mark))
            .map_or_else(String::new, |mark| format!(" {}", mark.unit().sign()));
        let after = |rails: usize| format!(" after {rails} rails");
        let [met, wanted] = match rails {
            Some((met, wanted)) if met != wanted => [after(*met), after(*wanted)],
            _ => [String::new(), String::new()],
        };
        let but = expected.map_or_else(
            || "no stroke of this test comes there".to_owned(),
            |(value, deviation)| format!("expected {value:.1} ± {deviation:.1}{wanted}"),
        );
        format!("{stroke} looks misread: you marked {mark} {marked:.1}{unit}{met}, {but}")
    }
}

impl Strange {
    /// How a stroke that is called this was different.
    pub fn words(&self, stroke: &str) -> String {
        let Self { what, off, .. } = self;
        format!("{stroke} was struck far from what is asked for ({what}: {off:+.1} deviations), or a mark is misread")
    }
}

impl Calibration {
    /// The rails that differ from the others, each with how.
    pub fn rails_apart(&self) -> Vec<String> {
        let constant = |name: &str| self.constants.iter().find(|one| one.name == name);
        let differs = |rail: Rail| {
            let part = |own: &str, common: &str, [less, more]: [&str; 2]| {
                let (own, all) = (constant(&format!("rail.{}.{own}", rail.name()))?, constant(common)?);
                let word = if own.after < all.after { less } else { more };
                Some(format!("{word} ({:.3} ± {:.3}, the others {:.3})", own.after, own.after_deviation, all.after))
            };
            let parts = [
                part("e", "e_rail", ["gives back less", "gives back more"]),
                part("mu", "mu_rail", ["grips less", "grips more"]),
            ];
            let parts: Vec<String> = parts.into_iter().flatten().collect();
            (!parts.is_empty())
                .then(|| format!("{} ({}) is unlike the others: it {}", whose(rail), rail.name(), parts.join(" and ")))
        };
        Rail::ALL.into_iter().filter_map(differs).collect()
    }

    /// In a word, how much the marks have told of a constant: nothing that one could rely on where they contradict each other.
    pub fn known(&self, change: &Change) -> &'static str {
        if self.is_contradictory() { "unsure" } else { change.known() }
    }

    /// Whether the marks agree, of strokes that `called` has names for.
    pub fn agreement(&self, called: impl Fn(usize, &str) -> String) -> String {
        if self.is_contradictory() {
            let mut strokes: Vec<String> =
                self.verdicts.iter().filter(|one| one.misread).map(|one| called(one.trial, one.test)).collect();
            strokes.dedup();
            return format!(
                "so many strokes contradict the others that no value can be relied on: {}; play them again, or take out those that are wrong",
                strokes.join(", ")
            );
        }
        let words = if self.misread().is_empty() {
            "all marks agree with each other"
        } else {
            "the other marks agree with each other; those above hardly count"
        };
        let left_out = self.verdicts.iter().filter(|one| self.left_out.contains(&one.trial));
        let mut strokes: Vec<String> = left_out.map(|one| called(one.trial, one.test)).collect();
        strokes.dedup();
        match &strokes[..] {
            [] => words.to_owned(),
            strokes => {
                format!("{words}; most marks of {} are wrong, so nothing of it counts", strokes.join(" and of "))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::table::{Table, TableDoubt};

    #[test]
    fn every_constant_has_words_and_short_ones_of_its_own() {
        let doubt = TableDoubt::of(&Table::default());
        let of_rails = Rail::ALL.iter().flat_map(|rail| ["e", "mu"].map(|own| format!("rail.{}.{own}", rail.name())));
        let names = doubt.deviations.into_keys().chain(of_rails);
        let mut told: Vec<String> = names
            .map(|name| {
                let change = Change { name, before: 0.0, before_deviation: 1.0, after: 0.0, after_deviation: 1.0 };
                let (words, short) = (change.words(), change.short_words());
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
