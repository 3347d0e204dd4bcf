//! Motion of one ball on the cloth: sliding, rolling, spinning, at rest (thesis 2.1).

use glam::{DVec2, DVec3};

use crate::table::Table;

/// Which equation of motion a ball follows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Motion {
    /// At rest on the cloth; a spin `w_z` about the vertical may go on for a while (thesis 2.1.3).
    Stationary,
    /// Rolling without slip (thesis 2.1.2).
    Rolling,
    /// Slipping on the cloth (thesis 2.1.1).
    Sliding,
    /// Pressed against a cushion or another ball.
    Resting,
    /// In the air, or hopping.
    Flying,
    /// It has left the table.
    OffTable,
}

/// Where a ball is and how it moves at one moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BallState {
    /// Centre, m.
    pub position: DVec2,
    /// Velocity, m/s.
    pub velocity: DVec2,
    /// Angular velocity, rad/s.
    pub spin: DVec3,
}

impl BallState {
    /// A ball lying still.
    pub const fn at_rest(position: DVec2) -> Self {
        Self { position, velocity: DVec2::ZERO, spin: DVec3::ZERO }
    }

    /// Kinetic energy per unit of mass: `v²/2 + w² R²/5`, m²/s².
    pub fn specific_energy(&self, radius: f64) -> f64 {
        0.5 * self.velocity.length_squared() + 0.2 * radius * radius * self.spin.length_squared()
    }
}

/// Velocity of the ball's lowest point over the cloth: `u = v + R z×w` (thesis equation 1), m/s.
#[inline]
pub fn slip(radius: f64, velocity: DVec2, spin: DVec3) -> DVec2 {
    DVec2::new(velocity.x - radius * spin.y, velocity.y + radius * spin.x)
}

/// Spin of a ball that rolls with `velocity`, about horizontal axes: `z×v/R`, rad/s.
pub fn rolling_spin(radius: f64, velocity: DVec2) -> DVec2 {
    DVec2::new(-velocity.y / radius, velocity.x / radius)
}

/// Deceleration of a rolling ball, `5/7 mu_r g` (thesis equation 5), m/s².
pub fn rolling_deceleration(table: &Table) -> f64 {
    5.0 / 7.0 * table.rolling_friction * table.gravity
}

/// `w_z` after `time` seconds of decay at `rate` rad/s² down to zero.
#[inline]
pub fn decayed_spin(spin: f64, rate: f64, time: f64) -> f64 {
    (spin.abs() - rate * time).max(0.0).copysign(spin)
}
