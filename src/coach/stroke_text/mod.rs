//! Strokes in players' words: "red 1/2 right, 1.5 left, 2 up, 3.5 lengths". Parses such a text and computes the stroke
//! that it means in a layout.

mod parse;
#[cfg(test)]
mod tests;

use super::{
    Hit, RailPoint, aim, first_hit,
    systems::DIAMOND_SETBACK,
    words::{TIP, format_trimmed, table_lengths},
};
use crate::{
    physics::{CueError, CueInputs, raise_to_clear, squirt},
    printing::number,
    simulation::{EventKind, Recording, ShotError},
    table::{CueBall, Layout, Table},
};

/// Minimum fullness of a graze: with less the cue ball may miss.
const MIN_FULLNESS: f64 = 0.02;

/// Tolerance of the fullness, ball diameters.
const FULLNESS_TOLERANCE: f64 = 1e-4;

/// Maximum steps of the secant method that finds the aim; a few are enough if the ball is hit at all. Also the number
/// of directions to each side that are tried off a cushion.
const MAX_STEPS: i32 = 40;

/// Maximum shift of the tip by rounding to half tips, radii: a quarter of a tip to the side and in height.
const MAX_TIP_ROUNDING: f64 = 0.25 * TIP * std::f64::consts::SQRT_2;

/// Step of the search for a direction that hits the ball if the straight one misses, ball diameters. The [`MAX_STEPS`]
/// trials alternate between the sides.
const SEARCH_STEP: f64 = 0.1;

/// Maximum deviation of the fullness if the requested one is not possible, ball diameters: the precision in which
/// players state it.
const MAX_FULLNESS_DEVIATION: f64 = 0.0625;

/// Speeds of the cue that a text can state, m/s; players strike more slowly than the largest.
const SPEEDS: std::ops::RangeInclusive<f64> = 0.05..=12.0;

/// Precision of a stated position on a cushion before the first ball, diamonds.
const CUSHION_PRECISION: f64 = 0.06;

/// Why a text is not a stroke, or not a playable one.
#[derive(Debug, PartialEq, thiserror::Error)]
pub enum StrokeTextError {
    /// A part of the text is not understood.
    #[error(
        "\"{0}\" is not understood; accepted are \"red 1/2 right\" or \"to 3.2 bottom\", \"1.5 left\", \"2 up\", \"3.5 lengths\" or \
         \"soft\", \"raised 20\" or \"level\", with commas between them"
    )]
    UnknownPart(String),
    /// A property is stated twice.
    #[error("{0} is given twice, last as \"{1}\"; give it once")]
    Duplicate(&'static str, String),
    /// The text states nothing.
    #[error("the text has no stroke; accepted is a text like \"red 1/2 right, 1.5 left, 2 up, 3.5 lengths\"")]
    Empty,
    /// The named ball is the player's cue ball.
    #[error("{0} is the cue ball; aim at one of the others")]
    CueBall(CueBall),
    /// The text does not state where to aim.
    #[error(
        "where to aim is missing; say a ball and how full, like \"red 1/2 right\", or the line of the cue, like \"to 3.2 bottom\""
    )]
    NoAim,
    /// The text states the fullness of the hit, but not the side.
    #[error("the side of the ball is missing; add \"right\" or \"left\" after the fullness")]
    NoSide,
    /// The text does not state a speed.
    #[error(
        "the speed is missing; give it in table lengths, like \"3.5 lengths\", in m/s, or as very soft, soft, medium, hard or very hard"
    )]
    NoSpeed,
    /// The text states a distance of the speed, and a word for another one.
    #[error("{0} lengths are {1}, not {2}; give the speed once")]
    Pace(f64, &'static str, &'static str),
    /// The speed is outside the range of cue speeds.
    #[error("{lengths} lengths are outside the range; accepted on this table are {least:.2} to {most:.0}")]
    Lengths {
        /// The stated distance, table lengths.
        lengths: f64,
        /// The distances of the slowest and of the fastest stroke, table lengths.
        least: f64,
        /// See `least`.
        most: f64,
    },
    /// The speed is faster or slower than players strike.
    #[error("{} m/s is outside the range; accepted are {} to {}", number(*_0), SPEEDS.start(), SPEEDS.end())]
    Speed(f64),
    /// The cue cannot be raised like this.
    #[error("a cue raised by {} degrees is outside the range; accepted is {_1}", number(*_0))]
    Elevation(f64, &'static str),
    /// The tip would slip off the ball.
    #[error("{} tips from the centre, the tip would slip off the ball; accepted are at most {}", format_trimmed(*.0, 1), format_trimmed(*.1, 1))]
    Tips(f64, f64),
    /// The ball cannot be hit like this from the cue ball's position.
    #[error("{0} cannot be hit like this: something is in the way, or it is too far to the side")]
    Unreachable(&'static str),
    /// An input of the stroke is outside its range.
    #[error(transparent)]
    Cue(#[from] CueError),
    /// The stroke cannot be played here.
    #[error(transparent)]
    Shot(#[from] ShotError),
}

/// The stated speed of a stroke.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Speed {
    /// Distance that a ball runs when it is struck in its centre, table lengths.
    Lengths(f64),
    /// Speed of the cue, m/s.
    Cue(f64),
}

/// A point at a cushion that defines a line.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Mark {
    point: RailPoint,
    /// Whether the point is a diamond on the wood instead of the point of the nose in front of it.
    on_wood: bool,
}

/// The content of a text. Omitted properties are `None`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StrokeText {
    /// The first object ball, as an index into white, yellow and red.
    colour: Option<usize>,
    /// Fullness of the hit, 0 to 1.
    fullness: Option<f64>,
    /// Whether the ball is hit on its left.
    left: Option<bool>,
    /// Where the cue ball hits a cushion before the first ball.
    rail: Option<RailPoint>,
    /// The point at which the cue is aimed.
    to: Option<Mark>,
    /// The point behind the cue ball on the line of aim.
    from: Option<Mark>,
    /// Tip position, to the left and up, ball radii.
    side: Option<f64>,
    height: Option<f64>,
    /// Speed in words, as table lengths; a number in the text takes precedence.
    pace: Option<f64>,
    speed: Option<Speed>,
    /// Elevation of the cue, rad.
    elevation: Option<f64>,
}

