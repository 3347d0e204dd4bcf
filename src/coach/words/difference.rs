//! The difference between two strokes, as a player would describe it.

use super::{Hit, ShotWords, TIP, TipUnit, Units, format_trimmed, lengths_words, numbers};
use crate::table::CueBall;

/// Differences of fullness, as shares of a ball: below the first they are not reported, below the second they are "a
/// hair", and below the third "a little". Larger ones are reported in eighths.
const NEGLIGIBLE: f64 = 0.008;
const HAIR: f64 = 1.0 / 32.0;
const LITTLE: f64 = 3.0 / 32.0;
const EIGHTHS: [&str; 9] = [
    "",
    "an eighth",
    "a quarter",
    "three eighths",
    "half a ball",
    "five eighths",
    "three quarters",
    "seven eighths",
    "a whole ball",
];

/// Minimum differences that are reported: of the tip position in tips, of the table lengths, and of the elevation and
/// the aim in degrees.
const TIPS: f64 = 0.02;
const LENGTHS: f64 = 0.05;
const ELEVATION: f64 = 0.5;
const AIM: f64 = 0.005;

impl ShotWords {
    /// Describes how this shot differs from `other`, one part per difference; empty if nobody could notice a
    /// difference. If it `misses` and the other does not, its thickness is described as a fault.
    pub fn differences(&self, other: &Self, misses: bool, cue_ball: CueBall, units: Units) -> Vec<String> {
        let contact = self.contact_difference(other, misses, cue_ball);
        let mut parts: Vec<String> = contact.or_else(|| self.aim_difference(other)).into_iter().collect();
        let tip = |by: f64| tip_amount(by, self.radius, units.tip);
        parts.extend(
            tip(self.tips_right - other.tips_right).map(|amount| {
                format!("{amount} {}", side_change(other.tips_right, self.tips_right, ["right", "left"]))
            }),
        );
        parts.extend(
            tip(self.tips_above - other.tips_above).map(|amount| {
                format!("{amount} {}", if self.tips_above > other.tips_above { "higher" } else { "lower" })
            }),
        );
        let harder = self.table_lengths - other.table_lengths;
        if harder.abs() >= LENGTHS {
            let lengths = lengths_words(harder.abs());
            parts.push(format!("{} by {lengths}", if harder > 0.0 { "harder" } else { "softer" }));
        }
        let raised = self.elevation_deg - other.elevation_deg;
        if raised.abs() >= ELEVATION {
            parts.push(format!("cue {:.0}\u{b0} {}", raised.abs(), if raised > 0.0 { "higher" } else { "lower" }));
        }
        parts
    }

    /// Describes the difference in the first contact, or in the fullness of the same contact.
    fn contact_difference(&self, other: &Self, misses: bool, cue_ball: CueBall) -> Option<String> {
        let names = cue_ball.names();
        let (Some(hit), Some(others)) = (self.first, other.first) else {
            let met = self.first.map(|hit| format!("hits {}", names[hit.ball]));
            return met.or_else(|| other.first.map(|_| "hits no ball".to_owned()));
        };
        if self.before.is_empty() != other.before.is_empty() {
            let straight = || format!("straight at {}, no cushion first", names[hit.ball]);
            return Some(if self.before.is_empty() { straight() } else { "a cushion first".to_owned() });
        }
        if hit.ball != others.ball {
            return Some(format!("hits {} first", names[hit.ball]));
        }
        // A full hit has no side.
        let has_side = |hit: Hit| !numbers::fullness_words(hit.fullness).1;
        if hit.left != others.left && has_side(hit) && has_side(others) {
            return Some(format!("{} on its {} side", names[hit.ball], if hit.left { "left" } else { "right" }));
        }
        let fuller = hit.fullness - others.fullness;
        let words = if fuller > 0.0 { ["thicker", "too thick"] } else { ["thinner", "too thin"] };
        match fuller.abs() {
            by if by < NEGLIGIBLE => None,
            by if by < LITTLE => {
                let little = if by < HAIR { "a hair" } else { "a little" };
                Some(format!("{little} {}", words[usize::from(misses)]))
            }
            by => {
                let amount = EIGHTHS[((8.0 * by).round() as usize).clamp(1, 8)];
                Some(if misses { format!("{} by {amount}", words[1]) } else { format!("{amount} {}", words[0]) })
            }
        }
    }

    /// Describes how much further to one side the cue is aimed.
    fn aim_difference(&self, other: &Self) -> Option<String> {
        let degrees = other.direction.angle_to(self.direction).to_degrees();
        (degrees.abs() >= AIM).then(|| {
            let side = if degrees > 0.0 { "left" } else { "right" };
            format!("aimed {}\u{b0} further {side}", format_trimmed(degrees.abs(), 2))
        })
    }
}

