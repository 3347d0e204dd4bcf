//! The cushions in the precision of the engine: one law per rail, and restitution that decreases with speed.

use super::Real;
use crate::{
    simulation::Rail,
    table::{Fade, RailModel, Table},
};

/// A restitution that decreases with the speed of the impact.
#[derive(Clone, Copy, Debug)]
pub struct RestitutionFade<R> {
    from: R,
    slope: R,
    least: R,
}

impl<R: Real> RestitutionFade<R> {
    /// Returns the parameters of a table's `fade`.
    pub fn of(fade: Fade) -> Self {
        Self { from: R::of(fade.from), slope: R::of(fade.slope), least: R::of(fade.least) }
    }

    /// Returns the restitution at a normal speed, m/s, if it is `slow` at low speed.
    pub fn at(&self, slow: R, speed: R) -> R {
        let beyond = speed - self.from;
        if beyond <= R::zero() { slow } else { (slow - self.slope * beyond).max(self.least.min(slow)) }
    }
}

/// The contact model of a cushion.
#[derive(Clone, Copy, Debug)]
pub enum RailLaw<R> {
    /// Contact at the height of the ball's centre.
    Equator,
    /// Contact at the height of the nose.
    Nose {
        /// Sine of the angle up to the nose, seen from the ball's centre: `(h - R) / R`.
        sine: R,
        /// Cosine of the same angle.
        cosine: R,
        /// Largest share of the slip that a smooth friction takes, `2 kappa / 7`; `None` for Coulomb's law up to sticking.
        most: Option<R>,
    },
    /// A model that integrates over the impulse, which this engine does not implement.
    Integrated,
}

/// One cushion.
#[derive(Clone, Copy, Debug)]
pub struct Cushion<R> {
    /// Restitution of slow impacts.
    pub restitution: R,
    /// Coulomb's coefficient.
    pub friction: R,
    /// The contact model.
    pub law: RailLaw<R>,
    /// Decrease of the restitution with speed, `None` if it is constant.
    pub fade: Option<RestitutionFade<R>>,
}

impl<R: Real> Cushion<R> {
    /// Returns sine and cosine of the angle up to the nose, seen from the centre of a ball on the cloth, and the largest share
    /// of the slip that a smooth friction takes.
    pub fn nose(&self) -> (R, R, Option<R>) {
        match self.law {
            RailLaw::Nose { sine, cosine, most } => (sine, cosine, most),
            RailLaw::Equator | RailLaw::Integrated => (R::zero(), R::of(1.0), None),
        }
    }

    /// Returns the restitution at a normal speed, m/s.
    pub fn restitution_at(&self, speed: R) -> R {
        self.fade.map_or(self.restitution, |fade| fade.at(self.restitution, speed))
    }

    /// Returns the cushion of a rail of `table`, whose `f64` count as exact.
    pub fn of(table: &Table, rail: Rail) -> Self {
        let (own, all, one) = (table.rail.overrides(rail), &table.rail, R::of(1.0));
        let height = own.height.or(all.height).unwrap_or(table.radius);
        let sine = R::of(height) / R::of(table.radius) - one;
        let cosine = (one - sine * sine).sqrt();
        let law = match all.model {
            RailModel::Equator => RailLaw::Equator,
            RailModel::Nose => RailLaw::Nose { sine, cosine, most: None },
            RailModel::Smooth => {
                RailLaw::Nose { sine, cosine, most: Some(R::ratio(2.0, 7.0) * R::of(all.kappa.unwrap_or(1.0))) }
            }
            RailModel::Mathavan => RailLaw::Integrated,
        };
        Self {
            restitution: R::of(own.e.unwrap_or(table.rail_restitution)),
            friction: R::of(own.mu.unwrap_or(table.rail_friction)),
            law,
            fade: all.fade.map(RestitutionFade::of),
        }
    }
}
