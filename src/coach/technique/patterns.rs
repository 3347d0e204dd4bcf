//! The players' names of shots, by what the cue ball does. Every shot that hits both object balls has one.

use std::f64::consts::FRAC_PI_3;

use super::Technique;
use crate::{
    coach::aim::{FULL, THICK, THIN},
    simulation::Rail,
};

/// A kind of shot that players have a name for.
#[derive(Clone, Copy, Debug)]
pub struct Pattern {
    /// The tag of the exercises that train it. Some patterns share one.
    pub tag: &'static str,
    /// The name in a sentence.
    pub name: &'static str,
    /// The course of the cue ball in words.
    pub course: &'static str,
    is_it: fn(&Technique) -> bool,
}

/// Minimum english for a pattern that is named after it, R w / v.
const MARKED: f64 = 0.2;

/// Minimum bend of the path before the first contact that makes a massé, rad: 15°. Side spin with a cue as level as the
/// rails allow bends it by a degree or two.
pub(super) const BENT: f64 = 0.26;

/// Spin below which the cue ball draws, in units of a rolling ball's.
const DRAWN: f64 = -0.15;

/// Spin from which on it follows. Between [`DRAWN`] and this it slides: a stun shot.
const ROLLING: f64 = 0.35;

/// The named patterns, in the order of the checks: the first match gives the name.
pub const PATTERNS: [Pattern; 31] = [
    Pattern {
        tag: "jump",
        name: "jump",
        course: "the cue ball flies over a ball, or its edge, before it meets anything",
        is_it: |t| t.over.is_some(),
    },
    Pattern {
        tag: "masse",
        name: "massé",
        course: "the cue is raised and the cue ball runs in a curve before it meets anything",
        is_it: |t| t.bend > BENT,
    },
    Pattern {
        tag: "time",
        name: "time shot",
        course: "the first ball sends the second to where the cue ball comes",
        is_it: |t| t.drives_second,
    },
    Pattern {
        tag: "bank",
        name: "three-cushion bank",
        course: "three cushions or more, then both balls",
        is_it: |t| t.before.len() >= 3,
    },
    Pattern {
        tag: "ticky",
        name: "ticky",
        course: "a cushion, a ball close to it, the same cushion again, and on to the other ball",
        is_it: |t| {
            let last = t.before.last().map(|cushion| cushion.rail);
            t.is_close && last == t.between.first().map(|cushion| cushion.rail)
        },
    },
    Pattern {
        tag: "umbrella",
        name: "umbrella",
        course: "two cushions, a ball, a third cushion or more, the other ball",
        is_it: |t| t.before.len() == 2 && !t.between.is_empty(),
    },
    Pattern {
        tag: "rail-first",
        name: "rail first",
        course: "a cushion, a ball, two cushions or more, the other ball",
        is_it: |t| t.before.len() == 1 && t.between.len() >= 2,
    },
    Pattern {
        tag: "cushion-first",
        name: "cushion first",
        course: "one or two cushions, then the balls, with fewer than three cushions in all",
        is_it: |t| !t.before.is_empty(),
    },
    Pattern {
        tag: "double-the-rail",
        name: "double the rail",
        course: "a ball, a cushion, the one beside it, the first one again, the other ball, with reverse english",
        is_it: |t| matches!(start(t).as_str(), "lsl" | "sls"),
    },
    Pattern {
        tag: "around-the-table",
        name: "around the table",
        course: "a ball, four cushions or more, each the next one round the table, the other ball",
        is_it: |t| matches!(course(t).get(..4), Some("lsLS" | "slSL")),
    },
    Pattern {
        tag: "across",
        name: "cross table",
        course: "a ball, three times across between the long cushions, the other ball",
        is_it: |t| start(t) == "lLl",
    },
    Pattern {
        tag: "up-and-down",
        name: "up and down",
        course: "a ball, three times along between the short cushions, the other ball",
        is_it: |t| start(t) == "sSs",
    },
    Pattern {
        tag: "back-up",
        name: "back-up",
        course: "a ball, two cushions that face each other, and with reverse english back to the one that lies behind",
        is_it: |t| matches!(start(t).as_str(), "lLs" | "sSl") && t.english < -MARKED && turns_back(t),
    },
    Pattern {
        tag: "reverse",
        name: "reverse english",
        course: "a ball, three cushions, the other ball, with reverse english",
        is_it: |t| t.between.len() >= 3 && t.english < -MARKED,
    },
    Pattern {
        tag: "natural",
        name: "natural",
        course: "a ball, a long cushion, a short one, the other long one, the other ball",
        is_it: |t| start(t) == "lsL",
    },
    Pattern {
        tag: "short-angle",
        name: "short angle",
        course: "a ball, a short cushion, a long one, the other short one, the other ball",
        is_it: |t| start(t) == "slS",
    },
    Pattern {
        tag: "plus",
        name: "plus",
        course: "a ball, a short cushion, a long one, the other long one, the other ball",
        is_it: |t| start(t) == "slL",
    },
    Pattern {
        tag: "zigzag",
        name: "zigzag",
        course: "a ball, two cushions that face each other, one beside them, the other ball",
        is_it: |t| matches!(start(t).as_str(), "lLs" | "sSl"),
    },
    Pattern {
        tag: "end-to-end",
        name: "end to end",
        course: "a ball, a long cushion, a short one, the other short one, the other ball",
        is_it: |t| start(t) == "lsS",
    },
    Pattern {
        tag: "same-rail-twice",
        name: "same rail twice",
        course: "a ball, and three cushions, of which the cue ball meets one twice in a row",
        is_it: |t| t.between.len() >= 3,
    },
    Pattern {
        tag: "draw",
        name: "draw",
        course: "a ball, from which the cue ball turns back",
        is_it: |t| t.roll < DRAWN && t.deflection > FRAC_PI_3,
    },
    Pattern {
        tag: "follow",
        name: "follow",
        course: "a ball hit full, after which the cue ball goes on ahead",
        is_it: |t| t.roll > ROLLING && t.fullness() >= FULL,
    },
    Pattern {
        tag: "two-cushions",
        name: "two cushions across",
        course: "a ball, two cushions that face each other, the other ball",
        is_it: |t| matches!(course(t).as_str(), "lL" | "sS"),
    },
    Pattern {
        tag: "two-cushions",
        name: "two cushions",
        course: "a ball, two cushions, the other ball",
        is_it: |t| t.between.len() == 2,
    },
    Pattern {
        tag: "running",
        name: "one cushion, running",
        course: "a ball, a cushion with running english, the other ball",
        is_it: |t| t.between.len() == 1 && t.english > MARKED,
    },
    Pattern {
        tag: "reverse",
        name: "one cushion, reverse",
        course: "a ball, a cushion with reverse english, the other ball",
        is_it: |t| t.between.len() == 1 && t.english < -MARKED,
    },
    Pattern {
        tag: "natural",
        name: "one-cushion natural",
        course: "a ball, a cushion with little english or none, the other ball",
        is_it: |t| t.between.len() == 1,
    },
    Pattern {
        tag: "stun",
        name: "stun",
        course: "ball to ball, the cue ball sliding as it meets the first",
        is_it: |t| t.roll < ROLLING && t.fullness() >= 0.25,
    },
    Pattern {
        tag: "thin",
        name: "thin carom",
        course: "ball to ball, the first hit thin",
        is_it: |t| t.fullness() < THIN,
    },
    Pattern {
        tag: "half-ball",
        name: "half-ball carom",
        course: "ball to ball, the first hit about half",
        is_it: |t| t.fullness() < THICK,
    },
    Pattern { tag: "thick", name: "thick carom", course: "ball to ball, the first hit thick", is_it: |_| true },
];

