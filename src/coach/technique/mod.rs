//! Analysis of a shot: what the cue ball does, and the players' name for it.

mod patterns;

use patterns::BENT;
pub use patterns::{PATTERNS, Pattern};

use serde::Serialize;

use super::{Hit, RailPoint, aim::hit, first_hit};
use crate::{
    game::Tally,
    physics::{BallState, CueInputs},
    simulation::{EventKind, Rail, Recording, ShotError},
    table::{BALLS, Layout, Table},
};

/// A ball within this distance of a cushion is close to it, ball radii: the width of two balls.
const CLOSE: f64 = 4.0;

/// Time before an event at which the state is read, s: at the event's own time the state is already the one after it.
pub const JUST_BEFORE: f64 = 1e-9;

/// Sampling interval of a flight, s: a ball at 8 m/s flies 8 mm in it.
const SAMPLING_INTERVAL: f64 = 0.001;

/// Minimum overlap of the balls, seen from above, for one to count as flown over, m.
const INSIDE: f64 = 0.001;

/// A cushion hit by the cue ball.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Cushion {
    /// The cushion.
    pub rail: Rail,
    /// Position on its nose, in diamonds: 0 to 8 from the left on a long one, 0 to 4 from below on a short one.
    pub diamond: f64,
    /// Incoming speed of the cue ball along the cushion, m/s; positive to the right, or upwards.
    #[serde(skip)]
    pub along: f64,
}

/// What the cue ball does in a shot.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Technique {
    /// The contacts that the rules use.
    pub tally: Tally,
    /// The hit on the first object ball.
    pub first: Option<Hit>,
    /// The hit on the other object ball.
    pub second: Option<Hit>,
    /// Cushions before the first object ball, in order.
    pub before: Vec<Cushion>,
    /// Cushions between the first and the second object ball, in order.
    pub between: Vec<Cushion>,
    /// Cushions that the first object ball hits in the whole shot, in order.
    pub first_ball_rails: Vec<Rail>,
    /// Angle between the cue ball's paths to and from the first ball, rad. The second is measured once it rolls or hits
    /// something.
    pub deflection: f64,
    /// The object ball that the cue ball flies over before its first contact.
    pub over: Option<usize>,
    /// Angle by which the cue ball's path bends until its first contact, rad.
    pub bend: f64,
    /// Topspin or backspin of the cue ball as it hits the first ball, in units of a rolling ball's spin: 1 rolls, 0
    /// slides, negative is backspin.
    pub roll: f64,
    /// Side spin at the first cushion, in units of a rolling ball's spin, R w / v: positive for running english (it
    /// lengthens the rebound), negative for reverse, 0 without a cushion before the second ball.
    pub english: f64,
    /// Whether the first object ball hits the second before the cue ball does.
    pub drives_second: bool,
    /// Whether the first object ball lies close to the last cushion before it.
    pub is_close: bool,
    /// Number of cushions between the balls before the cue ball hits the first ball again; `None` if it does not do so
    /// before the second ball.
    pub rehit_after: Option<usize>,
    /// Largest distance between two balls at the end, m.
    pub spread: f64,
}

impl Technique {
    /// Simulates and analyses a shot.
    ///
    /// # Errors
    /// Fails if the layout or the stroke is invalid.
    pub fn of(table: &Table, layout: &Layout, cue: &CueInputs) -> Result<Self, ShotError> {
        Ok(Self::of_recorded(table, &Recording::new(table, layout, cue)?))
    }

    /// Analyses a recorded shot.
    pub fn of_recorded(table: &Table, recording: &Recording) -> Self {
        let first = first_hit(table, recording);
        let of_first = |ball: usize| first.is_some_and(|hit| hit.ball == ball);
        let events = recording.events().iter();
        let mut technique = Self {
            tally: Tally::from_stroke(table, &Layout::new(recording.positions(0.0)), recording.impulse()),
            first,
            second: first.and_then(|first| hit(table, recording, |ball| ball != first.ball)),
            first_ball_rails: events
                .filter_map(|event| event.kind.rail().filter(|_| of_first(event.kind.balls().0)))
                .collect(),
            over: flown_over(table, recording),
            spread: spread(&recording.final_layout()),
            ..Self::default()
        };
        technique.follow(table, recording);
        technique
    }

    /// Returns the share of the first ball that is covered, seen along the cue ball's path: 1 is head-on, 0 a graze or
    /// no ball.
    pub fn fullness(&self) -> f64 {
        self.first.map_or(0.0, |hit| hit.fullness)
    }

    /// Whether the cue ball flies over a ball, or its path bends as a massé's does, before its first contact.
    pub fn is_jump_or_masse(&self) -> bool {
        self.over.is_some() || self.bend > BENT
    }

