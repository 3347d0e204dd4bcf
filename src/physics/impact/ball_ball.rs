//! Collision of two balls (thesis 2.2.2).

use super::{super::SpatialState, BallState, contact_twist, direction, separation_correction, separation_speed};
use crate::table::{Fade, SlipFriction, Table};

/// Impact law of two balls on a table.
#[derive(Clone, Copy, Debug)]
pub struct BallImpact {
    /// Restitution at low speed.
    pub restitution: f64,
    /// Coefficient of friction; `None` if the contact never slips.
    pub friction: Option<f64>,
    fade: Option<Fade>,
    by_slip: Option<SlipFriction>,
}

impl BallImpact {
    /// Returns the law of a table.
    pub fn of(table: &Table) -> Self {
        Self {
            restitution: table.ball_restitution,
            friction: table.ball_friction,
            fade: table.ball_fade,
            by_slip: table.ball_slip_friction,
        }
    }

    /// Returns the law with this restitution at any impact speed.
    #[must_use]
    pub fn with_restitution(self, restitution: f64) -> Self {
        Self { restitution, fade: None, ..self }
    }

    /// Applies a collision to velocities and spins. Returns the normal impulse per mass `P/m`, m/s, which is zero or negative for balls
    /// that do not approach each other.
    ///
    /// Equations (17) to (21), with equal and opposite impulses and Coulomb friction up to the no-slip limit 1/7.
    #[inline(always)]
    pub fn resolve(&self, radius: f64, first: &mut BallState, second: &mut BallState) -> f64 {
        let n = (first.position - second.position).normalize();
        let approach = (second.velocity - first.velocity).dot(n);
        let normal = 0.5 * (1.0 + self.restitution_at(approach)) * approach;
        if normal <= 0.0 {
            return normal;
        }
        let t = n.perp();
        let spin = first.spin + second.spin;
        // The contact's slip (21) along t and z; there, n×w has the components (-w_z, w·t).
        let slip_t = (first.velocity - second.velocity).dot(t) - radius * spin.z;
        let slip_z = radius * (spin.x * t.x + spin.y * t.y);
        // No speed on a table is so large that its square overflows, against which `hypot` would guard at some cost.
        let slip = (slip_t * slip_t + slip_z * slip_z).sqrt();
        let friction = self.by_slip.map_or(self.friction, |law| Some(law.at(libm::hypot(slip_t, slip_z))));
        let factor = match friction {
            Some(mu) if 7.0 * mu * normal < slip => mu * normal / slip,
            _ => 1.0 / 7.0,
        };
        let change = normal * n - factor * slip_t * t;
        first.velocity += change;
        second.velocity -= change;
        let twist = contact_twist(radius, factor * slip_t, factor * slip_z, t);
        first.spin += twist;
        second.spin += twist;
        normal
    }

    /// As [`Self::resolve`], if at least one ball is in the air: the line of centres can have any direction. The balls separate at least at
    /// the speed `slowest`, m/s. Returns their approach speed, m/s, which is negative if they do not approach.
    pub fn resolve_in_space(
        &self,
        radius: f64,
        slowest: f64,
        first: &mut SpatialState,
        second: &mut SpatialState,
    ) -> f64 {
        let n = direction(second.position, first.position);
        let relative = first.velocity - second.velocity;
        let approach = -relative.dot(n);
        if approach < 0.0 {
            return approach;
        }
        let across = relative + approach * n;
        let opening = separation_speed(approach, self.restitution_at(approach), slowest);
        let normal = 0.5 * (approach + opening);
        // Equation (21), whose component along n is zero.
        let slip = across - radius * (first.spin + second.spin).cross(n);
        let factor = self.friction_factor(normal, slip.length());
        let after = across - 2.0 * factor * slip;
        let change = normal * n - factor * slip + 0.5 * separation_correction(opening, slowest, after, n);
        first.velocity += change;
        second.velocity -= change;
        let twist = (2.5 / radius * factor) * n.cross(slip);
        first.spin += twist;
        second.spin += twist;
        approach
    }

    pub(super) fn restitution_at(&self, approach: f64) -> f64 {
        self.fade.map_or(self.restitution, |fade| fade.at(self.restitution, approach))
    }

    /// Returns the friction impulse per mass divided by the slip, for a normal impulse: Coulomb friction up to the no-slip limit.
    pub(super) fn friction_factor(&self, normal: f64, slip: f64) -> f64 {
        match self.by_slip.map_or(self.friction, |law| Some(law.at(slip))) {
            Some(mu) if 7.0 * mu * normal < slip => mu * normal / slip,
            _ => 1.0 / 7.0,
        }
    }
}

#[cfg(test)]
mod tests;
