//! Side view of a jump: the ball's height over the distance, and the obstacles that it passes.

use crate::{
    simulation::{EventKind, Jump, REPORTED_HEIGHT, Rail, Recording},
    table::{BALLS, Table},
};

/// Number of samples of the flight; twice the sub-pixels of the widest picture.
const SAMPLES: u32 = 600;
/// Length of the shown path, relative to the end of the last visible hop.
const SHOWN_LENGTH: f64 = 1.04;

/// An obstacle that the ball flies over or against.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Obstacle {
    /// A ball.
    Ball(usize),
    /// A cushion nose.
    Nose(Rail),
}

/// An obstacle at the point where the ball passes it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PassedObstacle {
    /// The obstacle.
    pub obstacle: Obstacle,
    /// Distance along the path, m.
    pub distance: f64,
    /// Height of its top above the cloth, m.
    pub top: f64,
}

/// A sample of the flight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Time, s.
    pub time: f64,
    /// Distance along the cloth since the ball left it, m.
    pub distance: f64,
    /// Height of the ball's lowest point above the cloth, m.
    pub height: f64,
}

/// Side view of a jump.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    /// The jump.
    pub jump: Jump,
    /// The samples in order of time; never empty.
    pub points: Vec<Point>,
    /// The obstacles in order of distance.
    pub passed: Vec<PassedObstacle>,
}

impl Profile {
    /// The highest jump of the cue ball, or of another ball if the cue ball does not jump. `None` if no jump is high enough to report.
    pub fn of(table: &Table, recording: &Recording) -> Option<Self> {
        let visible = recording.jumps().into_iter().filter(Jump::is_reported);
        let order = |jump: &Jump| (jump.ball == 0, jump.height);
        let jump = visible.max_by(|one, other| {
            let ((cue_ball, height), (is_other, other)) = (order(one), order(other));
            cue_ball.cmp(&is_other).then(height.total_cmp(&other))
        })?;
        let whole = points(recording, &jump, jump.end);
        let last = whole.iter().rfind(|point| point.height >= REPORTED_HEIGHT)?.time;
        let end = (jump.start + SHOWN_LENGTH * (last - jump.start)).min(jump.end);
        let points = points(recording, &jump, end);
        let mut passed = balls(table, recording, &jump, &points);
        passed.extend(noses(table, recording, &Jump { end, ..jump }, &points));
        passed.sort_by(|one, other| one.distance.total_cmp(&other.distance));
        Some(Self { jump, points, passed })
    }

    /// Length of the path, m.
    pub fn length(&self) -> f64 {
        self.points.last().map_or(0.0, |point| point.distance)
    }

    /// The sample at `time`, s; `None` before and after the flight.
    pub fn at(&self, time: f64) -> Option<Point> {
        let after = self.points.partition_point(|point| point.time < time);
        self.points.get(after).copied().filter(|point| after > 0 || point.time == time)
    }

    /// Height of the highest thing in the picture, m.
    pub fn top(&self) -> f64 {
        self.passed.iter().map(|passed| passed.top).fold(self.jump.height, f64::max)
    }
}

/// Samples of the flight up to `end`, s, equally spaced in time.
fn points(recording: &Recording, jump: &Jump, end: f64) -> Vec<Point> {
    let (mut distance, mut last) = (0.0, recording.state(jump.ball, jump.start).position);
    let times = (0..=SAMPLES).map(|sample| jump.start + (end - jump.start) * f64::from(sample) / f64::from(SAMPLES));
    times
        .map(|time| {
            let place = recording.state(jump.ball, time).position;
            distance += place.distance(last);
            last = place;
            Point { time, distance, height: recording.height(jump.ball, time) }
        })
        .collect()
}

