//! What a calibration has found, in a player's words.

use super::{
    calibrate::{Calibration, Change, Strange, Verdict},
    protocol::Test,
};
use crate::table::Rail;

impl Change {
    /// In a word, how much the marks have told.
    pub fn known(&self) -> &'static str {
        match self.after_deviation / self.before_deviation {
            left if left < 0.5 => "well",
            left if left < 0.9 => "better",
            _ => "as before",
        }
    }

    /// What the constant is.
    pub fn words(&self) -> String {
        let own = |rail: &Rail| Some((*rail, self.name.strip_prefix("rail.")?.strip_prefix(rail.name())?));
        match Rail::ALL.iter().find_map(own) {
            Some((rail, ".e")) => return format!("what {} gives back", whose(rail)),
            Some((rail, ".mu")) => return format!("grip of {}", whose(rail)),
            _ => {}
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

    /// Whether the marks agree.
    pub fn agreement(&self) -> &'static str {
        if self.is_contradictory() {
            "so many tests look misread that they contradict each other: look at the largest first, or play them again"
        } else if self.misread().is_empty() {
            "all marks agree with each other"
        } else {
            "the other marks agree with each other; those above hardly count"
        }
    }
}
