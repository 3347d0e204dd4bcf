//! Checks whether the shot of an exercise shows what the exercise teaches.

use std::f64::consts::FRAC_PI_3;

use glam::DVec2;

use super::{Category, Exercise, ExerciseError};
use crate::{
    coach::{
        PATTERNS, Pattern, Technique,
        systems::{Applied, Guide, System, guide},
    },
    game::{Point, scores},
    physics::{CueInputs, has_room, raise_to_clear},
    simulation::Recording,
    table::Table,
};

/// The balls count as gathered if no two are further apart than this, m: a little less than two diamonds of a `match` table.
pub const MAX_GATHERED_DISTANCE: f64 = 0.6;

/// Lists the promises that the shot of an exercise does not keep, as sentences. Own exercises and exercises without a
/// shot promise nothing.
///
/// Every bundled shot hits yellow first, or red in the opening, hits it once, and makes the point by its rule. The
/// other promises depend on the category, and in three-cushion on the pattern that the first tag names.
///
/// # Errors
/// Fails if the exercise cannot be played.
pub fn flaws(exercise: &Exercise) -> Result<Vec<&'static str>, ExerciseError> {
    exercise.validate()?;
    let table = exercise.table()?;
    let Some(cue) = exercise.shot.filter(|_| exercise.category != Category::Own) else { return Ok(Vec::new()) };
    let layout = &exercise.layout;
    let technique = Technique::of(&table, layout, &cue)?;
    let misses = |changed: CueInputs| !scores(exercise.rule, &table, layout, &changed);
    let point = Point::of(exercise.rule, &table, layout);
    let mut checks = vec![
        ("the cue has room for it", has_room(&table, layout, &cue)),
        ("it makes the point by its rule", point.is_made(&technique.tally)),
        (
            "it hits yellow first, or red in the opening",
            technique.first.is_some_and(|hit| hit.ball == point.first_ball()),
        ),
        ("it hits the first ball only once before the second", technique.rehit_after.is_none()),
        ("it covers at least a twentieth of the first ball", technique.fullness() >= 0.05),
        ("yellow stays away from red but in a time shot", technique.drives_second == exercise.has_tag("time")),
        (
            "with the tag back the cue ball turns by more than 90 degrees",
            !exercise.has_tag("back") || technique.deflection > 1.5 * FRAC_PI_3,
        ),
    ];
    checks.extend(match exercise.category {
        Category::FirstCaroms => vec![
            ("it goes from ball to ball", technique.tally.cushions_before_second == 0),
            ("it has no side", cue.a == 0.0),
        ],
        Category::Draw => vec![
            ("the tip is more than 0.2 R below the centre", cue.b < -0.2),
            ("the cue ball turns by more than 60 degrees", technique.deflection > FRAC_PI_3),
            ("struck in the middle it misses", misses(CueInputs { b: 0.0, ..cue })),
        ],
        Category::Follow => vec![
            ("the tip is more than 0.2 R above the centre", cue.b > 0.2),
            ("yellow is hit at least seven tenths full", technique.fullness() >= 0.7),
            ("the cue ball turns by less than 40 degrees", technique.deflection < 2.0 / 3.0 * FRAC_PI_3),
        ],
        Category::Side => vec![
            ("the tip is more than 0.25 R off to the side", cue.a.abs() > 0.25),
            ("without side it misses", misses(CueInputs { a: 0.0, ..cue })),
        ],
        Category::OneCushion => vec![("the rule is one-cushion", exercise.rule.cushions() == 1)],
        Category::Gather => vec![
            (
                "the object balls are more than 0.6 m apart before",
                layout.balls[1].distance(layout.balls[2]) > MAX_GATHERED_DISTANCE,
            ),
            ("yellow comes back from a cushion", !technique.first_ball_rails.is_empty()),
            ("all balls are within 0.6 m after", technique.spread <= MAX_GATHERED_DISTANCE),
        ],
        Category::ThreeCushion => {
            let tag = exercise.tags.first().map_or("", String::as_str);
            vec![
                ("the rule is three-cushion", exercise.rule.cushions() == 3),
                ("the first tag names a pattern", PATTERNS.iter().any(|pattern| pattern.tag == tag)),
                ("the course is the pattern's", Pattern::of(&technique).is_some_and(|pattern| pattern.tag == tag)),
                ("between the balls there are no more than five cushions", technique.between.len() <= 5),
            ]
        }
        Category::Systems => {
            let applied = applied_system(exercise, &table, &cue)?;
            let name = applied.as_ref().map(|applied| applied.system.name().to_lowercase());
            vec![
                ("the rule is three-cushion", exercise.rule.cushions() == 3),
                ("the first tag names the system that describes it", exercise.tags.first() == name.as_ref()),
                ("it is aimed at the number in the point", applied.is_some_and(|one| matches_point(exercise, &one))),
            ]
        }
        Category::JumpAndMasse => elevated_flaws(exercise, &table, &technique, &cue)?,
        Category::Own => Vec::new(),
    });
    checks.extend(tag_promises(exercise, &technique, &cue));
    Ok(checks.into_iter().filter_map(|(sentence, holds)| (!holds).then_some(sentence)).collect())
}

