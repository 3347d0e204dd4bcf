//! What the engine needs of a table, worked out once instead of at every event.

use glam::DVec2;

use crate::{
    physics::{rolling_deceleration, sliding_deceleration, spin_deceleration},
    table::Table,
};

/// A table's numbers in the form in which the engine uses them.
#[derive(Clone, Copy, Debug)]
pub struct Constants {
    /// Ball radius R, m.
    pub radius: f64,
    /// Largest |x| and |y| of a ball's centre, m.
    pub reach: DVec2,
    /// `mu_s g`, m/s².
    pub sliding: f64,
    /// `5/7 mu_r g`, m/s².
    pub rolling: f64,
    /// `5 mu_sp g / 2R`, rad/s².
    pub spinning: f64,
    /// Restitution between two balls.
    pub ball_restitution: f64,
    /// Friction between two balls; `None` for a contact that never slips.
    pub ball_friction: Option<f64>,
    /// Restitution at a cushion.
    pub rail_restitution: f64,
    /// Friction at a cushion.
    pub rail_friction: f64,
}

impl Constants {
    /// Works out the numbers of `table`.
    pub fn of(table: &Table) -> Self {
        Self {
            radius: table.radius,
            reach: table.reach(),
            sliding: sliding_deceleration(table),
            rolling: rolling_deceleration(table),
            spinning: spin_deceleration(table),
            ball_restitution: table.ball_restitution,
            ball_friction: table.ball_friction,
            rail_restitution: table.rail_restitution,
            rail_friction: table.rail_friction,
        }
    }
}
