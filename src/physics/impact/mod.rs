//! Impacts: two balls, ball and cushion, and several of them at the same moment.

mod ball_ball;
mod cushion;
mod over_cloth;
mod simultaneous;

use glam::{DVec2, DVec3};

use super::BallState;
pub use ball_ball::BallImpact;
pub use cushion::{Cushion, Cushions, ImpactImpulse};
pub use simultaneous::{ImpactLaw, collide_together};

/// The speed with which an impact in the air opens that closes with `approach`, m/s. One slower than `slowest` loses nothing: a
/// ball that comes to lie on a nose or on another ball slides off it in bounces that would get lower without end.
fn opening_in_space(approach: f64, restitution: f64, slowest: f64) -> f64 {
    (restitution * approach).max(approach.min(slowest))
}

/// The unit vector from one ball's centre to another's. Exactly upwards it leans a little to one side: nothing says to which side a ball
/// leaves the top of another; that it does not stay there is all that is known.
fn direction(from: DVec3, to: DVec3) -> DVec3 {
    let mut n = (to - from).normalize();
    if n.truncate() == DVec2::ZERO {
        n.x = f64::EPSILON;
    }
    n
}

/// What changes the motion `across + opening n` after such an impact so that it opens with `slowest`, m/s: what that takes comes
/// from the motion across, so that no energy is gained.
fn raised(opening: f64, slowest: f64, across: DVec3, n: DVec3) -> DVec3 {
    let missing = slowest * slowest - opening * opening;
    if missing <= 0.0 {
        return DVec3::ZERO;
    }
    let (had, left) = (across.length_squared(), across.length_squared() - missing);
    if left <= 0.0 {
        return (libm::hypot(opening, had.sqrt()) - opening) * n - across;
    }
    (slowest - opening) * n - (1.0 - (left / had).sqrt()) * across
}

/// Change of spin `5/(2R) n×J` by a contact impulse per mass `J = along t + up z`; n×t = z and n×z = -t.
#[inline]
fn contact_twist(radius: f64, along: f64, up: f64, t: DVec2) -> DVec3 {
    let lever = 2.5 / radius;
    (lever * DVec2::new(-up * t.x, -up * t.y)).extend(lever * along)
}
