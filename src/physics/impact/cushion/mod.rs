//! Collision of a ball with a cushion: one law a model, chosen by the table.

mod equator;
mod mathavan;
mod nose;

use glam::{DVec2, DVec3};

use super::{super::SpatialState, BallState};
use crate::table::{Fade, Rail, RailModel, Rails, Table};
use equator::collide_rail;
use nose::StickSlip;

/// One cushion, as an impact needs it.
#[derive(Clone, Copy, Debug)]
pub struct Cushion {
    /// Restitution at a slow impact.
    pub restitution: f64,
    /// Coefficient of friction.
    pub friction: f64,
    /// The law of its impacts.
    law: Law,
    fade: Option<Fade>,
}

/// How often a ball may meet a nose again at once, and the share of its approach that may be left. By the laws of accepted tables what is
/// left falls to 0.84 of itself at most.
const AGAIN: u32 = 200;
const LEFT: f64 = 1e-14;

/// What an impact with a rail or another ball does besides changing the motion.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ImpactImpulse {
    /// The impulse per mass along the line of the impact, m/s, which is zero or less for a ball that does not approach.
    pub normal: f64,
    /// Upward velocity that the ball would have, were nothing above the cloth to hold it, m/s: the friction of much follow
    /// lets it climb the nose of a rail. None for two balls.
    pub climb: f64,
}

/// What decides how an impact goes, worked out once a shot.
#[derive(Clone, Copy, Debug)]
enum Law {
    Equator,
    /// Sine and cosine of the height at which the nose meets the ball, as seen from its centre, and how slip turns into sticking.
    Nose {
        sine: f64,
        cosine: f64,
        stick_slip: StickSlip,
    },
    /// The same height; friction of the cloth meanwhile.
    Mathavan {
        sine: f64,
        cosine: f64,
        cloth: f64,
    },
}

impl Cushion {
    /// A table's cushion.
    pub fn of(table: &Table, rail: Rail) -> Self {
        let own = table.rail.own(rail);
        let restitution = own.e.unwrap_or(table.rail_restitution);
        let friction = own.mu.unwrap_or(table.rail_friction);
        let sine = own.height.or(table.rail.height).map_or(0.0, |height| height / table.radius - 1.0);
        let cosine = if sine == 0.0 { 1.0 } else { (1.0 - sine * sine).sqrt() };
        let law = match table.rail.model {
            RailModel::Equator => Law::Equator,
            RailModel::Nose => Law::Nose { sine, cosine, stick_slip: StickSlip::Sharp },
            RailModel::Smooth => {
                let most = 2.0 / 7.0 * table.rail.kappa.unwrap_or(1.0);
                Law::Nose { sine, cosine, stick_slip: StickSlip::Smooth { most } }
            }
            RailModel::Mathavan => Law::Mathavan { sine, cosine, cloth: table.sliding_friction },
        };
        Self { restitution, friction, law, fade: table.rail.fade }
    }

    /// With this restitution, however fast the impact, at the height of the ball's centre.
    #[must_use]
    pub fn with_restitution(self, restitution: f64) -> Self {
        Self { restitution, law: Law::Equator, fade: None, ..self }
    }

    /// Whether it meets slow and fast balls alike, at the height of their centres.
    fn is_plain(&self) -> bool {
        matches!(self.law, Law::Equator) && self.fade.is_none()
    }

    /// Velocity and spin after a collision of a ball on the cloth with this cushion, whose normal into the table is `n`.
    #[inline(always)]
    pub fn resolve(&self, radius: f64, n: DVec2, ball: &mut BallState) -> ImpactImpulse {
        if self.is_plain() {
            let normal = collide_rail(radius, self.restitution, self.friction, n, ball);
            return ImpactImpulse { normal, climb: 0.0 };
        }
        self.resolve_at_height(radius, n, ball)
    }