/// Describes the size of a change of the tip position along one axis.
fn tip_amount(tips: f64, radius: f64, unit: TipUnit) -> Option<String> {
    if tips.abs() < TIPS {
        return None;
    }
    Some(match unit {
        TipUnit::Mm => format!("{} mm", format_trimmed(1e3 * radius * TIP * tips.abs(), 1)),
        TipUnit::Tips => match (4.0 * tips.abs()).round() as u32 {
            0 => "a touch".to_owned(),
            1 => "a quarter tip".to_owned(),
            2 => "half a tip".to_owned(),
            3 => "three quarters of a tip".to_owned(),
            4 => "one tip".to_owned(),
            quarters => format!("{} tips", format_trimmed(0.25 * f64::from(quarters), 2)),
        },
    })
}

/// Describes the direction of a change of side from one value to another; positive values are side of the first of the
/// two names. It is more of one side, or less of the other.
fn side_change(from: f64, to: f64, [more, less]: [&str; 2]) -> String {
    let (towards, away) = if to > from { (more, less) } else { (less, more) };
    // A reduction that does not cross to the other side is less of the old side.
    let is_less = from.abs() > TIPS && (to * from > 0.0 || to.abs() < TIPS) && to.abs() < from.abs();
    if is_less { format!("less {away}") } else { format!("more {towards}") }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        physics::CueInputs,
        table::{Layout, Table},
    };

    /// Red lies half a ball beside the path along x.
    const HALF: &str = "-0.7,0 0.9,0.5 0,-0.03075";

    fn of(cue: &str) -> ShotWords {
        let table = Table::preset("textbook").unwrap();
        let layout = Layout::parse(HALF, &table).unwrap();
        ShotWords::of(&table, &layout, &CueInputs::parse(cue).unwrap()).unwrap()
    }

    fn told(yours: &str, misses: bool) -> String {
        of(yours).differences(&of("-0.2,0.1,0,0,3"), misses, CueBall::White, Units::default()).join(", ")
    }

    #[test]
    fn imperceptible_difference_is_not_described() {
        assert_eq!(told("-0.2,0.1,0,0,3", true), "");
        assert_eq!(told("-0.2004,0.1,0,0.001,3.001", false), "");
    }

    #[test]
    fn each_input_difference_has_its_words() {
        assert_eq!(told("-0.225,0.1,0,0,3", false), "a quarter tip more right");
        assert_eq!(told("-0.15,0.1,0,0,3", false), "half a tip less right");
        assert_eq!(told("0.1,0.1,0,0,3", false), "3 tips more left");
        assert_eq!(told("-0.2,0,0,0,3", false), "one tip lower");
        let harder = told("-0.2,0.1,0,0,3.4", false);
        assert!(harder.starts_with("harder by 0.") && harder.ends_with(" lengths"), "{harder}");
        assert!(told("-0.2,0.1,6,0,3", false).ends_with("cue 6\u{b0} higher"));
        let mm = Units { tip: TipUnit::Mm, ..Units::default() };
        let other = of("-0.2,0.1,0,0,3");
        assert_eq!(of("-0.3,0.1,0,0,3").differences(&other, false, CueBall::White, mm), ["3.1 mm more right"]);
    }

    #[test]
    fn thickness_differs_in_eighths_and_misses_are_faults() {
        // A degree at 0.7 m is 12 mm, a fifth of a ball.
        assert_eq!(told("-0.2,0.1,0,-0.6,3", false), "an eighth thicker");
        assert_eq!(told("-0.2,0.1,0,-0.6,3", true), "too thick by an eighth");
        assert_eq!(told("-0.2,0.1,0,0.6,3", true), "too thin by an eighth");
        assert_eq!(told("-0.2,0.1,0,0.3,3", false), "a little thinner");
        assert_eq!(told("-0.2,0.1,0,0.1,3", true), "a hair too thin");
    }

    #[test]
    fn different_or_missing_first_contact_is_named() {
        assert_eq!(told("-0.2,0.1,0,-4.5,3", true), "red on its right side");
        let full = of("-0.2,0.1,0,-2.4,3");
        assert!(full.first.is_some_and(|hit| hit.fullness > 0.97), "{:?}", full.first);
        assert!(told("-0.2,0.1,0,-2.4,3", true).starts_with("too thick by "), "{}", told("-0.2,0.1,0,-2.4,3", true));
        assert_eq!(told("-0.2,0.1,0,17.4,3", true), "hits yellow first");
        assert_eq!(told("-0.2,0.1,0,10,0.3", true).split(", ").next(), Some("hits no ball"));
    }
}
