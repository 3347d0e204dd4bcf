//! One ball pressed against one cushion, whose equations are completely known. Integrates the energy dissipated by its
//! frictions with the classical Runge-Kutta method; from the recorded course it uses only the start of a stretch.

use glam::{DVec2, DVec3};

use crate::{
    physics::BallState,
    table::{Rail, Table},
};

/// Approximate change of a slip in a step, as a share of the slip; the relative error of a step is then `0.05⁵/120`: 3e-9.
const SHARE: f64 = 0.05;

/// Shortest step, as a share of the stretch: slips that end on it, or stay almost zero, would need ever shorter steps. The
/// effect of a slip so near to its end is a tenth of the accepted error of the work.
const SHORTEST: f64 = 1e-6;

/// The cushion and the laws in force there.
pub struct OnCushion<'a> {
    pub table: &'a Table,
    pub rail: Rail,
    /// Whether the ball slips at the cushion; otherwise it sticks there.
    pub slips: bool,
    /// Sign of the side spin on the whole stretch, 1 or -1; 0 if the cloth holds it at zero.
    pub spin_sign: f64,
}

impl OnCushion<'_> {
    /// Returns the energy that a ball which slips on the cloth loses in `time` seconds, m²/s².
    pub fn loss(&self, start: &BallState, time: f64) -> f64 {
        let table = self.table;
        let fastest = 3.5 * table.sliding_friction * table.gravity * (1.0 + table.friction_of(self.rail));
        let mut now = (start.velocity, start.spin);
        let mut left = time;
        while left > 0.0 {
            let slips = [self.cloth_slip(now).length(), self.rail_slip(now).length()];
            let slip = if self.slips { slips[0].min(slips[1]) } else { slips[0] };
            let step = (SHARE * slip / fastest).max(SHORTEST * time).min(left);
            let after =
                |rate: (DVec2, DVec3), share: f64| (now.0 + share * step * rate.0, now.1 + share * step * rate.1);
            let first = self.rate(now);
            let second = self.rate(after(first, 0.5));
            let third = self.rate(after(second, 0.5));
            let last = self.rate(after(third, 1.0));
            now.0 += step / 6.0 * (first.0 + 2.0 * (second.0 + third.0) + last.0);
            now.1 += step / 6.0 * (first.1 + 2.0 * (second.1 + third.1) + last.1);
            left -= step;
        }
        let end = BallState { position: start.position, velocity: now.0, spin: now.1 };
        start.specific_energy(table.radius) - end.specific_energy(table.radius)
    }

    fn cloth_slip(&self, (v, w): (DVec2, DVec3)) -> DVec2 {
        v + self.table.radius * DVec2::new(-w.y, w.x)
    }

    /// Returns the slip along the cushion, `t = z×n`, and along z.
    fn rail_slip(&self, (v, w): (DVec2, DVec3)) -> DVec2 {
        let (radius, t) = (self.table.radius, self.rail.normal().perp());
        DVec2::new(v.dot(t) - radius * w.z, radius * w.truncate().dot(t))
    }

    /// Returns the acceleration of the ball and of its spin.
    fn rate(&self, now: (DVec2, DVec3)) -> (DVec2, DVec3) {
        let table = self.table;
        let (n, t, spin_per_force) = (self.rail.normal(), self.rail.normal().perp(), 2.5 / table.radius);
        let cloth = -table.sliding_friction * table.gravity * self.cloth_slip(now).normalize_or_zero();
        let spinning = -spin_per_force * table.spinning_friction * table.gravity * self.spin_sign;
        // The force at the lowest point rotates the ball about a horizontal axis, the force at the cushion about the others.
        let turn = (spin_per_force * DVec2::new(cloth.y, -cloth.x)).extend(spinning);
        let push = (-cloth.dot(n)).max(0.0);
        let rub = if self.slips {
            -table.friction_of(self.rail) * push * self.rail_slip(now).normalize_or_zero()
        } else {
            let free = self.rail_slip((cloth, turn));
            DVec2::new(-free.x / 3.5, -free.y / 2.5)
        };
        let linear = cloth + push * n + rub.x * t;
        let mut angular = turn + spin_per_force * (rub.y * t).extend(-rub.x);
        angular.z = if self.spin_sign == 0.0 { 0.0 } else { angular.z };
        (linear, angular)
    }
}
