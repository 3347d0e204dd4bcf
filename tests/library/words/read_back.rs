//! A reader of the coach's sentences: from the text, the balls and the table alone to a stroke.

use std::f64::consts::FRAC_PI_2;

use carom::{
    coach::{
        Cushion, RailPoint, Technique,
        words::{TIP, table_lengths},
    },
    physics::{CueInputs, squirt, with_room},
    simulation::Rail,
    table::{BALL_NAMES, Layout, Table},
};

/// Sixteenths of a ball by their words.
const FULLNESS: [&str; 17] = [
    "a graze",
    "very thin",
    "an eighth full",
    "a little thinner than a quarter",
    "a quarter full",
    "a little thicker than a quarter",
    "three eighths full",
    "a little thinner than half",
    "half full",
    "a little thicker than half",
    "five eighths full",
    "a little thinner than three quarters",
    "three quarters full",
    "a little thicker than three quarters",
    "seven eighths full",
    "almost full",
    "full",
];

const NUMBERS: [&str; 11] = ["no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten"];

/// What a reader goes by besides the sentence.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reading {
    /// Nothing.
    Sentence,
    /// The course: of all aims that the sentence allows, the one whose cushions come nearest.
    Course,
    /// The line of aim.
    Aim,
    /// Both: of all aims that the line allows, the one whose cushions come nearest.
    Both,
}

/// A stop on the course: a ball, or a cushion and where it is met, diamonds.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Stop {
    Ball(usize),
    Cushion(RailPoint),
}

/// What a text says.
#[derive(Clone, Debug, PartialEq)]
struct Said {
    /// The rail that comes before the first ball, and where.
    rail: Option<RailPoint>,
    ball: usize,
    /// How far the line of the cue ball passes the ball's middle on its left, in ball diameters.
    left: f64,
    cue: CueInputs,
}

/// The stroke that the text tells: the sentence, the course and the line of aim, a line each.
pub fn stroke(text: &str, reading: Reading, table: &Table, layout: &Layout) -> Option<CueInputs> {
    let mut lines = text.lines();
    let said = sentence(lines.next()?, table)?;
    let stops = course(lines.next()?)?;
    let aim = aim(lines.next()?, table, layout)?;
    let at = |phi: f64| raised(table, layout, CueInputs { phi, ..said.cue });
    let found = match reading {
        Reading::Aim => at(aim.0),
        Reading::Both => nearest(aim, &said, &stops, table, layout, &at)?,
        Reading::Sentence => nearest(window(&said, table, layout), &said, &[], table, layout, &at)?,
        Reading::Course => nearest(window(&said, table, layout), &said, &stops, table, layout, &at)?,
    };
    Some(found)
}

fn raised(table: &Table, layout: &Layout, cue: CueInputs) -> CueInputs {
    with_room(table, layout, &cue).unwrap_or(cue)
}

/// Reads "Red, half full on the left; two tips of right at 2 o'clock, one tip above centre; soft (2 table lengths), level cue."
fn sentence(text: &str, table: &Table) -> Option<Said> {
    let text = text.trim_end_matches('.').to_lowercase();
    let [first, tip, stroke] = text.split("; ").collect::<Vec<_>>()[..] else { return None };
    let (rail, ball) = match first.rsplit_once(", then ") {
        // Which cushions follow before the ball, the course says, too.
        Some((rails, ball)) => (Some(rail_point(rails.split(", then ").next()?.split_once(" first at ")?)?), ball),
        None => (None, first),
    };
    let (name, full) = ball.split_once(", ")?;
    let (full, side) = match (full.strip_suffix(" on the left"), full.strip_suffix(" on the right")) {
        (Some(full), _) => (full, 1.0),
        (_, Some(full)) => (full, -1.0),
        _ => (full, 0.0),
    };
    let sixteenths = FULLNESS.iter().position(|words| *words == full)?;
    let (a, b) = tip_place(tip)?;
    let (speed, cue) = stroke.split_once("), ")?;
    let lengths: f64 = speed.split_once('(')?.1.split(' ').next()?.parse().ok()?;
    let theta = match cue.strip_prefix("cue raised ") {
        Some(degrees) => degrees.trim_end_matches('\u{b0}').parse::<f64>().ok()?.to_radians(),
        None => 0.0,
    };
    Some(Said {
        rail,
        ball: BALL_NAMES.iter().position(|known| *known == name)?,
        left: side * (1.0 - sixteenths as f64 / 16.0),
        cue: CueInputs { a, b, theta, phi: 0.0, speed: speed_of(table, lengths)? },
    })
}

