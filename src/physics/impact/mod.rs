//! Impacts: two balls, ball and cushion, and several of them at the same moment.

mod ball_ball;
mod cushion;
mod simultaneous;

use glam::{DVec2, DVec3};

use super::BallState;
pub use ball_ball::{BallImpact, collide_balls};
pub use cushion::{Cushion, Cushions, RailImpulse, collide_rail};
pub use simultaneous::{ImpactLaw, collide_together};

/// Change of spin `5/(2R) n×J` by a contact impulse per mass `J = along t + up z`; n×t = z and n×z = -t.
#[inline]
fn contact_twist(radius: f64, along: f64, up: f64, t: DVec2) -> DVec3 {
    let lever = 2.5 / radius;
    (lever * DVec2::new(-up * t.x, -up * t.y)).extend(lever * along)
}
