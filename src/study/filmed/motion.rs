//! The motion of a ball at one time of a film.

use glam::{DVec2, DVec3};

use crate::physics::Impulse;

/// Returns the angular velocity about horizontal axes of a ball with this velocity and slip, rad/s.
pub fn spin_of_slip(radius: f64, velocity: DVec2, slip: DVec2) -> DVec2 {
    DVec2::new((slip.y - velocity.y) / radius, (velocity.x - slip.x) / radius)
}

/// The motion of a ball at one time: the parameters of a fit to its course.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion {
    /// Centre, m.
    pub position: DVec2,
    /// Velocity, m/s.
    pub velocity: DVec2,
    /// Slip on the cloth, m/s.
    pub slip: DVec2,
    /// Speed of the side spin at the equator, `R w_z`, m/s.
    pub side: f64,
}

impl Motion {
    /// Returns the motion as seven numbers, in the order of the fields.
    pub fn numbers(&self) -> [f64; 7] {
        let Self { position, velocity, slip, side } = *self;
        [position.x, position.y, velocity.x, velocity.y, slip.x, slip.y, side]
    }

    /// Creates the motion from seven numbers.
    pub fn of([x, y, vx, vy, ux, uy, side]: [f64; 7]) -> Self {
        Self { position: DVec2::new(x, y), velocity: DVec2::new(vx, vy), slip: DVec2::new(ux, uy), side }
    }

    /// Returns the impulse that sets a ball at rest in this motion.
    pub fn impulse(&self, radius: f64) -> Impulse {
        let spin: DVec3 = spin_of_slip(radius, self.velocity, self.slip).extend(self.side / radius);
        Impulse::on_cloth(self.velocity, spin)
    }
}