impl StrokeText {
    /// Computes the stroke, for a player with `cue_ball`. Omitted properties are taken from `before`, and an omitted aim
    /// stays, or its hit if the side is given; without `before` the cue is level and strikes the centre. If rails or balls
    /// behind the cue ball are in the way, the cue is raised as far as needed.
    ///
    /// # Errors
    /// Fails if a property is missing, or the stroke cannot be played in this layout.
    pub fn stroke(
        &self,
        table: &Table,
        layout: &Layout,
        cue_ball: CueBall,
        before: Option<&CueInputs>,
    ) -> Result<CueInputs, StrokeTextError> {
        let speed = match self.speed.or(self.pace.map(Speed::Lengths)) {
            Some(Speed::Cue(speed)) if !SPEEDS.contains(&speed) => return Err(StrokeTextError::Speed(speed)),
            Some(Speed::Cue(speed)) => speed,
            Some(Speed::Lengths(lengths)) => speed_of(table, lengths)?,
            None => before.ok_or(StrokeTextError::NoSpeed)?.speed,
        };
        let level = CueInputs { a: 0.0, b: 0.0, theta: 0.0, phi: 0.0, speed };
        let cue = before.copied().unwrap_or(level);
        let (a, b) = (self.side.unwrap_or(cue.a), self.height.unwrap_or(cue.b));
        let mut cue = CueInputs { a, b, theta: self.elevation.unwrap_or(cue.theta), speed, ..cue };
        // A raised cue may hit the ball farther up.
        if cue.is_miscue(table) {
            [cue.a, cue.b] = accepted_tip([a, b], table.miscue_limit)?;
        }
        cue.validate().map_err(|error| match error {
            CueError::Range { name: "theta", value, accepted } => StrokeTextError::Elevation(value, accepted),
            error => StrokeTextError::Cue(error),
        })?;
        let at = |phi: f64| {
            let cue = CueInputs { phi, ..cue };
            raise_to_clear(table, layout, &cue).unwrap_or(cue)
        };
        let from = layout.balls[0];
        let (to, behind) = (self.to.map(|mark| mark.position(table)), self.from.map(|mark| mark.position(table)));
        let ways = [to.map(|to| to - from), behind.map(|behind| from - behind)];
        if let Some(way) = ways.into_iter().flatten().max_by(|one, other| one.length().total_cmp(&other.length())) {
            return Ok(at(way.to_angle()));
        }
        let ball = self.colour.map(|colour| cue_ball.to_ball_order([0, 1, 2])[colour]);
        if ball == Some(0) {
            return Err(StrokeTextError::CueBall(cue_ball));
        }
        if let Some(point) = self.rail {
            let way = point.position(table) + table.radius * point.rail.normal() - from;
            let phi = way.to_angle() - squirt(table, cue.a);
            // Seen from the cue ball, a diamond appears shortened on a flat path.
            let half = CUSHION_PRECISION * table.diamond() * way.normalize_or_zero().dot(point.rail.normal()).abs()
                / way.length();
            let hit = ball.zip(self.offset().ok());
            let found = hit.and_then(|hit| nearest(table, layout, hit, phi, half, at));
            return Ok(found.map_or_else(|| at(phi), |(_, cue)| cue));
        }
        if ball.is_none() && self.fullness.is_none() {
            let before = before.ok_or(StrokeTextError::NoAim)?;
            // Side alone does not change the hit.
            return if self.side.is_some() { with_same_hit(table, layout, before, a, at) } else { Ok(at(before.phi)) };
        }
        let known = before.and_then(|before| aim(table, layout, before).ok()?.hit);
        let ball = ball.or(known.map(|hit| hit.ball)).ok_or(StrokeTextError::NoAim)?;
        let found = aim_at(table, layout, (ball, self.offset()?), cue.a, at)?;
        found.ok_or(StrokeTextError::Unreachable(cue_ball.names()[ball]))
    }

