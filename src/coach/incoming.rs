//! How a ball arrives at its next contact: the moment just before it, and its english.

use crate::{physics::BallState, simulation::Rail, table::Table};

/// How long before an event the state is read, s: at the event's own time the state is already the one after it.
pub const JUST_BEFORE: f64 = 1e-9;

/// Side spin of a ball that comes on to a cushion, in units of a rolling ball's spin, R w / v: positive where it is running, negative where it is
/// reverse. A ball that rolls along the cushion as on a track has 1.
pub fn english(table: &Table, ball: &BallState, rail: Rail) -> f64 {
    let turning = ball.velocity.dot(rail.normal().perp()).signum();
    table.radius * ball.spin.z * turning / ball.velocity.length()
}