    /// A dead nose above the ball's centre takes less than the whole approach: it presses the ball down, too, which the cloth takes up. So
    /// they meet again at once, until the ball leaves; but one that climbs the nose is not held by the cloth.
    #[inline(never)]
    fn resolve_at_height(&self, radius: f64, n: DVec2, ball: &mut BallState) -> ImpactImpulse {
        let most_left = LEFT * ball.velocity.dot(n).abs();
        let mut whole = self.meet(radius, n, ball);
        for _ in 0..AGAIN {
            if ball.velocity.dot(n) >= -most_left || whole.climb > 0.0 {
                return whole;
            }
            let again = self.meet(radius, n, ball);
            whole = ImpactImpulse { normal: whole.normal + again.normal, climb: whole.climb + again.climb };
        }
        whole
    }

    /// One impact at the height of the nose.
    #[inline(always)]
    fn meet(&self, radius: f64, n: DVec2, ball: &mut BallState) -> ImpactImpulse {
        let restitution = self.restitution_at(-ball.velocity.dot(n));
        let [normal, climb] = match self.law {
            Law::Equator => [collide_rail(radius, restitution, self.friction, n, ball), 0.0],
            Law::Nose { sine, cosine, stick_slip } => {
                nose::collide(radius, restitution, self.friction, [sine, cosine], stick_slip, n, ball)
            }
            Law::Mathavan { sine, cosine, cloth } => {
                [mathavan::collide(radius, restitution, [self.friction, cloth], [sine, cosine], n, ball), 0.0]
            }
        };
        ImpactImpulse { normal, climb }
    }

    fn restitution_at(&self, approach: f64) -> f64 {
        self.fade.map_or(self.restitution, |fade| fade.at(self.restitution, approach))
    }

    /// The same for a ball in the air, which meets the nose in the direction `d` from its centre, a unit vector: with the
    /// cloth out of reach all models are an impact with Coulomb's friction. It leaves with the speed `slowest` at least, m/s.
    /// Returns the speed of its approach, m/s, negative if there is none.
    pub fn resolve_in_space(&self, radius: f64, slowest: f64, d: DVec3, ball: &mut SpatialState) -> f64 {
        let stick_slip = if let Law::Nose { stick_slip, .. } = self.law { stick_slip } else { StickSlip::Sharp };
        let restitution = self.restitution_at(ball.velocity.dot(d));
        nose::collide_in_space(radius, [restitution, self.friction, slowest], stick_slip, d, ball)
    }

    /// Sine and cosine of the height at which the nose meets a ball on the cloth, as seen from its centre.
    pub fn nose(&self) -> [f64; 2] {
        match self.law {
            Law::Equator => [0.0, 1.0],
            Law::Nose { sine, cosine, .. } | Law::Mathavan { sine, cosine, .. } => [sine, cosine],
        }
    }
}

/// A table's four cushions: mostly one for all.
#[derive(Clone, Debug)]
pub struct Cushions {
    all: Cushion,
    own: Option<Box<[Cushion; 4]>>,
}

impl Cushions {
    /// Those of a table.
    pub fn of(table: &Table) -> Self {
        let Rails { left, right, bottom, top, .. } = table.rail;
        let differ = left.is_some() || right.is_some() || bottom.is_some() || top.is_some();
        Self {
            all: Cushion::of(table, Rail::Left),
            own: differ.then(|| Box::new(Rail::ALL.map(|rail| Cushion::of(table, rail)))),
        }
    }

    /// The one of a rail.
    #[inline(always)]
    pub fn at(&self, rail: Rail) -> &Cushion {
        self.own.as_ref().map_or(&self.all, |own| &own[rail as usize])
    }

    /// All of them with this restitution, at the height of the ball's centre.
    #[must_use]
    pub fn with_restitution(&self, restitution: f64) -> Self {
        let own = self.own.as_ref().map(|own| Box::new(own.map(|cushion| cushion.with_restitution(restitution))));
        Self { all: self.all.with_restitution(restitution), own }
    }
}

#[cfg(test)]
mod tests;
