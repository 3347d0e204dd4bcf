//! What a shot does on the table, and whether that is what its exercise teaches.

use std::f64::consts::FRAC_PI_3;

use super::{Category, Exercise, ExerciseError};
use crate::{
    coach::first_hit,
    game::{Tally, scores},
    physics::CueInputs,
    simulation::{EventKind, Rail, Recording},
    table::{Layout, Table},
};

/// Balls are gathered where no two are further apart, m: a little less than two diamonds of a `match` table.
pub const GATHERED: f64 = 0.6;

/// What the cue ball does in a shot.
#[derive(Clone, Debug, PartialEq)]
pub struct Technique {
    /// What the rules look at.
    pub tally: Tally,
    /// The object ball that is met first.
    pub first: Option<usize>,
    /// Cushions before it, in order.
    pub before: Vec<Rail>,
    /// Cushions between the first and the second object ball, in order.
    pub between: Vec<Rail>,
    /// Cushions that ball 1 meets in the whole shot, in order.
    pub sent: Vec<Rail>,
    /// How much of the first ball is covered as the cue ball comes on: 1 is head-on, 0 a graze.
    pub fullness: f64,
    /// Angle between the cue ball's way to the first ball and its way from there, once it rolls or meets something, rad.
    pub turn: f64,
    /// Side spin at the first cushion in units of a rolling ball's spin, R w / v: positive where it is running (the rebound is
    /// longer for it), negative where it is reverse, 0 without a cushion before the second ball.
    pub english: f64,
    /// Whether the first ball touches the second before the cue ball is there.
    pub drives_second: bool,
    /// Whether the cue ball meets the first ball once only before the second.
    pub is_clean: bool,
    /// Largest distance of two balls at the end, m.
    pub spread: f64,
}

impl Technique {
    /// What the cue ball does in this shot.
    ///
    /// # Errors
    /// What is wrong with the layout or the stroke.
    pub fn of(table: &Table, layout: &Layout, cue: &CueInputs) -> Result<Self, crate::simulation::ShotError> {
        let recording = Recording::new(table, layout, cue)?;
        let mut technique = Self {
            tally: Tally::default(),
            first: None,
            before: Vec::new(),
            between: Vec::new(),
            sent: recording
                .events()
                .iter()
                .filter_map(|event| event.kind.rail().filter(|_| event.kind.balls().0 == 1))
                .collect(),
            fullness: first_hit(table, &recording).map_or(0.0, |hit| hit.fullness),
            turn: 0.0,
            english: 0.0,
            drives_second: false,
            is_clean: true,
            spread: spread(&recording.final_layout()),
        };
        technique.follow(table, &recording);
        Ok(technique)
    }

    /// Follows the cue ball up to the second object ball.
    fn follow(&mut self, table: &Table, recording: &Recording) {
        let mut incoming = None;
        for event in recording.events() {
            self.tally.note(event);
            // At its own time an event has already changed the course.
            let before = recording.state(0, event.time - 1e-9);
            if let (Some(way), true) = (incoming, event.kind.balls().0 == 0) {
                self.turn = before.velocity.angle_to(way).abs();
                incoming = None;
            }
            match event.kind {
                EventKind::BallBall(1, 2) => self.drives_second = true,
                EventKind::BallBall(0, ball) if self.first.is_none() => {
                    self.first = Some(ball);
                    incoming = Some(before.velocity);
                }
                EventKind::BallBall(0, ball) if self.first == Some(ball) => self.is_clean = false,
                EventKind::BallRail(0, rail) => {
                    if self.before.is_empty() && self.between.is_empty() {
                        // A ball that rolls along the cushion as on a track has an english of 1.
                        let along = before.velocity.dot(rail.normal().perp());
                        self.english = table.radius * before.spin.z * along.signum() / before.velocity.length();
                    }
                    if self.first.is_none() { &mut self.before } else { &mut self.between }.push(rail);
                }
                _ => {}
            }
            if self.tally.met_both() {
                break;
            }
        }
    }
}

/// Largest distance of two balls, m.
fn spread(layout: &Layout) -> f64 {
    let [a, b, c] = layout.balls;
    a.distance(b).max(a.distance(c)).max(b.distance(c))
}

