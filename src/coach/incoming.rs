//! The state of a ball just before its next contact, and its english.

use crate::{physics::BallState, simulation::Rail, table::Table};

/// Time before an event at which the state is read, s: at the event's own time the state is already the one after it.
pub const JUST_BEFORE: f64 = 1e-9;

/// Returns the side spin of a ball that approaches a cushion, in units of a rolling ball's spin, R w / v: positive for
/// running, negative for reverse english. It is 1 for a ball that rolls along the cushion without slip.
pub fn english(table: &Table, ball: &BallState, rail: Rail) -> f64 {
    let turning = ball.velocity.dot(rail.normal().perp()).signum();
    table.radius * ball.spin.z * turning / ball.velocity.length()
}
