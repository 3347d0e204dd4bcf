//! A natural stroke: the side, the roll and the speed that a system supposes, and where a ball that is played so goes.

use glam::{DVec2, DVec3};
use serde::Serialize;

use super::lines::{Line, diamonds, metres};
use crate::{
    physics::{Impulse, rolling_spin},
    simulation::{Follower, Rail, alone},
    table::Table,
};

/// How a cue ball moves that is played in a system's way.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Natural {
    /// Running side on the first cushion: the equator's speed over the ball's.
    pub side: f64,
    /// Spin ahead over that of a rolling ball.
    pub roll: f64,
    /// Speed of the ball, m/s.
    pub speed: f64,
}

impl Natural {
    /// The cushions that a ball alone on `table` meets if it runs so on `line` towards the cushion `first`, and where its centre
    /// is then, in diamonds: the first five at most.
    pub fn run(&self, table: &Table, line: &Line, first: Rail) -> Vec<(Rail, DVec2)> {
        let [from, to] = [line.from, line.from + line.way].map(|place| metres(table, place));
        let ahead = (to - from).normalize_or_zero();
        // Running side takes the ball further the way that it goes on along the cushion.
        let running = if ahead.perp_dot(reflected(ahead, first)) < 0.0 { 1.0 } else { -1.0 };
        let velocity = self.speed * ahead;
        let spin: DVec3 =
            (self.roll * rolling_spin(table.radius, velocity)).extend(running * self.side * self.speed / table.radius);
        hits(table, from, &Impulse::on_cloth(velocity, spin))
    }
}

/// The first five cushions that a ball alone meets, with its centre in diamonds.
pub fn hits(table: &Table, from: DVec2, impulse: &Impulse) -> Vec<(Rail, DVec2)> {
    let followed = Follower::new(&[], MOST).of(table, &alone(from), impulse);
    followed.hits.into_iter().map(|(_, rail, place)| (rail, diamonds(table, place))).collect()
}

/// The way that a cushion sends a ball back without spin.
pub fn reflected(way: DVec2, rail: Rail) -> DVec2 {
    way - 2.0 * way.dot(rail.normal()) * rail.normal()
}

/// Cushions that are followed: systems look at three, and a corner may take one more.
const MOST: usize = 5;
