//! A natural stroke: the side, roll and speed that a system assumes, and the resulting path of the ball.

use glam::{DVec2, DVec3};
use serde::Serialize;

use super::lines::{Line, diamonds, metres};
use crate::{
    physics::{Impulse, rolling_spin},
    simulation::{Follower, Rail, lone_ball_layout},
    table::Table,
};

/// The motion of a cue ball that is played as a system assumes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct NaturalStroke {
    /// Running side on the first cushion: the equator's speed divided by the ball's.
    pub side: f64,
    /// Forward spin divided by that of a rolling ball.
    pub roll: f64,
    /// Speed of the ball, m/s.
    pub speed: f64,
}

impl NaturalStroke {
    /// Simulates a ball alone on `table` that runs on `line` towards the cushion `first`. Returns up to five cushions
    /// that it hits and its centre at each, in diamonds.
    pub fn run(&self, table: &Table, line: &Line, first: Rail) -> Vec<(Rail, DVec2)> {
        let [from, to] = [line.from, line.from + line.direction].map(|place| metres(table, place));
        let ahead = (to - from).normalize_or_zero();
        // Running side carries the ball further in its direction along the cushion.
        let running = if ahead.perp_dot(ahead.reflect(first.normal())) < 0.0 { 1.0 } else { -1.0 };
        let velocity = self.speed * ahead;
        let spin: DVec3 =
            (self.roll * rolling_spin(table.radius, velocity)).extend(running * self.side * self.speed / table.radius);
        hits(table, from, &Impulse::on_cloth(velocity, spin))
    }
}

/// Returns the first five cushions that a ball alone on the table hits, with its centre in diamonds.
pub fn hits(table: &Table, from: DVec2, impulse: &Impulse) -> Vec<(Rail, DVec2)> {
    let followed = Follower::new(&[], MAX_CUSHIONS).follow(table, &lone_ball_layout(from), impulse);
    followed.hits.into_iter().map(|(_, rail, place)| (rail, diamonds(table, place))).collect()
}

/// Maximum number of cushions: systems use three, and a corner may add one.
const MAX_CUSHIONS: usize = 5;