/// The place of the tip, radii: to the left and up.
fn tip_place(text: &str) -> Option<(f64, f64)> {
    if text == "centre ball" {
        return Some((0.0, 0.0));
    }
    let (side, height) = text.split_once(", ")?;
    let a = match side.split_once(" of ") {
        Some((tips, way)) => {
            let sign = if way.contains("left") { 1.0 } else { -1.0 };
            sign * tips_of(tips)? * TIP
        }
        None => 0.0,
    };
    let b = match (height.strip_suffix(" above centre"), height.strip_suffix(" below centre")) {
        (Some(tips), _) => tips_of(tips)? * TIP,
        (_, Some(tips)) => -tips_of(tips)? * TIP,
        _ => 0.0,
    };
    Some((a, b))
}

fn tips_of(text: &str) -> Option<f64> {
    match text {
        "a little" | "half a tip" => Some(0.5),
        "one tip" => Some(1.0),
        _ => {
            let (number, half) = match text.strip_suffix(" and a half tips") {
                Some(number) => (number, 0.5),
                None => (text.strip_suffix(" tips")?, 0.0),
            };
            Some(NUMBERS.iter().position(|word| *word == number)? as f64 + half)
        }
    }
}

/// The speed at which a ball runs so many table lengths.
fn speed_of(table: &Table, lengths: f64) -> Option<f64> {
    let (mut low, mut high) = (0.01, 12.0);
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if table_lengths(table, middle)? < lengths { low = middle } else { high = middle }
    }
    Some(0.5 * (low + high))
}

fn rail_point((rail, diamond): (&str, &str)) -> Option<RailPoint> {
    let rail = Rail::ALL.into_iter().find(|one| rail.starts_with(one.name()))?;
    Some(RailPoint { rail, diamond: diamond.trim_end_matches('.').parse().ok()? })
}

/// Reads "Red – top 5.1 – left 1.2 – red again – bottom 2.3 – yellow, thin on the left."; how the second ball is met is not gone by, nor where
/// the first is met again.
fn course(text: &str) -> Option<Vec<Stop>> {
    let text = text.trim_end_matches('.').to_lowercase();
    let text = text.split_once(", ").map_or(&*text, |(stops, _)| stops);
    let stop = |words: &str| match words.split_once(' ') {
        Some(mark) => Some(Stop::Cushion(rail_point(mark)?)),
        None => Some(Stop::Ball(BALL_NAMES.iter().position(|name| *name == words)?)),
    };
    text.split(" \u{2013} ").filter(|words| !words.ends_with(" again")).map(stop).collect()
}

/// Reads "Cue from 4.2 on the bottom long rail to 0.98 on the top long rail.": the direction, and how far off it may be, rad.
fn aim(text: &str, table: &Table, layout: &Layout) -> Option<(f64, f64)> {
    let (from, to) = text.strip_prefix("Cue from ")?.split_once(" to ")?;
    let place = |mark: &str| {
        let (diamond, rail) = mark.split_once(" on the ")?;
        Some(rail_point((rail, diamond))?.place(table))
    };
    let start = layout.balls[0];
    let [behind, ahead] = [start - place(from)?, place(to)? - start];
    // The further of the two marks is the more exact.
    let longer = if ahead.length() > behind.length() { ahead } else { behind };
    Some((longer.to_angle(), 0.005 * table.diamond() / longer.length()))
}

