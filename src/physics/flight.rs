//! Balls that leave the cloth: impulses of the cloth on a ball that is pressed into it or lands on it (thesis 6.1.3).

use glam::{DVec2, DVec3};
use serde::Serialize;

use super::{BallState, slip};
use crate::table::Table;

/// Position and motion of a ball in three dimensions.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SpatialState {
    /// Centre, m; `z` is its height above that of a ball on the cloth.
    pub position: DVec3,
    /// Velocity, m/s.
    pub velocity: DVec3,
    /// Angular velocity, rad/s.
    pub spin: DVec3,
}

impl From<BallState> for SpatialState {
    fn from(ball: BallState) -> Self {
        Self { position: ball.position.extend(0.0), velocity: ball.velocity.extend(0.0), spin: ball.spin }
    }
}

impl SpatialState {
    /// Returns the horizontal part of the state, which is the full state for a ball on the cloth.
    pub fn horizontal_state(&self) -> BallState {
        BallState { position: self.position.truncate(), velocity: self.velocity.truncate(), spin: self.spin }
    }

    /// Returns the kinetic and potential energy per unit of mass, m²/s².
    pub fn specific_energy(&self, radius: f64, gravity: f64) -> f64 {
        0.5 * self.velocity.length_squared()
            + 0.2 * radius * radius * self.spin.length_squared()
            + gravity * self.position.z
    }
}

/// Properties of the cloth for impacts from above.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cloth {
    /// Coefficient of restitution `e_c`.
    pub restitution: f64,
    /// Coefficient of friction `mu_c`.
    pub friction: f64,
    /// Gravitational acceleration, m/s².
    pub gravity: f64,
}

impl Cloth {
    /// Returns the cloth of a table; `None` if balls never leave it.
    pub fn of(table: &Table) -> Option<Self> {
        table.flight.map(|flight| Self {
            restitution: flight.restitution,
            friction: flight.friction.unwrap_or(table.sliding_friction),
            gravity: table.gravity,
        })
    }

    /// Applies the impact of a ball on the cloth. The normal impulse per mass is `(1 + e_c) |v_z|`. The friction impulse is `mu_c` times
    /// that, opposite to the slip, limited by the no-slip value of two sevenths of the slip. Does nothing to a ball that moves upwards.
    pub fn resolve(&self, radius: f64, ball: &mut SpatialState) {
        if ball.velocity.z >= 0.0 {
            return;
        }
        let push = -(1.0 + self.restitution) * ball.velocity.z;
        ball.velocity.z *= -self.restitution;
        self.apply_friction(radius, push, ball);
    }

    /// Applies the friction impulse on a ball that is pressed into the cloth by the impulse `push` per mass, m/s.
    pub fn apply_friction(&self, radius: f64, push: f64, ball: &mut SpatialState) {
        let u = slip(radius, ball.velocity.truncate(), ball.spin);
        let size = u.length();
        let friction = (self.friction * push).min(2.0 / 7.0 * size);
        if size > 0.0 {
            let against = u * (-friction / size);
            ball.velocity += against.extend(0.0);
            ball.spin += spin_change_by_cloth(radius, against).extend(0.0);
        }
    }
}

/// Returns the change of spin by an impulse per mass at the ball's lowest point, rad/s: `-5/(2R) z×J`.
pub fn spin_change_by_cloth(radius: f64, impulse: DVec2) -> DVec2 {
    (-2.5 / radius) * impulse.perp()
}

#[cfg(test)]
mod tests {
    use super::*;

    const RADIUS: f64 = 0.030_75;

    fn cloth() -> Cloth {
        Cloth { restitution: 0.5, friction: 0.2, gravity: 9.81 }
    }

    #[test]
    fn fast_slip_loses_the_coulomb_impulse_and_slow_slip_ends() {
        let falling = |ahead: f64| SpatialState {
            position: DVec3::ZERO,
            velocity: DVec3::new(ahead, 0.0, -1.0),
            spin: DVec3::new(0.0, 0.0, 7.0),
        };
        let mut fast = falling(3.0);
        cloth().resolve(RADIUS, &mut fast);
        assert!(fast.velocity.abs_diff_eq(DVec3::new(3.0 - 0.2 * 1.5, 0.0, 0.5), 1e-15), "{fast:?}");
        assert!((fast.spin - DVec3::new(0.0, 2.5 / RADIUS * 0.3, 7.0)).length() < 1e-12, "{fast:?}");
        let mut slow = falling(0.5);
        cloth().resolve(RADIUS, &mut slow);
        assert!(slip(RADIUS, slow.velocity.truncate(), slow.spin).length() < 1e-15);
        assert!((slow.velocity.x - 5.0 / 7.0 * 0.5).abs() < 1e-15);
    }

    #[test]
    fn cloth_gains_no_energy_and_ignores_rising_balls() {
        for (ahead, turns) in [(0.1, 60.0), (-2.0, -5.0), (4.0, 0.0)] {
            let mut ball = SpatialState {
                position: DVec3::ZERO,
                velocity: DVec3::new(ahead, -0.3, -2.0),
                spin: DVec3::new(turns, turns, 3.0),
            };
            let before = ball.specific_energy(RADIUS, 9.81);
            cloth().resolve(RADIUS, &mut ball);
            assert!(ball.specific_energy(RADIUS, 9.81) < before);
            let rising = ball;
            cloth().resolve(RADIUS, &mut ball);
            assert_eq!(ball, rising);
        }
    }
}
