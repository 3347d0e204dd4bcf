//! A stroke as players say it: "red 1/2 right, 1.5 left, 2 up, 3.5 lengths". What a text says, and the stroke that it means where the balls
//! lie.

mod read;
#[cfg(test)]
mod tests;

use super::{
    RailPoint, aim,
    systems::BEHIND,
    words::{TIP, table_lengths},
};
use crate::{
    physics::{CueError, CueInputs, squirt, with_room},
    simulation::ShotError,
    table::{CueBall, Layout, Table},
};

/// The least share of a ball that a graze covers: with less the cue ball may pass.
const GRAZE: f64 = 0.02;

/// How near the fullness comes to what is said, ball diameters.
const ACCURACY: f64 = 1e-4;

/// Steps of the secant method that finds the aim, of which a few are enough where a ball is met at all; and directions to each side that are
/// tried behind a cushion.
const STEPS: i32 = 40;

/// As far as rounding to half tips moves the tip at most, radii: a quarter of a tip to the side and in height.
const ROUNDED: f64 = 0.25 * TIP * std::f64::consts::SQRT_2;

/// How far beside the straight way a ball is looked for that is missed on it, at most so many times [`STEPS`], ball diameters.
const SWERVE: f64 = 0.1;

/// How far from what is said the fullness may be where just that is not possible, ball diameters: as far as players tell it.
const NEARLY: f64 = 0.0625;

/// How exactly the place of a cushion that comes before any ball is said, diamonds.
const SAID_TO: f64 = 0.06;

/// Why a text is no stroke, or none that can be played.
#[derive(Debug, PartialEq, thiserror::Error)]
pub enum SpokenError {
    /// A part means nothing.
    #[error(
        "\"{0}\" is not understood; accepted are \"red 1/2 right\" or \"to 3.2 bottom\", \"1.5 left\", \"2 up\", \"3.5 lengths\" or \
         \"soft\", \"raised 20\" or \"level\", with commas between them"
    )]
    Part(String),
    /// Something is said twice.
    #[error("{0} is said twice, last as \"{1}\"; say it once")]
    Twice(&'static str, String),
    /// The text says nothing at all.
    #[error("no stroke is said; accepted is a text like \"red 1/2 right, 1.5 left, 2 up, 3.5 lengths\"")]
    Nothing,
    /// The ball is the one that is played with.
    #[error("{0} is the cue ball; aim at one of the others")]
    CueBall(CueBall),
    /// Nothing says where to aim.
    #[error(
        "where to aim is missing; say a ball and how full, like \"red 1/2 right\", or the line of the cue, like \"to 3.2 bottom\""
    )]
    NoAim,
    /// How full a ball is to be hit is said, but not on which side.
    #[error("on which side of the ball is missing; say \"right\" or \"left\" behind how full it is hit")]
    NoSide,
    /// Nothing says how hard.
    #[error(
        "how hard is missing; say it in table lengths, like \"3.5 lengths\", in m/s, or as very soft, soft, medium, hard or very hard"
    )]
    NoSpeed,
    /// A speed at which no cue strikes.
    #[error("no stroke on this table makes a ball run {0} lengths; accepted are those of 0.05 to 12 m/s")]
    Lengths(f64),
    /// The ball cannot be met so from where the cue ball lies.
    #[error("{0} cannot be met so: something is in the way, or it is too far to the side")]
    NotMet(&'static str),
    /// An input of the stroke is outside its range.
    #[error(transparent)]
    Cue(#[from] CueError),
    /// The stroke cannot be played here.
    #[error(transparent)]
    Shot(#[from] ShotError),
}

/// How hard a stroke is said to be.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Speed {
    /// Table lengths that a ball runs which is struck so in the middle.
    Lengths(f64),
    /// Speed of the cue, m/s.
    Cue(f64),
}

/// A point on a cushion through which a line is to go.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Mark {
    point: RailPoint,
    /// Whether it is a diamond on the wood, and not the point of the nose in front of it.
    on_wood: bool,
}

