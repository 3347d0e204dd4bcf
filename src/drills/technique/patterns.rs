//! The patterns of three-cushion, by the cushions that the cue ball takes.

use super::Technique;
use crate::simulation::Rail;

/// A pattern of three-cushion.
#[derive(Clone, Copy, Debug)]
pub struct Pattern {
    /// The tag that names it.
    pub tag: &'static str,
    /// Its course in words.
    pub course: &'static str,
    pub(super) is_it: fn(&Technique) -> bool,
}

/// Least english that a pattern is named for, R w / v.
const MARKED: f64 = 0.2;

/// The patterns that the library knows.
pub const PATTERNS: [Pattern; 13] = [
    Pattern {
        tag: "natural",
        course: "yellow, a long cushion, a short one, the other long one, red",
        is_it: |t| t.before.is_empty() && course(t) == "lsL" && t.english > -MARKED,
    },
    Pattern {
        tag: "around-the-table",
        course: "yellow, four cushions or more, each the next one round the table, red",
        is_it: |t| t.before.is_empty() && matches!(course(t).as_str(), "lsLS" | "slSL" | "lsLSl" | "slSLs"),
    },
    Pattern {
        tag: "short-angle",
        course: "yellow, a short cushion, a long one, the other short one, red",
        is_it: |t| t.before.is_empty() && course(t) == "slS",
    },
    Pattern {
        tag: "across",
        course: "yellow, three times across between the long cushions, red",
        is_it: |t| t.before.is_empty() && course(t) == "lLl",
    },
    Pattern {
        tag: "up-and-down",
        course: "yellow, three times along between the short cushions, red",
        is_it: |t| t.before.is_empty() && course(t) == "sSs",
    },
    Pattern {
        tag: "plus",
        course: "yellow, a short cushion, a long one, the other long one, red, with running english",
        is_it: |t| t.before.is_empty() && course(t) == "slL" && t.english > MARKED,
    },
    Pattern {
        tag: "reverse",
        course: "yellow, three cushions, red, with reverse english",
        is_it: |t| t.before.is_empty() && t.between.len() == 3 && t.english < -MARKED,
    },
    Pattern {
        tag: "double-the-rail",
        course: "yellow, a cushion, the one beside it, the first one again, red, with reverse english",
        is_it: |t| t.before.is_empty() && matches!(course(t).as_str(), "lsl" | "sls") && t.english < -MARKED,
    },
    Pattern {
        tag: "rail-first",
        course: "a cushion, yellow, two other cushions or more, red",
        is_it: |t| t.before.len() == 1 && t.between.first() != t.before.first(),
    },
    Pattern {
        tag: "ticky",
        course: "a cushion, yellow, the same cushion again, another or more, red",
        is_it: |t| t.before.len() == 1 && t.between.first() == t.before.first(),
    },
    Pattern {
        tag: "umbrella",
        course: "two cushions, yellow, a third one or more, red",
        is_it: |t| t.before.len() == 2 && !t.between.is_empty(),
    },
    Pattern {
        tag: "bank",
        course: "three cushions, yellow, red",
        is_it: |t| t.before.len() == 3 && t.between.is_empty(),
    },
    Pattern { tag: "time", course: "yellow sends red to where the cue ball comes", is_it: |t| t.drives_second },
];

/// The cushions between the balls: `l` and `s` for the long and the short one that is met first, `L` and `S` for those
/// opposite.
fn course(technique: &Technique) -> String {
    let (mut long, mut short) = (None, None);
    let letter = |rail: &Rail| match rail {
        Rail::Top | Rail::Bottom if *long.get_or_insert(*rail) == *rail => 'l',
        Rail::Top | Rail::Bottom => 'L',
        Rail::Left | Rail::Right if *short.get_or_insert(*rail) == *rail => 's',
        Rail::Left | Rail::Right => 'S',
    };
    technique.between.iter().map(letter).collect()
}