/// What the shot of an exercise fails to show of what is taught, as sentences; none where all is well. An own exercise and
/// one without a shot promise nothing.
///
/// Every bundled shot meets ball 1 first, once, and makes the point by its rule; the rest depends on the category, and in
/// three-cushion on the pattern that the first tag names.
///
/// # Errors
/// Where the exercise cannot be played.
pub fn flaws(exercise: &Exercise) -> Result<Vec<&'static str>, ExerciseError> {
    exercise.validate()?;
    let table = exercise.table()?;
    let Some(cue) = exercise.shot.filter(|_| exercise.category != Category::Own) else { return Ok(Vec::new()) };
    let layout = &exercise.layout;
    let technique = match Technique::of(&table, layout, &cue) {
        Ok(technique) => technique,
        // The layout and the stroke have been found possible.
        Err(_) => return Ok(vec!["it can be played"]),
    };
    let misses = |changed: CueInputs| !scores(exercise.rule, &table, layout, &changed);
    let is_tagged = |tag: &str| exercise.tags.iter().any(|other| other == tag);
    let between = technique.between.len();
    let mut checks = vec![
        ("it makes the point by its rule", technique.tally.is_point(exercise.rule)),
        ("it meets ball 1 first", technique.first == Some(1)),
        ("it meets ball 1 only once before ball 2", technique.is_clean),
        ("it covers at least a twentieth of ball 1", technique.fullness >= 0.05),
        ("ball 1 stays away from ball 2 but in a time shot", technique.drives_second == is_tagged("time")),
    ];
    checks.extend(match exercise.category {
        Category::FirstCaroms => vec![
            ("it goes from ball to ball", technique.tally.cushions_before_second == 0),
            ("it has no side", cue.a == 0.0),
        ],
        Category::Draw => vec![
            ("the tip is more than 0.2 R below the centre", cue.b < -0.2),
            ("the cue ball turns by more than 60 degrees", technique.turn > FRAC_PI_3),
            ("with the tag back it turns by more than 90", !is_tagged("back") || technique.turn > 1.5 * FRAC_PI_3),
            ("struck in the middle it misses", misses(CueInputs { b: 0.0, ..cue })),
        ],
        Category::Follow => vec![
            ("the tip is more than 0.2 R above the centre", cue.b > 0.2),
            ("ball 1 is hit at least seven tenths full", technique.fullness >= 0.7),
            ("the cue ball turns by less than 40 degrees", technique.turn < 2.0 / 3.0 * FRAC_PI_3),
        ],
        Category::Side => vec![
            ("the tip is more than 0.25 R off to the side", cue.a.abs() > 0.25),
            ("without side it misses", misses(CueInputs { a: 0.0, ..cue })),
        ],
        Category::OneCushion => vec![("the rule is one-cushion", exercise.rule.cushions() == 1)],
        Category::Gather => vec![
            ("the object balls are more than 0.6 m apart before", layout.balls[1].distance(layout.balls[2]) > GATHERED),
            ("ball 1 comes back from a cushion", !technique.sent.is_empty()),
            ("all balls are within 0.6 m after", technique.spread <= GATHERED),
        ],
        Category::ThreeCushion => {
            let pattern = exercise.tags.first().and_then(|tag| PATTERNS.iter().find(|pattern| pattern.tag == tag));
            vec![
                ("the rule is three-cushion", exercise.rule.cushions() == 3),
                ("the first tag names a pattern", pattern.is_some()),
                ("the course is the pattern's", pattern.is_some_and(|pattern| (pattern.is_it)(&technique))),
                ("before or between the balls there are no more than five cushions", between <= 5),
            ]
        }
        Category::Own => Vec::new(),
    });
    Ok(checks.into_iter().filter_map(|(sentence, holds)| (!holds).then_some(sentence)).collect())
}

/// A pattern of three-cushion.
#[derive(Clone, Copy, Debug)]
pub struct Pattern {
    /// The tag that names it.
    pub tag: &'static str,
    /// Its course in words.
    pub course: &'static str,
    is_it: fn(&Technique) -> bool,
}

/// Least english that a pattern is named for, R w / v.
const MARKED: f64 = 0.2;

