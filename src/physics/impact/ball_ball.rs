//! Collision of two balls (thesis 2.2.2).

use super::{BallState, contact_twist};
use crate::table::{Fade, SlipFriction, Table};

/// The law of two balls' impacts, as a table has it.
#[derive(Clone, Copy, Debug)]
pub struct BallImpact {
    /// Restitution of a slow impact.
    pub restitution: f64,
    /// Coefficient of friction; `None` for a contact that never slips.
    pub friction: Option<f64>,
    fade: Option<Fade>,
    by_slip: Option<SlipFriction>,
}

impl BallImpact {
    /// That of a table.
    pub fn of(table: &Table) -> Self {
        Self {
            restitution: table.ball_restitution,
            friction: table.ball_friction,
            fade: table.ball_fade,
            by_slip: table.ball_slip_friction,
        }
    }

    /// The end of endless bounces: no restitution.
    #[must_use]
    pub fn inelastic(self) -> Self {
        Self { restitution: 0.0, fade: None, ..self }
    }

    /// Velocities and spins after a collision; returns what [`collide_balls`] does.
    #[inline(always)]
    pub fn resolve(&self, radius: f64, first: &mut BallState, second: &mut BallState) -> f64 {
        if self.fade.is_none() && self.by_slip.is_none() {
            return collide_balls(radius, self.restitution, self.friction, first, second);
        }
        self.resolve_by_speed(radius, first, second)
    }

    #[inline(never)]
    fn resolve_by_speed(&self, radius: f64, first: &mut BallState, second: &mut BallState) -> f64 {
        let n = (first.position - second.position).normalize();
        let apart = first.velocity - second.velocity;
        let restitution = self.fade.map_or(self.restitution, |fade| fade.at(self.restitution, -apart.dot(n)));
        let friction = match self.by_slip {
            None => self.friction,
            Some(law) => {
                let (t, spin) = (n.perp(), first.spin + second.spin);
                let along = apart.dot(t) - radius * spin.z;
                Some(law.at(along.hypot(radius * spin.truncate().dot(t))))
            }
        };
        collide_balls(radius, restitution, friction, first, second)
    }
}

/// Velocities and spins after a collision; `restitution` 0 to 1, `friction` the coefficient or `None` for a contact that
/// never slips. Returns the normal impulse per mass `P/m`, m/s, which is zero or less for balls that do not approach.
///
/// Equations (17) to (21), with equal and opposite impulses and Coulomb's law up to the no-slip limit 1/7.
#[inline]
pub fn collide_balls(
    radius: f64,
    restitution: f64,
    friction: Option<f64>,
    first: &mut BallState,
    second: &mut BallState,
) -> f64 {
    let n = (first.position - second.position).normalize();
    let approach = (second.velocity - first.velocity).dot(n);
    let normal = 0.5 * (1.0 + restitution) * approach;
    if normal <= 0.0 {
        return normal;
    }
    let t = n.perp();
    let spin = first.spin + second.spin;
    // The contact's slip (21) along t and z; n×w has the components (-w_z, w·t) there.
    let slip_t = (first.velocity - second.velocity).dot(t) - radius * spin.z;
    let slip_z = radius * (spin.x * t.x + spin.y * t.y);
    // No speed on a table comes near an overflow of its square, which `hypot` would guard against at some cost.
    let slip = (slip_t * slip_t + slip_z * slip_z).sqrt();
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
