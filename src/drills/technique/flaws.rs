//! Whether the shot of an exercise is what the exercise teaches.

use std::f64::consts::FRAC_PI_3;

use super::{PATTERNS, Technique};
use crate::{
    drills::{Category, Exercise, ExerciseError},
    game::{Point, scores},
    physics::{CueInputs, has_room},
};

/// Balls are gathered where no two are further apart, m: a little less than two diamonds of a `match` table.
pub const GATHERED: f64 = 0.6;

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
    let technique = Technique::of(&table, layout, &cue)?;
    let misses = |changed: CueInputs| !scores(exercise.rule, &table, layout, &changed);
    let is_tagged = |tag: &str| exercise.tags.iter().any(|other| other == tag);
    let mut checks = vec![
        ("the cue has room for it", has_room(&table, layout, &cue)),
        ("it makes the point by its rule", Point::of(exercise.rule, &table, layout).is_made(&technique.tally)),
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
                ("between the balls there are no more than five cushions", technique.between.len() <= 5),
            ]
        }
        Category::Own => Vec::new(),
    });
    Ok(checks.into_iter().filter_map(|(sentence, holds)| (!holds).then_some(sentence)).collect())
}
