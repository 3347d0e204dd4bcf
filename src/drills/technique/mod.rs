//! What a shot does on the table.

mod flaws;
mod patterns;

pub use flaws::{GATHERED, flaws};
pub use patterns::{PATTERNS, Pattern};

use crate::{
    coach::first_hit,
    game::Tally,
    physics::CueInputs,
    simulation::{EventKind, Rail, Recording, ShotError},
    table::{Layout, Table},
};

/// What the cue ball does in a shot.
#[derive(Clone, Debug, PartialEq)]
pub struct Technique {
    /// What the rules look at.
    pub tally: Tally,
    /// The object ball that is met first.
    pub first: Option<usize>,
    /// Cushions before it, in order.
    pub before: Vec<Rail>,
    /// Cushions between the first and the second object ball, in order.
    pub between: Vec<Rail>,
    /// Cushions that yellow meets in the whole shot, in order.
    pub sent: Vec<Rail>,
    /// How much of the first ball is covered as the cue ball comes on: 1 is head-on, 0 a graze.
    pub fullness: f64,
    /// Angle between the cue ball's way to the first ball and its way from there, once it rolls or meets something, rad.
    pub turn: f64,
    /// Side spin at the first cushion in units of a rolling ball's spin, R w / v: positive where it is running (the rebound is
    /// longer for it), negative where it is reverse, 0 without a cushion before the second ball.
    pub english: f64,
    /// Whether the first ball touches the second before the cue ball is there.
    pub drives_second: bool,
    /// Whether the cue ball meets the first ball once only before the second.
    pub is_clean: bool,
    /// Largest distance of two balls at the end, m.
    pub spread: f64,
}

impl Technique {
    /// What the cue ball does in this shot.
    ///
    /// # Errors
    /// What is wrong with the layout or the stroke.
    pub fn of(table: &Table, layout: &Layout, cue: &CueInputs) -> Result<Self, ShotError> {
        let recording = Recording::new(table, layout, cue)?;
        let mut technique = Self {
            tally: Tally::default(),
            first: None,
            before: Vec::new(),
            between: Vec::new(),
            sent: recording
                .events()
                .iter()
                .filter_map(|event| event.kind.rail().filter(|_| event.kind.balls().0 == 1))
                .collect(),
            fullness: first_hit(table, &recording).map_or(0.0, |hit| hit.fullness),
            turn: 0.0,
            english: 0.0,
            drives_second: false,
            is_clean: true,
            spread: spread(&recording.final_layout()),
        };
        technique.follow(table, &recording);
        Ok(technique)
    }

    /// Follows the cue ball up to the second object ball.
    fn follow(&mut self, table: &Table, recording: &Recording) {
        let mut incoming = None;
        for event in recording.events() {
            self.tally.note(event);
            // At its own time an event has already changed the course.
            let before = recording.state(0, event.time - 1e-9);
            if let (Some(way), true) = (incoming, event.kind.balls().0 == 0) {
                self.turn = before.velocity.angle_to(way).abs();
                incoming = None;
            }
            match event.kind {
                EventKind::BallBall(1, 2) => self.drives_second = true,
                EventKind::BallBall(0, ball) if self.first.is_none() => {
                    self.first = Some(ball);
                    incoming = Some(before.velocity);
                }
                EventKind::BallBall(0, ball) if self.first == Some(ball) => self.is_clean = false,
                EventKind::BallRail(0, rail) => {
                    if self.before.is_empty() && self.between.is_empty() {
                        // A ball that rolls along the cushion as on a track has an english of 1.
                        let along = before.velocity.dot(rail.normal().perp());
                        self.english = table.radius * before.spin.z * along.signum() / before.velocity.length();
                    }
                    if self.first.is_none() { &mut self.before } else { &mut self.between }.push(rail);
                }
                _ => {}
            }
            if self.tally.met_both() {
                break;
            }
        }
    }
}

/// Largest distance of two balls, m.
fn spread(layout: &Layout) -> f64 {
    let [a, b, c] = layout.balls;
    a.distance(b).max(a.distance(c)).max(b.distance(c))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn technique(layout: &str, cue: &str) -> Technique {
        let table = Table::default();
        let layout = Layout::parse(layout, &table).unwrap();
        Technique::of(&table, &layout, &CueInputs::parse(cue).unwrap()).unwrap()
    }

    #[test]
    fn the_course_and_the_side_are_told_apart_by_hand_made_shots() {
        // Up and to the right into the upper long cushion: a ball that rolls along it turns counter-clockwise, as a < 0 does.
        let bank = |a: &str| technique("-1,-0.5 1.3,-0.5 1.3,0.5", &format!("{a},0,0,45,3"));
        let (running, reverse) = (bank("-0.3"), bank("0.3"));
        assert!(running.english > 0.3 && reverse.english < -0.3, "{} {}", running.english, reverse.english);
        assert_eq!(running.before.first(), Some(&Rail::Top));
        assert_eq!(running.first, None);
    }

    #[test]
    fn a_full_ball_is_drawn_back_and_followed_through() {
        let drawn = technique("-0.3,0 0,0 -1,0.3", "0,-0.4,2,0.3,3");
        let followed = technique("-0.3,0 0,0 -1,0.3", "0,0.4,2,0.3,3");
        assert!(drawn.turn > 2.5 && followed.turn < 0.6, "{} {}", drawn.turn, followed.turn);
        assert!(drawn.fullness > 0.9);
    }
}
