//! Motion of one ball on the cloth: sliding, rolling, spinning and stationary phases (thesis 2.1).

use glam::{DVec2, DVec3};

/// The phase of a ball's motion, which selects its equation of motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Motion {
    /// At rest on the cloth, possibly with a decaying spin `w_z` about the vertical axis (thesis 2.1.3).
    Stationary,
    /// Rolling without slip (thesis 2.1.2).
    Rolling,
    /// Slipping on the cloth (thesis 2.1.1).
    Sliding,
    /// Pressed against a cushion or another ball.
    Resting,
    /// In the air, or hopping.
    Flying,
    /// Off the table.
    OffTable,
}

/// Position and motion of a ball on the cloth at one moment.
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
    /// Creates a stationary ball.
    pub const fn at_rest(position: DVec2) -> Self {
        Self { position, velocity: DVec2::ZERO, spin: DVec3::ZERO }
    }

    /// Returns the kinetic energy per unit of mass: `v²/2 + w² R²/5`, m²/s².
    pub fn specific_energy(&self, radius: f64) -> f64 {
        0.5 * self.velocity.length_squared() + 0.2 * radius * radius * self.spin.length_squared()
    }
}

/// Returns the slip velocity of the ball's lowest point on the cloth: `u = v + R z×w` (thesis equation 1), m/s.
#[inline]
pub fn slip(radius: f64, velocity: DVec2, spin: DVec3) -> DVec2 {
    DVec2::new(velocity.x - radius * spin.y, velocity.y + radius * spin.x)
}

/// Returns the spin about horizontal axes of a ball that rolls with `velocity`: `z×v/R`, rad/s.
pub fn rolling_spin(radius: f64, velocity: DVec2) -> DVec2 {
    DVec2::new(-velocity.y / radius, velocity.x / radius)
}

/// Returns `w_z` after `time` seconds of decay to zero at `rate` rad/s².
#[inline]
pub fn decayed_spin(spin: f64, rate: f64, time: f64) -> f64 {
    (spin.abs() - rate * time).max(0.0).copysign(spin)
}