impl Pattern {
    /// Finds the pattern of a shot; `None` if it does not hit both balls.
    pub fn of(technique: &Technique) -> Option<&'static Self> {
        PATTERNS.iter().find(|pattern| technique.tally.has_hit_both() && (pattern.is_it)(technique))
    }

    /// Describes the course for this shot. Adds the number of cushions if the pattern only defines the first three and
    /// there are more.
    pub fn course_of(&self, technique: &Technique) -> String {
        let says_all =
            !technique.before.is_empty() || ["jump", "masse", "time", "around-the-table"].contains(&self.tag);
        match technique.between.len() {
            many @ 1.. if ["draw", "follow"].contains(&self.tag) => {
                format!("{}; here by {many} cushion{}", self.course, if many == 1 { "" } else { "s" })
            }
            many if many > 3 && !says_all => format!("{}; here {many} cushions in all", self.course),
            _ => self.course.to_owned(),
        }
    }
}

/// Returns the cushions between the balls as letters: `l` and `s` for the first long and the first short cushion, `L` and `S`
/// for those opposite.
fn course(technique: &Technique) -> String {
    let (mut long, mut short) = (None, None);
    let letter = |rail: Rail| match rail {
        Rail::Top | Rail::Bottom if *long.get_or_insert(rail) == rail => 'l',
        Rail::Top | Rail::Bottom => 'L',
        Rail::Left | Rail::Right if *short.get_or_insert(rail) == rail => 's',
        Rail::Left | Rail::Right => 'S',
    };
    let all: String = technique.between.iter().map(|cushion| cushion.rail).map(letter).collect();
    if technique.before.is_empty() { all } else { String::new() }
}

/// Returns the first three letters of [`course`].
fn start(technique: &Technique) -> String {
    course(technique).chars().take(3).collect()
}

/// Whether the third cushion lies behind the cue ball as it approaches the first.
fn turns_back(technique: &Technique) -> bool {
    let [first, _, third, ..] = &technique.between[..] else { return false };
    let ahead = match third.rail {
        Rail::Right | Rail::Top => 1.0,
        Rail::Left | Rail::Bottom => -1.0,
    };
    ahead * first.along < 0.0
}
