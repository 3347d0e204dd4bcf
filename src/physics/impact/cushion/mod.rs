//! Collision of a ball with a cushion: one law per rail model, selected by the table.

mod equator;
mod mathavan;
mod nose;

use glam::{DVec2, DVec3};

use super::{super::SpatialState, BallState};
use crate::table::{Fade, Rail, RailModel, Table};
use equator::collide_rail;
use nose::StickSlip;

/// Impact constants of one cushion.
#[derive(Clone, Copy, Debug)]
pub struct Cushion {
    /// Restitution at low impact speed.
    pub restitution: f64,
    /// Coefficient of friction.
    pub friction: f64,
    /// Sine and cosine of the elevation of the nose's contact point, seen from the centre of a ball on the cloth.
    pub nose: [f64; 2],
    law: Law,
    fade: Option<Fade>,
}

/// Sine and cosine of the elevation of a contact at the height of the ball's centre.
const EQUATOR: [f64; 2] = [0.0, 1.0];

/// Largest number of immediately repeated impacts with a nose. On accepted tables, each repetition leaves at most 0.84 of the approach
/// speed.
const MAX_REPEATS: u32 = 200;

/// Share of the approach speed that may remain when the repetition stops.
const MAX_REMAINDER: f64 = 1e-14;

/// Impulse of an impact with a rail or another ball.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ImpactImpulse {
    /// Impulse per mass along the line of impact, m/s; zero or negative for a ball that does not approach.
    pub normal: f64,
    /// Upward velocity that the ball would have if nothing held it on the cloth, m/s: with strong follow, friction lets it climb the nose
    /// of a rail. Zero for two balls.
    pub climb: f64,
}

/// Model of the impact.
#[derive(Clone, Copy, Debug)]
enum Law {
    Equator,
    Nose(StickSlip),
    /// With simultaneous friction on the cloth of coefficient `cloth`.
    Mathavan {
        cloth: f64,
    },
}

impl Cushion {
    /// Returns the cushion of a rail of `table`.
    pub fn of(table: &Table, rail: Rail) -> Self {
        let own = table.rail.overrides(rail);
        let restitution = own.e.unwrap_or(table.rail_restitution);
        let sine = own.height.or(table.rail.height).map_or(0.0, |height| height / table.radius - 1.0);
        let nose = [sine, (1.0 - sine * sine).sqrt()];
        let (nose, law) = match table.rail.model {
            RailModel::Equator => (EQUATOR, Law::Equator),
            RailModel::Nose => (nose, Law::Nose(StickSlip::Sharp)),
            RailModel::Smooth => {
                let most = 2.0 / 7.0 * table.rail.kappa.unwrap_or(1.0);
                (nose, Law::Nose(StickSlip::Smooth { most }))
            }
            RailModel::Mathavan => (nose, Law::Mathavan { cloth: table.sliding_friction }),
        };
        Self { restitution, friction: table.friction_of(rail), nose, law, fade: table.rail.fade }
    }

    /// Returns the cushion with this restitution at any speed and contact at the height of the ball's centre.
    #[must_use]
    pub fn with_restitution(self, restitution: f64) -> Self {
        Self { restitution, nose: EQUATOR, law: Law::Equator, fade: None, ..self }
    }

    /// Applies a collision of a ball on the cloth with this cushion, whose normal into the table is `n`.
    #[inline(always)]
    pub fn resolve(&self, radius: f64, n: DVec2, ball: &mut BallState) -> ImpactImpulse {
        if matches!(self.law, Law::Equator) && self.fade.is_none() {
            let normal = collide_rail(radius, self.restitution, self.friction, n, ball);
            return ImpactImpulse { normal, climb: 0.0 };
        }
        self.resolve_at_height(radius, n, ball)
    }

    /// Repeats the impact until the ball leaves. A nose above the ball's centre also presses the ball down, and the cloth absorbs that
    /// part. With low restitution, some approach speed remains after an impact, so that the next one follows immediately. A ball that
    /// climbs the nose is not held by the cloth and needs no repetition.
    #[inline(never)]
    fn resolve_at_height(&self, radius: f64, n: DVec2, ball: &mut BallState) -> ImpactImpulse {
        let most_left = MAX_REMAINDER * ball.velocity.dot(n).abs();
        let mut whole = self.impact_once(radius, n, ball);
        for _ in 0..MAX_REPEATS {
            if ball.velocity.dot(n) >= -most_left || whole.climb > 0.0 {
                return whole;
            }
            let again = self.impact_once(radius, n, ball);
            whole = ImpactImpulse { normal: whole.normal + again.normal, climb: whole.climb + again.climb };
        }
        whole
    }

    /// Applies one impact at the height of the nose.
    #[inline(always)]
    fn impact_once(&self, radius: f64, n: DVec2, ball: &mut BallState) -> ImpactImpulse {
        let restitution = self.restitution_at(-ball.velocity.dot(n));
        let [normal, climb] = match self.law {
            Law::Equator => [collide_rail(radius, restitution, self.friction, n, ball), 0.0],
            Law::Nose(stick_slip) => nose::collide(radius, restitution, self.friction, self.nose, stick_slip, n, ball),
            Law::Mathavan { cloth } => {
                [mathavan::collide(radius, restitution, [self.friction, cloth], self.nose, n, ball), 0.0]
            }
        };
        ImpactImpulse { normal, climb }
    }

    /// Returns the friction impulse per mass divided by the slip, for a normal impulse at the height of the ball's centre: Coulomb friction
    /// up to the no-slip limit.
    pub(super) fn friction_factor(&self, normal: f64, slip: f64) -> f64 {
        StickSlip::Sharp.factor(self.friction * normal, slip)
    }

    fn restitution_at(&self, approach: f64) -> f64 {
        self.fade.map_or(self.restitution, |fade| fade.at(self.restitution, approach))
    }

    /// Applies a collision of a ball in the air with the nose in the direction `d` from its centre, a unit vector. Without the cloth, all
    /// models reduce to an impact with friction: that of `smooth`, or Coulomb's. Restitution falls with the speed along `d`; on the cloth, with
    /// that along the normal into the table. The ball leaves at least at the speed `slowest`, m/s. Returns its approach speed,
    /// m/s, which is negative if it does not approach.
    pub fn resolve_in_space(&self, radius: f64, slowest: f64, d: DVec3, ball: &mut SpatialState) -> f64 {
        let stick_slip = if let Law::Nose(stick_slip) = self.law { stick_slip } else { StickSlip::Sharp };
        let restitution = self.restitution_at(ball.velocity.dot(d));
        nose::collide_in_space(radius, [restitution, self.friction, slowest], stick_slip, d, ball)
    }
}

#[cfg(test)]
mod tests;
