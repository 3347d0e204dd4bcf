//! Aiming data in players' terms: the fullness of the hit on the first ball, and where the line of aim meets the cushions.

use glam::DVec2;
use serde::Serialize;

use crate::{
    physics::CueInputs,
    simulation::{EventKind, Rail, Recording, ShotError},
    table::{Layout, Table},
};

/// A point on a cushion.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct RailPoint {
    /// The cushion.
    pub rail: Rail,
    /// Position along the cushion, in diamonds: 0 to 8 from the left on a long one, 0 to 4 from below on a short one.
    pub diamond: f64,
}

impl RailPoint {
    /// Returns the point of a cushion's nose nearest to `place`, m.
    pub fn on(table: &Table, rail: Rail, place: DVec2) -> Self {
        let along = match rail {
            Rail::Left | Rail::Right => place.y + 0.5 * table.width,
            Rail::Bottom | Rail::Top => place.x + 0.5 * table.length,
        };
        Self { rail, diamond: along / table.diamond() }
    }

    /// Returns the position of the point on the table, m.
    pub fn position(self, table: &Table) -> DVec2 {
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

/// How the cue ball hits an object ball.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Hit {
    /// The object ball, 1 or 2.
    pub ball: usize,
    /// Position of the cue ball's centre at that moment, m.
    #[serde(skip)]
    pub place: DVec2,
    /// Share of the object ball that is covered, seen along the cue ball's path: 1 is head-on, 0 a graze.
    pub fullness: f64,
    /// Whether the object ball's left half is hit, seen along the cue ball's path.
    pub left: bool,
}

impl Hit {
    /// From this fullness on the hit is displayed as 100 %.
    const HEAD_ON: f64 = 0.995;

    /// Returns the half of the object ball that is hit, seen along the cue ball's path; `None` for a head-on hit.
    pub fn side(&self) -> Option<&'static str> {
        let side = if self.left { "left" } else { "right" };
        (self.fullness < Self::HEAD_ON).then_some(side)
    }
}

/// Below this fullness a ball is hit thin. A half-ball hit lies between this and [`THICK`].
pub const THIN: f64 = 0.41;

/// From this fullness on a ball is hit thick.
pub const THICK: f64 = 0.6;

/// From this fullness on, a rolling cue ball follows the object ball.
pub const FULL: f64 = 0.85;

/// The aim of a stroke.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Aim {
    /// The point at which the cue is aimed.
    pub ahead: RailPoint,
    /// The point on the other side, behind the cue ball, on the same line.
    pub behind: RailPoint,
    /// The hit on the first object ball; `None` if none is hit.
    pub hit: Option<Hit>,
}

/// Computes the aim of a stroke by simulating it.
///
/// # Errors
/// Fails if the layout or the stroke is invalid.
pub fn aim(table: &Table, layout: &Layout, cue: &CueInputs) -> Result<Aim, ShotError> {
    let recording = Recording::new(table, layout, cue)?;
    let [ahead, behind] = line_of_aim(table, layout, cue.phi);
    Ok(Aim { ahead, behind, hit: first_hit(table, &recording) })
}

/// Returns where the line of aim in direction `phi`, rad, meets the cushions: ahead of the cue ball and behind it.
pub fn line_of_aim(table: &Table, layout: &Layout, phi: f64) -> [RailPoint; 2] {
    let [from, direction] = [layout.balls[0], DVec2::from_angle(phi)];
    [rail_point(table, from, direction), rail_point(table, from, -direction)]
}

/// Returns where a ray from a position on the table meets the noses of the cushions.
fn rail_point(table: &Table, from: DVec2, direction: DVec2) -> RailPoint {
    let half = 0.5 * DVec2::new(table.length, table.width);
    let distance = |rail: Rail| {
        let approach = -direction.dot(rail.normal());
        // A line parallel to a cushion never meets it.
        if approach > 1e-12 { rail.gap(half, from) / approach } else { f64::INFINITY }
    };
    let rail = Rail::ALL.into_iter().min_by(|a, b| distance(*a).total_cmp(&distance(*b))).unwrap_or(Rail::Left);
    RailPoint::on(table, rail, from + distance(rail) * direction)
}

/// Returns the cue ball's hit on the first object ball of a recorded shot; `None` if it hits none.
pub fn first_hit(table: &Table, recording: &Recording) -> Option<Hit> {
    hit(table, recording, |_| true)
}

/// Returns the cue ball's first hit on one of the object balls that are `wanted`; `None` if it hits none of them.
pub fn hit(table: &Table, recording: &Recording, wanted: impl Fn(usize) -> bool) -> Option<Hit> {
    let (time, ball) = recording.events().iter().find_map(|event| match event.kind {
        EventKind::BallBall(0, ball) if wanted(ball) => Some((event.time, ball)),
        _ => None,
    })?;
    let place = recording.state(0, time).position;
    let towards = recording.state(ball, time).position - place;
    // Just before the impact: at its own time the recording already has the velocities after it.
    let before = (0.999 * time).max(time - 1e-4);
    // A ball that touches the cue ball from the start is hit in the direction of the stroke.
    let line =
        (place - recording.state(0, before).position).normalize_or(recording.impulse().velocity.normalize_or_zero());
    let offset = line.perp_dot(towards) / (2.0 * table.radius);
    Some(Hit { ball, place, fullness: (1.0 - offset.abs()).max(0.0), left: offset < 0.0 })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rail_points_are_counted_from_the_lower_left_corner() {
        let table = Table::default();
        let layout = Layout::parse("2d,2d 7d,3.5d 1d,0.5d", &table).unwrap();
        let aim = |phi: f64| {
            let cue = CueInputs { a: 0.0, b: 0.0, theta: 0.0, phi: phi.to_radians(), speed: 3.0 };
            super::aim(&table, &layout, &cue).unwrap()
        };
        // Two diamonds up and two to the right, the line meets the upper cushion at 4; backwards it meets the lower
        // left corner.
        let diagonal = aim(45.0);
        assert_eq!(diagonal.ahead.rail, Rail::Top);
        assert!((diagonal.ahead.diamond - 4.0).abs() < 1e-9 && diagonal.behind.diamond.abs() < 1e-9);
        let level = aim(0.0);
        assert_eq!((level.ahead.rail, level.behind.rail), (Rail::Right, Rail::Left));
        assert!((level.ahead.diamond - 2.0).abs() < 1e-9);
    }

    #[test]
    fn half_diameter_offset_is_a_half_ball_hit() {
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
