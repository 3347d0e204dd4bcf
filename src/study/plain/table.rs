//! A table's numbers in the engine's own precision.

use super::{Real, Vector};
use crate::{simulation::Rail, table::Table};

/// What the equations need of a table, in SI units.
#[derive(Clone, Copy, Debug)]
pub struct Numbers<R> {
    /// Ball radius `R`.
    pub radius: R,
    /// Mass over moment of inertia, `5/(2R²)`, 1/m².
    pub turnability: R,
    /// Largest |x| of a ball's centre, `L/2 - R`.
    pub half_length: R,
    /// Largest |y| of a ball's centre, `l/2 - R`.
    pub half_width: R,
    /// `mu_s g`, m/s².
    pub slide: R,
    /// `mu_r g`, m/s².
    pub roll: R,
    /// Decay of `w_z`: `5 mu_sp g / 2R`, rad/s².
    pub twist: R,
    /// Restitution between balls.
    pub ball_restitution: R,
    /// Friction between balls, `None` for a contact that never slips.
    pub ball_friction: Option<R>,
    /// Restitution at a cushion.
    pub rail_restitution: R,
    /// Friction at a cushion.
    pub rail_friction: R,
    /// Ball mass over cue mass.
    pub mass_ratio: R,
}

impl<R: Real> Numbers<R> {
    /// The numbers of `table`, whose `f64` are taken as exact.
    pub fn of(table: &Table) -> Self {
        let (radius, gravity, half) = (R::of(table.radius), R::of(table.gravity), R::of(0.5));
        Self {
            radius,
            turnability: R::of(2.5) / (radius * radius),
            half_length: half * R::of(table.length) - radius,
            half_width: half * R::of(table.width) - radius,
            slide: R::of(table.sliding_friction) * gravity,
            roll: R::of(table.rolling_friction) * gravity,
            twist: R::of(2.5) * R::of(table.spinning_friction) * gravity / radius,
            ball_restitution: R::of(table.ball_restitution),
            ball_friction: table.ball_friction.map(R::of),
            rail_restitution: R::of(table.rail_restitution),
            rail_friction: R::of(table.rail_friction),
            mass_ratio: R::of(table.ball_mass) / R::of(table.cue_mass),
        }
    }

    /// How far a ball's centre can go towards `rail`.
    pub fn reach(&self, rail: Rail) -> R {
        match rail {
            Rail::Left | Rail::Right => self.half_length,
            Rail::Bottom | Rail::Top => self.half_width,
        }
    }
}

/// Unit vector from a cushion into the table.
pub fn normal<R: Real>(rail: Rail) -> Vector<R> {
    let (zero, one) = (R::zero(), R::of(1.0));
    match rail {
        Rail::Left => Vector::new(one, zero, zero),
        Rail::Right => Vector::new(-one, zero, zero),
        Rail::Bottom => Vector::new(zero, one, zero),
        Rail::Top => Vector::new(zero, -one, zero),
    }
}