    /// Follows the cue ball up to the second object ball.
    fn follow(&mut self, table: &Table, recording: &Recording) {
        let (mut first, mut incoming, mut has_touched) = (None, None, false);
        for event in recording.events() {
            let counted = self.tally.cushions;
            self.tally.count(event);
            let before = recording.state(0, event.time - JUST_BEFORE);
            if let (Some(way), true) = (incoming, event.kind.balls().0 == 0) {
                self.deflection = before.velocity.angle_to(way).abs();
                incoming = None;
            }
            let touches = match event.kind {
                EventKind::BallBall(0, _) | EventKind::BallRail(0, _) => true,
                EventKind::ContactBegins(ball) => ball == 0,
                _ => false,
            };
            if !has_touched && touches {
                has_touched = true;
                // A turn at a ball or cushion that touches from the start is not a bend of the path.
                if event.time > JUST_BEFORE {
                    self.bend = recording.impulse().velocity.angle_to(before.velocity).abs();
                }
            }
            match event.kind {
                EventKind::BallBall(1, 2) => self.drives_second = true,
                EventKind::BallBall(0, ball) if first.is_none() => {
                    first = Some(ball);
                    incoming = Some(before.velocity);
                    let ahead = before.velocity.normalize_or_zero();
                    let gaps = table.reach() - recording.state(ball, event.time).position.abs();
                    let is_close = |cushion: &Cushion| gaps.dot(cushion.rail.normal().abs()) < CLOSE * table.radius;
                    self.is_close = self.before.last().is_some_and(is_close);
                    self.roll = table.radius * before.spin.truncate().dot(ahead.perp()) / before.velocity.length();
                }
                EventKind::BallBall(0, ball) if first == Some(ball) => {
                    self.rehit_after.get_or_insert(self.between.len());
                }
                EventKind::BallRail(0, rail) if self.tally.cushions > counted => {
                    let along = before.velocity.dot(rail.normal().perp().abs());
                    if self.before.is_empty() && self.between.is_empty() {
                        self.english = english(table, &before, rail);
                    }
                    let RailPoint { diamond, .. } = RailPoint::on(table, rail, before.position);
                    let cushion = Cushion { rail, diamond, along };
                    if first.is_none() { &mut self.before } else { &mut self.between }.push(cushion);
                }
                _ => {}
            }
            if self.tally.has_hit_both() {
                break;
            }
        }
    }
}

/// Returns the side spin of a ball that approaches a cushion, in units of a rolling ball's spin, R w / v: positive for
/// running, negative for reverse english. It is 1 for a ball that rolls along the cushion without slip.
pub fn english(table: &Table, ball: &BallState, rail: Rail) -> f64 {
    let turning = ball.velocity.dot(rail.normal().perp()).signum();
    table.radius * ball.spin.z * turning / ball.velocity.length()
}

/// Finds the first object ball, or the edge of one, that the cue ball passes in the air before its first contact.
fn flown_over(table: &Table, recording: &Recording) -> Option<usize> {
    let is_contact = |kind| matches!(kind, EventKind::BallBall(0, _) | EventKind::BallRail(0, _));
    let first = recording.events().iter().find(|event| is_contact(event.kind));
    let until = first.map_or(recording.duration(), |event| event.time);
    let reach = 2.0 * table.radius - INSIDE;
    let of_cue_ball = recording.jumps().into_iter().filter(|jump| jump.ball == 0 && jump.is_reported());
    of_cue_ball.filter(|jump| jump.start < until).find_map(|jump| {
        let end = jump.end.min(until);
        let samples = ((end - jump.start) / SAMPLING_INTERVAL).ceil() as usize;
        (0..=samples).map(|sample| (jump.start + SAMPLING_INTERVAL * sample as f64).min(end)).find_map(|time| {
            let places = recording.positions(time);
            let is_below = |ball: &usize| places[0].distance(places[*ball]) < reach;
            // A ball on which it lands is not flown over.
            let is_met = |ball: usize| {
                until <= jump.end && first.is_some_and(|event| event.kind == EventKind::BallBall(0, ball))
            };
            (1..BALLS).filter(is_below).find(|&ball| !is_met(ball))
        })
    })
}

