//! A ball as it comes on to what it meets next.

use crate::{physics::BallState, simulation::Rail, table::Table};

/// How long before an event a course is read, s: at its own time the event has already changed it.
pub const JUST_BEFORE: f64 = 1e-9;

/// Side spin of a ball that comes on to a cushion, in units of a rolling ball's spin, R w / v: positive where it is running, negative where it is
/// reverse. A ball that rolls along the cushion as on a track has 1.
pub fn english(table: &Table, ball: &BallState, rail: Rail) -> f64 {
    let turning = ball.velocity.dot(rail.normal().perp()).signum();
    table.radius * ball.spin.z * turning / ball.velocity.length()
}