/// The patterns that the library knows.
pub const PATTERNS: [Pattern; 13] = [
    Pattern {
        tag: "natural",
        course: "ball 1, a long cushion, a short one, the other long one, ball 2",
        is_it: |t| t.before.is_empty() && course(t) == "lsL" && t.english > -MARKED,
    },
    Pattern {
        tag: "around-the-table",
        course: "ball 1, four cushions or more, each the next one round the table, ball 2",
        is_it: |t| t.before.is_empty() && matches!(course(t).as_str(), "lsLS" | "slSL" | "lsLSl" | "slSLs"),
    },
    Pattern {
        tag: "short-angle",
        course: "ball 1, a short cushion, a long one, the other short one, ball 2",
        is_it: |t| t.before.is_empty() && course(t) == "slS",
    },
    Pattern {
        tag: "across",
        course: "ball 1, three times across between the long cushions, ball 2",
        is_it: |t| t.before.is_empty() && course(t) == "lLl",
    },
    Pattern {
        tag: "up-and-down",
        course: "ball 1, three times along between the short cushions, ball 2",
        is_it: |t| t.before.is_empty() && course(t) == "sSs",
    },
    Pattern {
        tag: "plus",
        course: "ball 1, a short cushion, a long one, the other long one, ball 2, with running english",
        is_it: |t| t.before.is_empty() && course(t) == "slL" && t.english > MARKED,
    },
    Pattern {
        tag: "reverse",
        course: "ball 1, three cushions, ball 2, with reverse english",
        is_it: |t| t.before.is_empty() && t.between.len() == 3 && t.english < -MARKED,
    },
    Pattern {
        tag: "double-the-rail",
        course: "ball 1, a cushion, the one beside it, the first one again, ball 2, with reverse english",
        is_it: |t| t.before.is_empty() && matches!(course(t).as_str(), "lsl" | "sls") && t.english < -MARKED,
    },
    Pattern {
        tag: "rail-first",
        course: "a cushion, ball 1, two other cushions or more, ball 2",
        is_it: |t| t.before.len() == 1 && t.between.first() != t.before.first(),
    },
    Pattern {
        tag: "ticky",
        course: "a cushion, ball 1, the same cushion again, another or more, ball 2",
        is_it: |t| t.before.len() == 1 && t.between.first() == t.before.first(),
    },
    Pattern {
        tag: "umbrella",
        course: "two cushions, ball 1, a third one or more, ball 2",
        is_it: |t| t.before.len() == 2 && !t.between.is_empty(),
    },
    Pattern {
        tag: "bank",
        course: "three cushions, ball 1, ball 2",
        is_it: |t| t.before.len() == 3 && t.between.is_empty(),
    },
    Pattern { tag: "time", course: "ball 1 sends ball 2 to where the cue ball comes", is_it: |t| t.drives_second },
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

#[cfg(test)]
mod tests {
    use super::*;

    fn technique(layout: &str, cue: &str) -> Technique {
        let table = Table::default();
        let layout = Layout::parse(layout, &table).unwrap();
        Technique::of(&table, &layout, &CueInputs::parse(cue).unwrap()).unwrap()
    }

    #[test]
    fn the_course_and_the_side_are_told_apart_by_hand_made_shots() {
        // Up and to the right into the upper long cushion: a ball that rolls along it turns counter-clockwise, as a < 0 does.
        let bank = |a: &str| technique("-1,-0.5 1.3,-0.5 1.3,0.5", &format!("{a},0,0,45,3"));
        let (running, reverse) = (bank("-0.3"), bank("0.3"));
        assert!(running.english > 0.3 && reverse.english < -0.3, "{} {}", running.english, reverse.english);
        assert_eq!(running.before.first(), Some(&Rail::Top));
        assert_eq!(running.first, None);
    }

    #[test]
    fn a_full_ball_is_drawn_back_and_followed_through() {
        let drawn = technique("-0.3,0 0,0 -1,0.3", "0,-0.4,2,0.3,3");
        let followed = technique("-0.3,0 0,0 -1,0.3", "0,0.4,2,0.3,3");
        assert!(drawn.turn > 2.5 && followed.turn < 0.6, "{} {}", drawn.turn, followed.turn);
        assert!(drawn.fullness > 0.9);
    }
}
