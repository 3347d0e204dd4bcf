//! Where to aim, as players say it: how full the first ball is hit, and where the line of aim meets the cushions.

use glam::DVec2;
use serde::Serialize;

use crate::{
    physics::CueInputs,
    simulation::{EventKind, Rail, Recording, ShotError},
    table::{Layout, Table},
};

/// Where a line meets a cushion.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct RailPoint {
    /// The cushion.
    pub rail: Rail,
    /// How far along it, in diamonds: 0 to 8 from the left on a long one, 0 to 4 from below on a short one.
    pub diamond: f64,
}

impl RailPoint {
    /// The point of a cushion's nose that is next to `place`, m.
    pub fn on(table: &Table, rail: Rail, place: DVec2) -> Self {
        let along = match rail {
            Rail::Left | Rail::Right => place.y + 0.5 * table.width,
            Rail::Bottom | Rail::Top => place.x + 0.5 * table.length,
        };
        Self { rail, diamond: along / table.diamond() }
    }

    /// Where it is on the table, m.
    pub fn place(self, table: &Table) -> DVec2 {
        let half = 0.5 * DVec2::new(table.length, table.width);
        let along = self.diamond * table.diamond();
        match self.rail {
            Rail::Left => DVec2::new(-half.x, along - half.y),
            Rail::Right => DVec2::new(half.x, along - half.y),
            Rail::Bottom => DVec2::new(along - half.x, -half.y),
            Rail::Top => DVec2::new(along - half.x, half.y),
        }
    }
}

/// How the cue ball meets the first object ball.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Hit {
    /// The object ball, 1 or 2.
    pub ball: usize,
    /// Where the cue ball's centre is then, m.
    #[serde(skip)]
    pub place: DVec2,
    /// How much of the object ball is covered as the cue ball comes on: 1 is head-on, 0 a graze.
    pub fullness: f64,
    /// Whether it is its left half that is hit, as the cue ball comes on.
    pub left: bool,
}

impl Hit {
    /// From this fullness on it is told as 100 %.
    const HEAD_ON: f64 = 0.995;

    /// Which half of the object ball is hit, as the cue ball comes on; head-on has no side.
    pub fn side(&self) -> Option<&'static str> {
        let side = if self.left { "left" } else { "right" };
        (self.fullness < Self::HEAD_ON).then_some(side)
    }
}

/// Below this share of the ball covered it is hit thin. A half-ball hit lies between this and [`THICK`].
pub const THIN: f64 = 0.41;

/// From this share on it is hit thick.
pub const THICK: f64 = 0.6;

/// From this share on it is hit so full that a rolling ball goes on ahead.
pub const FULL: f64 = 0.85;

/// The aim of a stroke.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Aim {
    /// Where the cue points.
    pub ahead: RailPoint,
    /// Where the cue comes from: the line of aim in the other direction.
    pub behind: RailPoint,
    /// The first object ball; `None` where none is met.
    pub hit: Option<Hit>,
}

/// The aim of a stroke.
///
/// # Errors
/// What is wrong with the layout or the stroke.
pub fn aim(table: &Table, layout: &Layout, cue: &CueInputs) -> Result<Aim, ShotError> {
    let recording = Recording::new(table, layout, cue)?;
    let [ahead, behind] = line_of_aim(table, layout, cue.phi);
    Ok(Aim { ahead, behind, hit: first_hit(table, &recording) })
}

/// Where a cue points in the direction `phi`, rad, and where it comes from: the line of aim meets the cushions there, ahead
/// and behind.
pub fn line_of_aim(table: &Table, layout: &Layout, phi: f64) -> [RailPoint; 2] {
    let [from, direction] = [layout.balls[0], DVec2::from_angle(phi)];
    [rail_point(table, from, direction), rail_point(table, from, -direction)]
}

/// Where the line from a place on the table in a direction meets the noses of the cushions.
fn rail_point(table: &Table, from: DVec2, direction: DVec2) -> RailPoint {
    let half = 0.5 * DVec2::new(table.length, table.width);
    let distance = |rail: Rail| {
        let inward = rail.normal();
        let approach = -direction.dot(inward);
        // A line along a cushion never meets it.
        if approach > 1e-12 { (from.dot(inward) + half.dot(inward.abs())) / approach } else { f64::INFINITY }
    };
    let rail = Rail::ALL.into_iter().min_by(|a, b| distance(*a).total_cmp(&distance(*b))).unwrap_or(Rail::Left);
    RailPoint::on(table, rail, from + distance(rail) * direction)
}

/// How the cue ball meets the first object ball of a recorded shot; `None` where it meets none.
pub fn first_hit(table: &Table, recording: &Recording) -> Option<Hit> {
    hit(table, recording, |_| true)
}

/// How the cue ball first meets one of the object balls that are `wanted`; `None` where it meets none of them.
pub fn hit(table: &Table, recording: &Recording, wanted: impl Fn(usize) -> bool) -> Option<Hit> {
    let (time, ball) = recording.events().iter().find_map(|event| match event.kind {
        EventKind::BallBall(0, ball) if wanted(ball) => Some((event.time, ball)),
        _ => None,
    })?;
    let place = recording.state(0, time).position;
    let towards = recording.state(ball, time).position - place;
    // Just before the impact: at its time the recording already holds the velocities after it.
    let before = (0.999 * time).max(time - 1e-4);
    // A ball that touches from the start is met in the direction of the stroke.
    let line =
        (place - recording.state(0, before).position).normalize_or(recording.impulse().velocity.normalize_or_zero());
    let offset = line.perp_dot(towards) / (2.0 * table.radius);
    Some(Hit { ball, place, fullness: (1.0 - offset.abs()).max(0.0), left: offset < 0.0 })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_are_counted_in_diamonds_from_the_lower_left_corner() {
        let table = Table::default();
        let layout = Layout::parse("2d,2d 7d,3.5d 1d,0.5d", &table).unwrap();
        let aim = |phi: f64| {
            let cue = CueInputs { a: 0.0, b: 0.0, theta: 0.0, phi: phi.to_radians(), speed: 3.0 };
            super::aim(&table, &layout, &cue).unwrap()
        };
        // Two diamonds up and two to the right meet the upper cushion at 4; back from there the lower left corner.
        let diagonal = aim(45.0);
        assert_eq!(diagonal.ahead.rail, Rail::Top);
        assert!((diagonal.ahead.diamond - 4.0).abs() < 1e-9 && diagonal.behind.diamond.abs() < 1e-9);
        let level = aim(0.0);
        assert_eq!((level.ahead.rail, level.behind.rail), (Rail::Right, Rail::Left));
        assert!((level.ahead.diamond - 2.0).abs() < 1e-9);
    }

    #[test]
    fn a_ball_half_a_diameter_off_the_line_is_hit_half() {
        let table = Table::default();
        let layout = Layout::parse("-0.7,0 0,-0.03075 0.9,0.5", &table).unwrap();
        let hit = aim(&table, &layout, &CueInputs::parse("0,0,0,0,3").unwrap()).unwrap().hit.unwrap();
        assert_eq!(hit.ball, 1);
        assert!((hit.fullness - 0.5).abs() < 0.01 && hit.left, "{hit:?}");
        assert_eq!(hit.side(), Some("left"));
        let of = |fullness| Hit { fullness, left: false, ..hit }.side();
        assert_eq!([0.0, 0.994, 0.995, 1.0].map(of), [Some("right"), Some("right"), None, None]);
    }
}