/// What a text says of a stroke. What it leaves out is `None`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SpokenStroke {
    /// The ball that is met first, by its place among white, yellow and red.
    colour: Option<usize>,
    /// How much of it is covered, 0 to 1.
    fullness: Option<f64>,
    /// Whether it is met on its left.
    left: Option<bool>,
    /// Where the cue ball meets a cushion that comes before any ball.
    rail: Option<RailPoint>,
    /// Where the cue points.
    to: Option<Mark>,
    /// Where it comes from.
    from: Option<Mark>,
    /// Place of the tip, to the left and up, ball radii.
    side: Option<f64>,
    height: Option<f64>,
    /// The word for the speed, table lengths: a number that stands beside it says more.
    pace: Option<f64>,
    speed: Option<Speed>,
    /// Elevation of the cue, rad.
    elevation: Option<f64>,
}

impl SpokenStroke {
    /// What `text` says. The coach's own words in tips and diamonds are read, too; the way of the cue ball behind the first ball, which
    /// follows from the stroke, is passed over.
    ///
    /// # Errors
    /// What is not understood.
    pub fn read(text: &str) -> Result<Self, SpokenError> {
        read::read(text)
    }

    /// The stroke, for who plays with `cue_ball`. What is not said is as in `before`; without one the cue is level and strikes the
    /// middle. Where rails or balls behind the cue ball are in the way, the cue is raised as far as it must be.
    ///
    /// # Errors
    /// What is missing, or cannot be played where the balls lie.
    pub fn stroke(
        &self,
        table: &Table,
        layout: &Layout,
        cue_ball: CueBall,
        before: Option<&CueInputs>,
    ) -> Result<CueInputs, SpokenError> {
        let speed = match self.speed.or(self.pace.map(Speed::Lengths)) {
            Some(Speed::Cue(speed)) => speed,
            Some(Speed::Lengths(lengths)) => speed_of(table, lengths).ok_or(SpokenError::Lengths(lengths))?,
            None => before.ok_or(SpokenError::NoSpeed)?.speed,
        };
        let level = CueInputs { a: 0.0, b: 0.0, theta: 0.0, phi: 0.0, speed };
        let cue = before.copied().unwrap_or(level);
        let [a, b] = on_ball([self.side.unwrap_or(cue.a), self.height.unwrap_or(cue.b)], table.miscue_limit);
        let cue = CueInputs { a, b, theta: self.elevation.unwrap_or(cue.theta), speed, ..cue };
        cue.validate()?;
        cue.validate_tip(table.miscue_limit)?;
        let at = |phi: f64| {
            let cue = CueInputs { phi, ..cue };
            with_room(table, layout, &cue).unwrap_or(cue)
        };
        let from = layout.balls[0];
        let (to, behind) = (self.to.map(|mark| mark.place(table)), self.from.map(|mark| mark.place(table)));
        let ways = [to.map(|to| to - from), behind.map(|behind| from - behind)];
        if let Some(way) = ways.into_iter().flatten().max_by(|one, other| one.length().total_cmp(&other.length())) {
            return Ok(at(way.to_angle()));
        }
        let ball = self.colour.map(|colour| cue_ball.ordered([0, 1, 2])[colour]);
        if ball == Some(0) {
            return Err(SpokenError::CueBall(cue_ball));
        }
        if let Some(point) = self.rail {
            let way = point.place(table) + table.radius * point.rail.normal() - from;
            let phi = way.to_angle() - squirt(table, cue.a);
            let hit = ball.zip(self.offset().ok());
            // From the cue ball's side a diamond seems the shorter, the flatter the way.
            let half =
                SAID_TO * table.diamond() * way.normalize_or_zero().dot(point.rail.normal()).abs() / way.length();
            return Ok(hit.and_then(|hit| nearest(table, layout, hit, phi, half, at)).unwrap_or_else(|| at(phi)));
        }
        if ball.is_none() && self.fullness.is_none() {
            return before.map(|before| at(before.phi)).ok_or(SpokenError::NoAim);
        }
        let known = before.and_then(|before| aim(table, layout, before).ok()?.hit);
        let ball = ball.or(known.map(|hit| hit.ball)).ok_or(SpokenError::NoAim)?;
        let found = aim_at(table, layout, (ball, self.offset()?), cue.a, at)?;
        found.ok_or(SpokenError::NotMet(cue_ball.names()[ball]))
    }