    /// Returns the signed distance between the cue ball's line and the ball's centre, in ball diameters, positive to
    /// the left.
    fn offset(&self) -> Result<f64, StrokeTextError> {
        let fullness = self.fullness.ok_or(StrokeTextError::NoAim)?.clamp(MIN_FULLNESS, 1.0);
        match self.left {
            Some(true) => Ok(1.0 - fullness),
            Some(false) => Ok(fullness - 1.0),
            None if fullness < 1.0 => Err(StrokeTextError::NoSide),
            None => Ok(0.0),
        }
    }
}

impl Mark {
    /// Returns the position of the mark on the table, m.
    fn position(self, table: &Table) -> glam::DVec2 {
        let behind = if self.on_wood { DIAMOND_SETBACK * table.diamond() } else { 0.0 };
        self.point.position(table) - behind * self.point.rail.normal()
    }
}

/// Returns the stroke with another `side` that hits the first ball as full as `before`. Off a cushion, or if no ball is hit, its cue ball
/// starts on the same path.
fn with_same_hit(
    table: &Table,
    layout: &Layout,
    before: &CueInputs,
    side: f64,
    at: impl Fn(f64) -> CueInputs,
) -> Result<CueInputs, StrokeTextError> {
    let played = raise_to_clear(table, layout, before).unwrap_or(*before);
    let recording = Recording::new(table, layout, &played)?;
    let is_contact = |kind: &EventKind| matches!(kind, EventKind::BallBall(0, _) | EventKind::BallRail(0, _));
    let first = recording.events().iter().map(|event| event.kind).find(is_contact);
    if let (Some(EventKind::BallBall(..)), Some(hit)) = (first, first_hit(table, &recording))
        && let Some(found) = aim_at(table, layout, (hit.ball, offset(&hit)), side, &at)?
    {
        return Ok(found);
    }
    Ok(at(before.phi + squirt(table, before.a) - squirt(table, side)))
}

/// Returns the signed distance between the cue ball's line and the ball's centre at impact, in ball diameters, positive to the left.
fn offset(hit: &Hit) -> f64 {
    if hit.left { 1.0 - hit.fullness } else { hit.fullness - 1.0 }
}

/// Returns the signed distance between the cue ball's line and the centre of `ball` at impact, in ball diameters,
/// positive to the left. `None` if the cue ball hits another ball first, or none.
fn offset_at_impact(table: &Table, layout: &Layout, ball: usize, cue: &CueInputs) -> Result<Option<f64>, ShotError> {
    let hit = aim(table, layout, cue)?.hit.filter(|hit| hit.ball == ball);
    Ok(hit.as_ref().map(offset))
}

