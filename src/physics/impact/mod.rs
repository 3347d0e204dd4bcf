//! Impacts: two balls, ball and cushion, and several of them at the same moment.

mod ball_ball;
mod cushion;
mod simultaneous;

use glam::{DVec2, DVec3};

use super::BallState;
pub use ball_ball::{BallImpact, collide_balls};
pub use cushion::{Cushion, Cushions, RailImpulse, collide_rail};
pub use simultaneous::{ImpactLaw, collide_together};

/// How an impact in the air opens that closes with `approach` and has `across` speed beside it, m/s: its opening speed, and the
/// share of the speed across that remains.
///
/// A ball that comes to lie on a nose or on another ball slides off it in bounces that get lower without end. None opens more
/// slowly than `slowest`: what that takes comes from the motion across, so that no energy is gained, and the bounces stay some
/// ten-millionths of a metre high.
fn opening_in_space(approach: f64, restitution: f64, slowest: f64, across: f64) -> [f64; 2] {
    let opening = restitution * approach;
    if opening >= slowest {
        return [opening, 1.0];
    }
    let missing = slowest * slowest - approach * approach;
    if missing <= 0.0 {
        return [slowest, 1.0];
    }
    let left = across * across - missing;
    if left <= 0.0 { [approach.hypot(across), 0.0] } else { [slowest, left.sqrt() / across] }
}

/// Change of spin `5/(2R) n×J` by a contact impulse per mass `J = along t + up z`; n×t = z and n×z = -t.
#[inline]
fn contact_twist(radius: f64, along: f64, up: f64, t: DVec2) -> DVec3 {
    let lever = 2.5 / radius;
    (lever * DVec2::new(-up * t.x, -up * t.y)).extend(lever * along)
}
