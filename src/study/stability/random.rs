//! Random shots: layouts and strokes over the full range of accepted values.

use rand::Rng;

use super::{Shot, draw};
use crate::table::{Layout, Table};

/// Draws a random layout and a stroke from the full range of every input: the tip anywhere on the ball and, one time in eight,
/// at its rim; elevations up to 89.9°; speeds from 1e-6 to 60 m/s, half of them in the range of players.
pub fn shot<R: Rng>(table: &Table, rng: &mut R) -> Shot {
    Shot { layout: Layout::random(table, rng), cue: draw::stroke(rng) }
}