/// The direction that the sentence tells, and how far off it may be: as far as a sixteenth of a ball, or a tenth of a diamond,
/// is rounded.
fn window(said: &Said, table: &Table, layout: &Layout) -> (f64, f64) {
    let start = layout.balls[0];
    let squirted = |phi: f64| phi - squirt(table, said.cue.a);
    if let Some(mark) = said.rail {
        let way = mark.place(table) + table.radius * mark.rail.normal() - start;
        // From the cue ball's side a diamond seems the shorter, the flatter the way.
        let seen = (way.normalize_or_zero().dot(mark.rail.normal())).abs().max(0.1);
        return (squirted(way.to_angle()), 0.08 * table.diamond() * seen / way.length());
    }
    let way = layout.balls[said.ball] - start;
    let angle = |left: f64| (2.0 * table.radius * left / way.length()).clamp(-1.0, 1.0).asin();
    let (least, most) = (angle(said.left - 0.04), angle(said.left + 0.04));
    // A cue that is raised bends the way a little.
    let bend = said.cue.a.abs() * 0.01;
    (squirted(way.to_angle() + 0.5 * (least + most)), 0.5 * (most - least) + bend)
}

/// Of the directions in a window, the one whose shot is most like what is said.
fn nearest(
    (middle, half): (f64, f64),
    said: &Said,
    stops: &[Stop],
    table: &Table,
    layout: &Layout,
    at: &dyn Fn(f64) -> CueInputs,
) -> Option<CueInputs> {
    const STEPS: i32 = 20;
    let (mut middle, mut half) = (middle, half.min(FRAC_PI_2));
    for _ in 0..2 {
        let phis = (-STEPS..=STEPS).map(|step| middle + half * f64::from(step) / f64::from(STEPS));
        let scored = phis.filter_map(|phi| Some((phi, unlike(&at(phi), said, stops, table, layout)?)));
        middle = scored.min_by(|one, other| one.1.total_cmp(&other.1))?.0;
        half /= f64::from(STEPS);
    }
    Some(at(middle))
}

/// How unlike what is said a shot is: in units of what is rounded away.
fn unlike(cue: &CueInputs, said: &Said, stops: &[Stop], table: &Table, layout: &Layout) -> Option<f64> {
    let technique = Technique::of(table, layout, cue).ok()?;
    let mut far = 0.0;
    match technique.first {
        Some(hit) if hit.ball == said.ball => {
            let left = if hit.left { 1.0 - hit.fullness } else { hit.fullness - 1.0 };
            far += beyond((left - said.left).abs() * 16.0);
        }
        _ => far += 100.0,
    }
    if let Some(mark) = said.rail {
        match technique.before.first() {
            Some(Cushion { rail, diamond, .. }) if *rail == mark.rail => {
                far += beyond((diamond - mark.diamond).abs() * 10.0);
            }
            _ => far += 100.0,
        }
    }
    if !stops.is_empty() {
        let cushion =
            |Cushion { rail, diamond, .. }: &Cushion| Stop::Cushion(RailPoint { rail: *rail, diamond: *diamond });
        let mut course: Vec<Stop> = technique.before.iter().map(cushion).collect();
        course.extend(technique.first.map(|hit| Stop::Ball(hit.ball)));
        course.extend(technique.between.iter().map(cushion));
        if technique.tally.met_both() {
            course.extend(technique.first.map(|hit| Stop::Ball(3 - hit.ball)));
        }
        for (place, stop) in stops.iter().enumerate() {
            far += match (stop, course.get(place)) {
                (Stop::Cushion(mark), Some(Stop::Cushion(its))) if mark.rail == its.rail => {
                    beyond((mark.diamond - its.diamond).abs() * 10.0)
                }
                (Stop::Ball(ball), Some(Stop::Ball(its))) if ball == its => 0.0,
                _ => 50.0,
            };
        }
    }
    Some(far)
}

/// What is off by less than half a unit is what was said; a little is taken off towards the middle of it.
fn beyond(units: f64) -> f64 {
    (units - 0.5).max(0.0) + 0.05 * units
}
