//! A reader of the coach's sentences: converts the text, the balls and the table to a stroke.

use carom::{
    coach::{Cushion, RailPoint, StrokeText, Technique},
    physics::{CueInputs, raise_to_clear},
    simulation::Rail,
    table::{BALL_NAMES, CueBall, Layout, Table},
};

/// The information that a reader uses in addition to the sentence.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reading {
    /// Only the sentence.
    Sentence,
    /// The course: of all aims that agree with the sentence, the one with the nearest cushions.
    Course,
    /// The line of aim.
    Aim,
    /// Both: of all aims that agree with the line, the one with the nearest cushions.
    Both,
}

/// A stop on the course: a ball, or a cushion and the contact point on it, diamonds.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Stop {
    Ball(usize),
    Cushion(RailPoint),
}

/// Returns the stroke that the text describes: the sentence, the course and the line of aim, one line each.
///
/// # Errors
/// Returns the part that is not understood.
pub fn stroke(text: &str, reading: Reading, table: &Table, layout: &Layout) -> Result<CueInputs, String> {
    let [sentence, course_text, aim] = text.lines().collect::<Vec<_>>()[..] else {
        return Err("three lines".to_owned());
    };
    let parse = |text: &str| {
        let stroke = StrokeText::parse(text).and_then(|spoken| spoken.stroke(table, layout, CueBall::White, None));
        stroke.map_err(|error| error.to_string())
    };
    let (by_sentence, by_aim) = (parse(sentence)?, parse(&format!("{sentence} {aim}"))?);
    let stops = parse_course(course_text).ok_or("the course")?;
    let found = match reading {
        Reading::Sentence => Some(by_sentence),
        Reading::Aim => Some(by_aim),
        // The line is rounded to a hundredth of a diamond, and its farther mark is at least half a table away.
        Reading::Both => nearest(by_aim, 0.005 / 4.0, &by_sentence, &stops, table, layout),
        Reading::Course => {
            let start = layout.balls[0];
            // A sixteenth of a ball, or a tenth of a diamond on a cushion, is lost by rounding.
            let half = match stops.first().ok_or("no stop")? {
                Stop::Ball(ball) => 0.08 * table.radius / (layout.balls[*ball] - start).length(),
                Stop::Cushion(mark) => 0.08 * table.diamond() / (mark.position(table) - start).length(),
            };
            nearest(by_sentence, half, &by_sentence, &stops, table, layout)
        }
    };
    found.ok_or_else(|| "no stroke is near".to_owned())
}

fn rail_point((rail, diamond): (&str, &str)) -> Option<RailPoint> {
    let rail = Rail::ALL.into_iter().find(|one| rail == one.name())?;
    Some(RailPoint { rail, diamond: diamond.trim_end_matches('.').parse().ok()? })
}

/// Reads "Red – top 5.1 – left 1.2 – red again – bottom 2.3 – yellow, thin on the left."; the fullness at the second ball and the place of
/// another contact with the first ball are ignored.
fn parse_course(text: &str) -> Option<Vec<Stop>> {
    let text = text.trim_end_matches('.').to_lowercase();
    let text = text.split_once(", ").map_or(&*text, |(stops, _)| stops);
    let stop = |words: &str| match words.split_once(' ') {
        Some(mark) => Some(Stop::Cushion(rail_point(mark)?)),
        None => Some(Stop::Ball(BALL_NAMES.iter().position(|name| *name == words)?)),
    };
    text.split(" \u{2013} ").filter(|words| !words.ends_with(" again")).map(stop).collect()
}

/// Of the strokes in directions up to `half` from that of `cue`, rad, returns the one whose shot agrees best with the text: its first ball
/// is met as in `wanted`, and its course has these stops.
fn nearest(
    cue: CueInputs,
    half: f64,
    wanted: &CueInputs,
    stops: &[Stop],
    table: &Table,
    layout: &Layout,
) -> Option<CueInputs> {
    const STEPS: i32 = 20;
    let wanted = Technique::of(table, layout, wanted).ok()?;
    let at = |phi: f64| {
        let cue = CueInputs { phi, ..cue };
        raise_to_clear(table, layout, &cue).unwrap_or(cue)
    };
    let (mut middle, mut half) = (cue.phi, half);
    for _ in 0..2 {
        let phis = (-STEPS..=STEPS).map(|step| middle + half * f64::from(step) / f64::from(STEPS));
        let scored = phis.filter_map(|phi| {
            let technique = Technique::of(table, layout, &at(phi)).ok()?;
            Some((phi, hit_deviation(&technique, &wanted) + course_deviation(&technique, stops)))
        });
        middle = scored.min_by(|one, other| one.1.total_cmp(&other.1))?.0;
        half /= f64::from(STEPS);
    }
    Some(at(middle))
}

/// Returns the deviation of the first contact, in units of the rounding.
fn hit_deviation(technique: &Technique, wanted: &Technique) -> f64 {
    let left = |technique: &Technique| {
        technique.first.map(|hit| (hit.ball, if hit.left { 1.0 - hit.fullness } else { hit.fullness - 1.0 }))
    };
    match (left(technique), left(wanted)) {
        (Some((ball, left)), Some((wanted_ball, wanted_left))) if ball == wanted_ball => {
            penalty((left - wanted_left).abs() * 16.0)
        }
        (None, None) => 0.0,
        _ => 100.0,
    }
}

/// Returns the deviation of the course, in the same units.
fn course_deviation(technique: &Technique, stops: &[Stop]) -> f64 {
    let cushion = |Cushion { rail, diamond, .. }: &Cushion| Stop::Cushion(RailPoint { rail: *rail, diamond: *diamond });
    let mut course: Vec<Stop> = technique.before.iter().map(cushion).collect();
    course.extend(technique.first.map(|hit| Stop::Ball(hit.ball)));
    course.extend(technique.between.iter().map(cushion));
    if technique.tally.has_hit_both() {
        course.extend(technique.first.map(|hit| Stop::Ball(3 - hit.ball)));
    }
    let unlike = |(place, stop): (usize, &Stop)| match (stop, course.get(place)) {
        (Stop::Cushion(mark), Some(Stop::Cushion(its))) if mark.rail == its.rail => {
            penalty((mark.diamond - its.diamond).abs() * 10.0)
        }
        (Stop::Ball(ball), Some(Stop::Ball(its))) if ball == its => 0.0,
        _ => 50.0,
    };
    stops.iter().enumerate().map(unlike).sum()
}

/// A deviation of less than half a unit counts as agreement; a small term prefers the middle of that range.
fn penalty(units: f64) -> f64 {
    (units - 0.5).max(0.0) + 0.05 * units
}