/// Distance above which a jump is a far one and below which it is a near one, m, and the elevations from which on a
/// massé is a half and a full one, rad.
const MIN_FAR_JUMP: f64 = 0.6;
const MAX_NEAR_JUMP: f64 = 0.2;
const MIN_HALF_MASSE: f64 = 30.0_f64.to_radians();
const MIN_FULL_MASSE: f64 = 63.0_f64.to_radians();

/// Checks the promises of a shot with a raised cue, by its first tag: it flies over red, or its path bends, or it hops
/// because the cue ball starts at a rail.
fn elevated_flaws(
    exercise: &Exercise,
    table: &Table,
    technique: &Technique,
    cue: &CueInputs,
) -> Result<Vec<(&'static str, bool)>, ExerciseError> {
    let [cue_ball, _, red] = exercise.layout.balls;
    let (way, ahead) = (red - cue_ball, DVec2::from_angle(cue.phi));
    let recording = Recording::new(table, &exercise.layout, cue)?;
    let first = recording.events().iter().find(|event| event.kind.is_contact());
    // A hop at the rail must be high enough to be reported, and must end before the first contact.
    let hops = recording.jumps().into_iter().find(|jump| jump.ball == 0);
    let has_landed = hops.zip(first).is_some_and(|(hop, first)| hop.is_reported() && hop.end <= first.time);
    let is_least = raise_to_clear(table, &exercise.layout, &CueInputs { theta: 0.0, ..*cue })
        .is_ok_and(|least| cue.theta <= least.theta + 0.5_f64.to_radians());
    let (flies, bends) = (technique.over == Some(2), technique.over.is_none() && technique.is_jump_or_masse());
    let steep = cue.theta;
    Ok(vec![
        (
            "the first tag is jump, masse or hop",
            exercise.tags.first().is_some_and(|tag| ["jump", "masse", "hop"].contains(&tag.as_str())),
        ),
        ("with the tag jump the cue ball flies over red", flies == exercise.has_tag("jump")),
        (
            "with the tag edge it passes over less than half of it",
            !exercise.has_tag("edge") || ahead.perp_dot(way).abs() > table.radius,
        ),
        ("with the tag far red is more than 0.6 m away", !exercise.has_tag("far") || way.length() > MIN_FAR_JUMP),
        ("with the tag near red is less than 0.2 m away", !exercise.has_tag("near") || way.length() < MAX_NEAR_JUMP),
        ("with the tag masse the way bends by more than 15 degrees", bends == exercise.has_tag("masse")),
        (
            "with the tag half the cue is raised by 30 to 63 degrees",
            !exercise.has_tag("half") || (MIN_HALF_MASSE..MIN_FULL_MASSE).contains(&steep),
        ),
        (
            "with the tag full the cue is raised by more than 63 degrees",
            !exercise.has_tag("full") || steep >= MIN_FULL_MASSE,
        ),
        (
            "with the tag hop the cue is as level as the rail allows",
            !exercise.has_tag("hop") || is_least && steep > 0.0,
        ),
        ("with the tag hop the cue ball has come down before it meets yellow", !exercise.has_tag("hop") || has_landed),
    ])
}

/// Returns the diamond system that describes the shot, with its numbers.
fn applied_system(exercise: &Exercise, table: &Table, cue: &CueInputs) -> Result<Option<Applied>, ExerciseError> {
    Ok(match guide(table, &Recording::new(table, &exercise.layout, cue)?) {
        Some(Guide::System(applied)) => Some(applied),
        _ => None,
    })
}

/// Whether the shot itself is aimed at the result of the sum in the point, to a twentieth of a diamond.
fn matches_point(exercise: &Exercise, applied: &Applied) -> bool {
    let sum =
        exercise.point.split_once("= ").map(|(_, sum)| sum.split([',', ':', ';', ' ']).next().unwrap_or_default());
    let stated: Option<f64> = sum.and_then(|sum| sum.trim_end_matches('.').parse().ok());
    let twentieth = if applied.system == System::Plus { 0.05 } else { 0.5 };
    stated.zip(applied.shot_first).is_some_and(|(stated, shot)| (stated - shot).abs() <= twentieth)
}

/// Returns the promises of the tags about the stroke and its course, each with whether the shot keeps it.
fn tag_promises(
    exercise: &Exercise,
    technique: &Technique,
    cue: &CueInputs,
) -> impl Iterator<Item = (&'static str, bool)> {
    let cushions = technique.before.len() + technique.between.len();
    let direct = matches!(exercise.category, Category::OneCushion | Category::Side);
    let checks = [
        ("draw", "with the tag draw the tip is more than 0.15 R below the centre", cue.b < -0.15),
        ("follow", "with the tag follow the tip is more than 0.1 R above the centre", cue.b > 0.1),
        ("running", "with the tag running the first cushion is met with running english", technique.english > 0.0),
        ("reverse", "with the tag reverse the first cushion is met with reverse english", technique.english < 0.0),
        ("cushion-first", "with the tag cushion-first a cushion comes before yellow", !technique.before.is_empty()),
        ("two-cushions", "with the tag two-cushions there are two cushions before red", cushions == 2 || !direct),
        ("three-cushions", "with the tag three-cushions there are three before red", cushions == 3 || !direct),
    ];
    let promised = checks.into_iter().filter(|(tag, ..)| exercise.has_tag(tag));
    promised.map(|(_, sentence, holds)| (sentence, holds))
}
