//! Impacts: of two balls, of ball and cushion, and several at the same moment.

mod ball_ball;
mod cushion;
mod over_cloth;
mod simultaneous;

use glam::{DVec2, DVec3};

use super::BallState;
pub use ball_ball::BallImpact;
pub use cushion::{Cushion, ImpactImpulse};
pub use simultaneous::{Aloft, ImpactLaw, Touch, collide_together, collide_together_in_space, take_linked};

/// Returns the separation speed of an impact in the air with the closing speed `approach`, m/s. Up to `slowest` no speed is lost: otherwise
/// a ball that settles on a nose or on another ball would slide off in ever lower bounces, without end.
fn separation_speed(approach: f64, restitution: f64, slowest: f64) -> f64 {
    (restitution * approach).max(approach.min(slowest))
}

/// Returns the unit vector from one ball's centre to another's. If it is exactly vertical, it is tilted slightly to one side: a ball does
/// not stay on top of another, and the side on which it leaves is arbitrary.
fn direction(from: DVec3, to: DVec3) -> DVec3 {
    let mut n = (to - from).normalize();
    if n.truncate() == DVec2::ZERO {
        n.x = f64::EPSILON;
    }
    n
}

/// Returns the change of the relative velocity `across + opening n` after such an impact that raises the separation speed to `slowest`,
/// m/s. The energy comes from the tangential motion `across`, so that none is gained.
fn separation_correction(opening: f64, slowest: f64, across: DVec3, n: DVec3) -> DVec3 {
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

/// Returns the change of spin `5/(2R) n×J` by a contact impulse per mass `J = along t + up z`; n×t = z and n×z = -t.
#[inline]
fn contact_twist(radius: f64, along: f64, up: f64, t: DVec2) -> DVec3 {
    let lever = 2.5 / radius;
    (lever * DVec2::new(-up * t.x, -up * t.y)).extend(lever * along)
}