    /// By how many ball diameters the cue ball's line passes the middle of the ball on its left.
    fn offset(&self) -> Result<f64, SpokenError> {
        let fullness = self.fullness.ok_or(SpokenError::NoAim)?.clamp(GRAZE, 1.0);
        match self.left {
            Some(true) => Ok(1.0 - fullness),
            Some(false) => Ok(fullness - 1.0),
            None if fullness < 1.0 => Err(SpokenError::NoSide),
            None => Ok(0.0),
        }
    }
}

impl Mark {
    /// Where it is on the table, m.
    fn place(self, table: &Table) -> glam::DVec2 {
        let behind = if self.on_wood { BEHIND * table.diamond() } else { 0.0 };
        self.point.place(table) - behind * self.point.rail.normal()
    }
}

/// By how many ball diameters the cue ball's line passes the middle of `ball` on its left in a stroke; `None` where it meets another ball
/// first, or none.
fn passed(table: &Table, layout: &Layout, ball: usize, cue: &CueInputs) -> Result<Option<f64>, ShotError> {
    let hit = aim(table, layout, cue)?.hit.filter(|hit| hit.ball == ball);
    Ok(hit.map(|hit| if hit.left { 1.0 - hit.fullness } else { hit.fullness - 1.0 }))
}

/// Of the strokes in directions up to `half` from `phi`, rad, the one that passes a ball most nearly as is wanted.
fn nearest(
    table: &Table,
    layout: &Layout,
    (ball, wanted): (usize, f64),
    phi: f64,
    half: f64,
    at: impl Fn(f64) -> CueInputs,
) -> Option<CueInputs> {
    let strokes = (-STEPS..=STEPS).map(|step| at(phi + half * f64::from(step) / f64::from(STEPS)));
    let off = |cue: &CueInputs| Some((passed(table, layout, ball, cue).ok()?? - wanted).abs());
    let known = strokes.filter_map(|cue| Some((off(&cue)?, cue)));
    known.min_by(|one, other| one.0.total_cmp(&other.0)).map(|(_, cue)| cue)
}

/// The stroke that meets a ball so that the cue ball's line passes its middle by so many ball diameters on its left, or nearly so; `None` where
/// none was found. Squirt, and the swerve of a raised cue, are in what is tried.
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
    // How far a cue ball swerves is not known beforehand: where the straight way misses, one beside it meets the ball.
    let beside = |step: i32| straight + SWERVE * f64::from(if step % 2 == 0 { step } else { -step }) / lever;
    let Some(mut met) =
        (0..STEPS).map(beside).find(|phi| matches!(passed(table, layout, ball, &at(*phi)), Ok(Some(_))))
    else {
        return Ok(None);
    };
    let mut phi = met;
    for _ in 0..STEPS {
        match passed(table, layout, ball, &at(phi))? {
            Some(passed) if (passed - wanted).abs() < ACCURACY => return Ok(Some(at(phi))),
            Some(passed) => {
                met = phi;
                phi += (wanted - passed) / lever;
            }
            None => phi = 0.5 * (phi + met),
        }
    }
    // Just there the other ball may be in the way: as near as it leaves room.
    let near = nearest(table, layout, (ball, wanted), met, NEARLY / lever, at);
    Ok(near.filter(
        |cue| matches!(passed(table, layout, ball, cue), Ok(Some(passed)) if (passed - wanted).abs() <= NEARLY),
    ))
}

/// The speed of the cue at which a ball runs so many table lengths, m/s.
fn speed_of(table: &Table, lengths: f64) -> Option<f64> {
    let (mut low, mut high) = (0.05, 12.0);
    if !(table_lengths(table, low)?..=table_lengths(table, high)?).contains(&lengths) {
        return None;
    }
    for _ in 0..30 {
        let middle = 0.5 * (low + high);
        if table_lengths(table, middle)? < lengths { low = middle } else { high = middle }
    }
    Some(0.5 * (low + high))
}

/// The place of the tip, radii. One that is told in half tips, as the coach does, may be rounded a little beyond where the tip holds: then it
/// is there.
fn on_ball([a, b]: [f64; 2], limit: f64) -> [f64; 2] {
    let (said, most) = (libm::hypot(a, b), limit.sqrt());
    let is_beyond = a * a + b * b > limit;
    // A little within, so that no rounding of the square is beyond it.
    if is_beyond && said <= most + ROUNDED { [a, b].map(|part| part * (1.0 - 1e-12) * most / said) } else { [a, b] }
}