/// Returns the largest distance between two balls, m.
fn spread(layout: &Layout) -> f64 {
    let [a, b, c] = layout.balls;
    a.distance(b).max(a.distance(c)).max(b.distance(c))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn technique(layout: &str, cue: &str) -> Technique {
        technique_on(&Table::default(), layout, cue)
    }

    fn technique_on(table: &Table, layout: &str, cue: &str) -> Technique {
        let layout = Layout::parse(layout, table).unwrap();
        Technique::of(table, &layout, &CueInputs::parse(cue).unwrap()).unwrap()
    }

    #[test]
    fn jump_requires_flight_over_a_ball_before_first_contact() {
        let name = |technique: &Technique| Pattern::of(technique).map(|pattern| pattern.name);
        let over = technique("-0.5,0 -0.2,0 0.52,-0.02", "0,0,45,-1,5");
        assert_eq!((over.over, over.first.map(|hit| hit.ball), name(&over)), (Some(1), Some(2), Some("jump")));
        let missed = technique("-0.5,0 -0.2,0 0.5,0.02", "0,0,45,0,6");
        assert_eq!((missed.over, missed.first.map(|hit| hit.ball), name(&missed)), (Some(1), Some(2), None));
        let edge = technique("-0.5,0 -0.2,0.05 0.5,0.02", "0,0,45,0,6");
        assert_eq!(edge.over, Some(1));
        let beside = technique("-0.5,0 -0.2,0.07 0.5,0.02", "0,0,45,0,6");
        assert!(beside.over.is_none() && name(&beside) != Some("jump"), "{beside:?}");
        // The cue ball lands on the first ball; nothing is flown over.
        let onto = technique("-0.5,0 -0.2,0 0.5,0.02", "0,0,20,0,6");
        assert!(onto.first.is_some_and(|hit| hit.ball == 1) && onto.over.is_none(), "{onto:?}");
        let (layout, cue) = ("-0.5,0 -0.2,0 0.5,0.02", "0,0,45,0,6");
        let frozen = technique_on(&Table { flight: None, ..Table::default() }, layout, cue);
        assert_eq!(frozen.over, None, "on a table that keeps its balls");
    }

    #[test]
    fn bank_shot_distinguishes_running_and_reverse_english() {
        // Up and to the right into the upper long cushion: a ball that rolls along it turns counter-clockwise, as with a < 0.
        let bank = |a: &str| technique("-1,-0.5 1.3,-0.5 1.3,0.5", &format!("{a},0,0,45,3"));
        let (running, reverse) = (bank("-0.3"), bank("0.3"));
        assert!(running.english > 0.3 && reverse.english < -0.3, "{} {}", running.english, reverse.english);
        assert_eq!(running.before.first().map(|cushion| cushion.rail), Some(Rail::Top));
        assert!(running.before[0].along > 0.0 && running.bend < 0.01);
        assert_eq!(running.first, None);
    }

    #[test]
    fn rehit_of_first_ball_counts_cushions_in_between() {
        // The red ball rebounds from the short rail and hits the cue ball that follows it.
        let twice = technique("0.9,0 1.2,0 -1,0.5", "0,0.5,2,0.2,3");
        assert_eq!((twice.rehit_after, twice.first.map(|hit| hit.ball)), (Some(0), Some(1)));
        assert_eq!(technique("-0.3,0 0,0 -1,0.3", "0,-0.4,2,0.3,3").rehit_after, None);
    }

    #[test]
    fn full_hit_distinguishes_draw_from_follow() {
        let drawn = technique("-0.3,0 0,0 -1,0.3", "0,-0.4,2,0.3,3");
        let followed = technique("-0.3,0 0,0 -1,0.3", "0,0.4,2,0.3,3");
        assert!(drawn.deflection > 2.5 && followed.deflection < 0.6, "{} {}", drawn.deflection, followed.deflection);
        assert!(drawn.fullness() > 0.9 && drawn.roll < -0.5 && followed.roll > 0.5, "{drawn:?} {followed:?}");
    }

    #[test]
    fn missed_second_ball_has_no_pattern() {
        let is_called = |second: &str| {
            let shot = technique(&format!("-0.3,0 0,0 {second}"), "0,0.4,2,0.3,3");
            (shot.second.is_some(), Pattern::of(&shot).is_some())
        };
        assert_eq!((is_called("-1,0.3"), is_called("-1,0.6")), ((true, true), (false, false)));
    }

    #[test]
    fn red_can_be_the_first_ball() {
        let red = technique("-0.3,0 -1,0.3 0,0", "0,0.4,2,0.3,3");
        assert!(red.first.is_some_and(|hit| hit.ball == 2));
        assert!(red.first_ball_rails.contains(&Rail::Right), "{red:?}");
    }

    #[test]
    fn three_cushion_pattern_mentions_additional_cushions() {
        let bank = technique("-1,-0.5 1.3,-0.5 1.3,0.5", "-0.3,0,0,45,3");
        let with = |many| Technique { between: vec![bank.before[0]; many], before: Vec::new(), ..bank.clone() };
        let called = |name: &str| PATTERNS.iter().find(|pattern| pattern.name == name).unwrap();
        let natural = called("natural");
        assert_eq!(natural.course_of(&with(3)), natural.course);
        assert_eq!(natural.course_of(&with(5)), format!("{}; here 5 cushions in all", natural.course));
        let around = called("around the table");
        assert_eq!(around.course_of(&with(5)), around.course);
    }

    #[test]
    fn steep_cue_with_side_bends_the_path() {
        let bent = technique("-0.3,-0.3 0.5,0.5 1,0.3", "0.3,-0.2,60,0,3");
        assert!(bent.bend > 0.2, "{}", bent.bend);
    }
}