/// Finds the stroke, among directions up to `half` from `phi`, rad, whose offset from the ball is nearest to the wanted one. Returns the
/// deviation, ball diameters, and the stroke; `None` if none meets the ball first.
fn nearest(
    table: &Table,
    layout: &Layout,
    (ball, wanted): (usize, f64),
    phi: f64,
    half: f64,
    at: impl Fn(f64) -> CueInputs,
) -> Option<(f64, CueInputs)> {
    let strokes = (-MAX_STEPS..=MAX_STEPS).map(|step| at(phi + half * f64::from(step) / f64::from(MAX_STEPS)));
    let off = |cue: &CueInputs| Some((offset_at_impact(table, layout, ball, cue).ok()?? - wanted).abs());
    let known = strokes.filter_map(|cue| Some((off(&cue)?, cue)));
    known.min_by(|one, other| one.0.total_cmp(&other.0))
}

/// Finds the stroke whose offset from the ball at impact, in ball diameters, positive to the left, is the wanted one, or
/// nearly so. `None` if none was found. The simulation includes squirt and the swerve of a raised cue.
fn aim_at(
    table: &Table,
    layout: &Layout,
    (ball, wanted): (usize, f64),
    side: f64,
    at: impl Fn(f64) -> CueInputs,
) -> Result<Option<CueInputs>, ShotError> {
    let way = layout.balls[ball] - layout.balls[0];
    let lever = way.length() / (2.0 * table.radius);
    let straight = way.to_angle() + (wanted / lever).clamp(-1.0, 1.0).asin() - squirt(table, side);
    // The swerve is not known beforehand: if the straight direction misses, a neighbouring one hits the ball.
    let beside = |step: i32| straight + SEARCH_STEP * f64::from(if step % 2 == 0 { step } else { -step }) / lever;
    let Some(mut met) =
        (0..MAX_STEPS).map(beside).find(|phi| matches!(offset_at_impact(table, layout, ball, &at(*phi)), Ok(Some(_))))
    else {
        return Ok(None);
    };
    let mut phi = met;
    for _ in 0..MAX_STEPS {
        match offset_at_impact(table, layout, ball, &at(phi))? {
            Some(passed) if (passed - wanted).abs() < FULLNESS_TOLERANCE => return Ok(Some(at(phi))),
            Some(passed) => {
                met = phi;
                phi += (wanted - passed) / lever;
            }
            None => phi = 0.5 * (phi + met),
        }
    }
    // The other ball may block exactly this hit: take the nearest possible one.
    let near = nearest(table, layout, (ball, wanted), met, MAX_FULLNESS_DEVIATION / lever, at);
    Ok(near.filter(|(deviation, _)| *deviation <= MAX_FULLNESS_DEVIATION).map(|(_, cue)| cue))
}

/// Returns the cue speed at which a ball runs this number of table lengths, m/s.
fn speed_of(table: &Table, lengths: f64) -> Result<f64, StrokeTextError> {
    let of = |speed| table_lengths(table, speed).unwrap_or_default();
    let (mut low, mut high) = SPEEDS.into_inner();
    // Rounded inwards, so that the limits that the error states are accepted.
    let (least, most) = ((100.0 * of(low)).ceil() / 100.0, of(high).floor());
    if !(least..=most).contains(&lengths) {
        return Err(StrokeTextError::Lengths { lengths, least, most });
    }
    for _ in 0..30 {
        let middle = 0.5 * (low + high);
        if of(middle) < lengths { low = middle } else { high = middle }
    }
    Ok(0.5 * (low + high))
}

/// Returns the tip position, radii, unless the tip of a level cue would slip off the ball. A position in half tips, as the coach reports it,
/// may be rounded to slightly beyond the miscue limit; it is moved back to the limit.
fn accepted_tip([a, b]: [f64; 2], limit: f64) -> Result<[f64; 2], StrokeTextError> {
    let (said, most) = (libm::hypot(a, b), limit.sqrt());
    if said > most + MAX_TIP_ROUNDING {
        return Err(StrokeTextError::Tips(said / TIP, most / TIP));
    }
    // Slightly inside, so that rounding of the square does not exceed the limit.
    let share = if a * a + b * b > limit { (1.0 - 1e-12) * most / said } else { 1.0 };
    Ok([a, b].map(|part| share * part))
}
