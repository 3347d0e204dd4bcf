//! The three cushions in a row that a shot's cue ball takes: what systems speak of.

use glam::DVec2;

use super::lines::{Line, diamonds};
use crate::{
    coach::incoming::{JUST_BEFORE, english},
    physics::Impulse,
    simulation::{EventKind, Rail, Recording},
    table::Table,
};

/// Three cushions in a row with no ball between.
#[derive(Clone, Debug)]
pub struct Leg {
    /// Where the cue ball came from: the stroke, or the first object ball. The centre of the ball, in diamonds.
    pub from: DVec2,
    /// The cushions, and the cue ball's centre there, in diamonds.
    pub hits: [(Rail, DVec2); 3],
    /// Side spin at the first cushion, `R w / v`: positive where it is running.
    pub english: f64,
    /// The cue ball's motion just before the first cushion, and its centre, m.
    pub motion: (DVec2, Impulse),
}

impl Leg {
    /// The first three cushions in a row before the second object ball: from the stroke, or from the first object ball.
    pub fn of(table: &Table, recording: &Recording) -> Option<Self> {
        let mut from = recording.state(0, 0.0).position;
        let (mut hits, mut met) = (Vec::new(), 0);
        for event in recording.events() {
            match event.kind {
                EventKind::BallBall(0, ball) if met == 0 || met == ball => {
                    (met, from) = (ball, recording.state(0, event.time).position);
                    hits.clear();
                }
                EventKind::BallBall(0, _) => return None,
                EventKind::BallRail(0, rail) => hits.push((rail, event.time)),
                _ => {}
            }
            if let [first, second, third] = hits[..] {
                let hit = |(rail, time): (Rail, f64)| (rail, diamonds(table, recording.state(0, time).position));
                let before = recording.state(0, first.1 - JUST_BEFORE);
                return Some(Self {
                    from: diamonds(table, from),
                    hits: [first, second, third].map(hit),
                    english: english(table, &before, first.0),
                    motion: (before.position, Impulse::on_cloth(before.velocity, before.spin)),
                });
            }
        }
        None
    }

    /// The line from where the cue ball came from to the first cushion, as the centre of the ball goes.
    pub fn line(&self) -> Line {
        Line::between(self.from, self.hits[0].1)
    }

    /// The cushions.
    pub fn rails(&self) -> [Rail; 3] {
        self.hits.map(|(rail, _)| rail)
    }
}
