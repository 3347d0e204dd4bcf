//! Impact at the height of the ball's centre (thesis 2.2.3).

use glam::DVec2;

use super::{super::contact_twist, BallState};

/// Applies a collision with the cushion whose normal into the table is `n`. Returns the normal impulse per mass `P/m`, m/s, which is zero
/// or negative for a ball that does not approach.
///
/// Equations (22) and (23), with Coulomb friction up to the no-slip limit 2/7.
#[inline]
pub(super) fn collide_rail(radius: f64, restitution: f64, friction: f64, n: DVec2, ball: &mut BallState) -> f64 {
    let normal = -(1.0 + restitution) * ball.velocity.dot(n);
    if normal <= 0.0 {
        return normal;
    }
    let t = n.perp();
    let slip_t = ball.velocity.dot(t) - radius * ball.spin.z;
    let slip_z = radius * (ball.spin.x * t.x + ball.spin.y * t.y);
    let slip = (slip_t * slip_t + slip_z * slip_z).sqrt();
    // Whether the contact slips or sticks is unpredictable, so that a minimum costs less than a branch.
    let (slips, holds) = (friction * normal / slip, 2.0 / 7.0);
    let factor = if slips < holds { slips } else { holds };
    ball.velocity += normal * n - factor * slip_t * t;
    ball.spin += contact_twist(radius, factor * slip_t, factor * slip_z, t);
    normal
}
