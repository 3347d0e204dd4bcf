//! The three consecutive cushions of a shot's cue ball, to which diamond systems apply.

use glam::DVec2;

use super::lines::{Line, diamonds};
use crate::{
    coach::technique::{JUST_BEFORE, english},
    physics::Impulse,
    simulation::{CushionContacts, EventKind, Rail, Recording},
    table::Table,
};

/// Three consecutive cushions without a ball between them.
#[derive(Clone, Debug)]
pub struct Leg {
    /// Start of the leg: the cue ball's centre at the stroke or at the first object ball, in diamonds.
    pub from: DVec2,
    /// The cushions and the cue ball's centre at each, in diamonds.
    pub hits: [(Rail, DVec2); 3],
    /// Side spin at the first cushion, `R w / v`: positive for running english.
    pub english: f64,
    /// The cue ball's centre just before the first cushion, m, and its motion there.
    pub motion: (DVec2, Impulse),
}

impl Leg {
    /// Finds the first three consecutive cushions before the second object ball, from the stroke or from the first
    /// object ball.
    pub fn of(table: &Table, recording: &Recording) -> Option<Self> {
        let mut from = recording.state(0, 0.0).position;
        let (mut hits, mut met, mut contacts) = (Vec::new(), 0, CushionContacts::default());
        for event in recording.events() {
            hits.extend(contacts.follow(0, event).map(|rail| (rail, event.time)));
            match event.kind {
                EventKind::BallBall(0, ball) if met == 0 || met == ball => {
                    (met, from) = (ball, recording.state(0, event.time).position);
                    hits.clear();
                }
                EventKind::BallBall(0, _) => return None,
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

    /// Returns the line of the ball's centre from the start to the first cushion.
    pub fn line(&self) -> Line {
        Line::between(self.from, self.hits[0].1)
    }

    /// Returns the cushions.
    pub fn rails(&self) -> [Rail; 3] {
        self.hits.map(|(rail, _)| rail)
    }
}