/// The balls that the ball flies over or against, each at the smallest distance.
fn balls(table: &Table, recording: &Recording, jump: &Jump, points: &[Point]) -> Vec<PassedObstacle> {
    let others = (0..BALLS).filter(|&other| other != jump.ball);
    let nearest = |other: usize| {
        let gap = |point: &Point| {
            let places = recording.positions(point.time);
            places[jump.ball].distance(places[other])
        };
        let gaps = points.iter().map(|point| (gap(point), point));
        // At a contact, the nearest sample may be slightly too early or too late.
        let (gap, point) = gaps.min_by(|one, two| one.0.total_cmp(&two.0))?;
        let is_passed = gap < 2.05 * table.radius;
        let top = recording.height(other, point.time) + 2.0 * table.radius;
        is_passed.then_some(PassedObstacle { obstacle: Obstacle::Ball(other), distance: point.distance, top })
    };
    others.filter_map(nearest).collect()
}

/// The noses that the ball hits or flies over.
fn noses(table: &Table, recording: &Recording, jump: &Jump, points: &[Point]) -> Vec<PassedObstacle> {
    let top = |rail: Rail| table.rail.overrides(rail).height.or(table.rail.height).unwrap_or(table.radius);
    recording
        .events()
        .iter()
        .filter(|event| jump.is_airborne_at(event.time))
        .filter_map(|event| match event.kind {
            EventKind::BallRail(ball, rail) if ball == jump.ball => Some((rail, event.time)),
            EventKind::LeavesTable(ball) if ball == jump.ball => {
                let over = recording.left_table(table)[ball]?.over;
                let beyond = |point: &&Point| {
                    let place = recording.state(ball, point.time).position;
                    match over {
                        Rail::Left | Rail::Right => place.x.abs() >= 0.5 * table.length,
                        Rail::Bottom | Rail::Top => place.y.abs() >= 0.5 * table.width,
                    }
                };
                Some((over, points.iter().find(beyond).map_or(event.time, |point| point.time)))
            }
            _ => None,
        })
        .filter_map(|(rail, time)| {
            // Rounding may put the last sample just before the end.
            let point = points.iter().find(|point| point.time >= time).or(points.last())?;
            Some(PassedObstacle { obstacle: Obstacle::Nose(rail), distance: point.distance, top: top(rail) })
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{physics::CueInputs, table::Layout};

    fn profile(layout: &str, cue: &str) -> Option<Profile> {
        let table = Table::default();
        let layout = Layout::parse(layout, &table).unwrap();
        let recording = Recording::new(&table, &layout, &CueInputs::parse(cue).unwrap()).unwrap();
        Profile::of(&table, &recording)
    }

    #[test]
    fn a_jump_over_a_ball_shows_the_ball_below_the_course() {
        let profile = profile("-0.5,0 -0.2,0 0.9,0.5", "0,0,45,0,6").unwrap();
        let [passed] = profile.passed[..] else { panic!("{:?}", profile.passed) };
        assert_eq!(passed.obstacle, Obstacle::Ball(1));
        assert!((passed.distance - 0.3).abs() < 0.01 && passed.top == 2.0 * Table::default().radius, "{passed:?}");
        let over = profile.points.iter().find(|point| point.distance >= passed.distance).unwrap();
        assert!(over.height > passed.top, "{over:?}");
        let highest = profile.points.iter().map(|point| point.height).fold(0.0, f64::max);
        assert!((highest - profile.jump.height).abs() < 0.01 * highest);
        assert_eq!(profile.at(profile.jump.start).map(|point| point.distance), Some(0.0));
        assert_eq!(profile.at(60.0), None);
    }

    #[test]
    fn a_ball_that_leaves_the_table_passes_the_nose_above_it() {
        let profile = profile("0.9,0 0,0.3 0,-0.3", "0,0,30,0,9").unwrap();
        let nose = profile.passed.iter().find(|passed| passed.obstacle == Obstacle::Nose(Rail::Right)).unwrap();
        assert!((nose.distance - (0.5 * Table::default().length - 0.9)).abs() < 0.05, "{nose:?}");
        let over = profile.points.iter().find(|point| point.distance >= nose.distance).unwrap();
        assert!(over.height > 0.0, "{over:?}");
    }

    #[test]
    fn invisible_hops_have_no_side_view() {
        assert_eq!(profile("-1,0 0.9,-0.5 0.9,0.5", "0,0,3,0,4"), None);
    }
}
