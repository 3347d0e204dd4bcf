//! What the cushions are in the engine's own precision: one law a rail, and restitution that falls with speed.

use super::Real;
use crate::{
    simulation::Rail,
    table::{Fade, RailModel, Table},
};

/// A restitution that falls with the speed of the impact.
#[derive(Clone, Copy, Debug)]
pub struct Falling<R> {
    from: R,
    slope: R,
    least: R,
}

impl<R: Real> Falling<R> {
    /// The numbers of a table's `fade`.
    pub fn of(fade: Fade) -> Self {
        Self { from: R::of(fade.from), slope: R::of(fade.slope), least: R::of(fade.least) }
    }

    /// What is left of the restitution `slow` at a normal speed, m/s.
    pub fn at(&self, slow: R, speed: R) -> R {
        let beyond = speed - self.from;
        if beyond <= R::zero() { slow } else { (slow - self.slope * beyond).max(self.least.min(slow)) }
    }
}

/// How a cushion meets a ball.
#[derive(Clone, Copy, Debug)]
pub enum Meeting<R> {
    /// At the height of the ball's centre.
    Equator,
    /// At the nose's height: sine and cosine of the angle up to it as seen from the ball's centre; the most of the slip that
    /// a smooth friction takes, `None` for Coulomb's law up to no slip.
    Nose {
        /// `(h - R) / R`.
        sine: R,
        /// Its cosine.
        cosine: R,
        /// `2 kappa / 7`.
        most: Option<R>,
    },
    /// By a model that this engine has not: the impulse is integrated.
    Integrated,
}

/// One cushion.
#[derive(Clone, Copy, Debug)]
pub struct Cushion<R> {
    /// Restitution of a slow impact.
    pub restitution: R,
    /// Coulomb's coefficient.
    pub friction: R,
    /// How it meets a ball.
    pub meeting: Meeting<R>,
    /// How its restitution falls.
    pub falling: Option<Falling<R>>,
}

impl<R: Real> Cushion<R> {
    /// Sine and cosine of the angle up to the nose as seen from the centre of a ball on the cloth, and the most of the slip that
    /// a smooth friction takes.
    pub fn nose(&self) -> (R, R, Option<R>) {
        match self.meeting {
            Meeting::Nose { sine, cosine, most } => (sine, cosine, most),
            Meeting::Equator | Meeting::Integrated => (R::zero(), R::of(1.0), None),
        }
    }

    /// Restitution at a normal speed, m/s.
    pub fn restitution_at(&self, speed: R) -> R {
        self.falling.map_or(self.restitution, |falling| falling.at(self.restitution, speed))
    }

    /// A rail of `table`, whose `f64` are taken as exact.
    pub fn of(table: &Table, rail: Rail) -> Self {
        let (own, all, one) = (table.rail.own(rail), &table.rail, R::of(1.0));
        let height = own.height.or(all.height).unwrap_or(table.radius);
        let sine = R::of(height) / R::of(table.radius) - one;
        let cosine = (one - sine * sine).sqrt();
        let meeting = match all.model {
            RailModel::Equator => Meeting::Equator,
            RailModel::Nose => Meeting::Nose { sine, cosine, most: None },
            RailModel::Smooth => {
                Meeting::Nose { sine, cosine, most: Some(R::ratio(2.0, 7.0) * R::of(all.kappa.unwrap_or(1.0))) }
            }
            RailModel::Mathavan => Meeting::Integrated,
        };
        Self {
            restitution: R::of(own.e.unwrap_or(table.rail_restitution)),
            friction: R::of(own.mu.unwrap_or(table.rail_friction)),
            meeting,
            falling: all.fade.map(Falling::of),
        }
    }
}
