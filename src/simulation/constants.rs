//! Derived constants of a table, computed once per shot instead of at every event.

use glam::DVec2;

use super::tolerance::Tolerance;
use crate::{physics::Rolling, table::Table};

/// A table's constants in the form that the engine uses; all divisions are done here, once per shot.
#[derive(Clone, Copy, Debug)]
pub struct Constants {
    /// Length of the playing area, m.
    pub length: f64,
    /// Ball radius R, m.
    pub radius: f64,
    /// `1/R`, 1/m.
    pub per_radius: f64,
    /// Ball diameter, m.
    pub diameter: f64,
    /// Largest |x| and |y| of a ball's centre, m.
    pub reach: DVec2,
    /// Deceleration by sliding friction, `mu_s g`, m/s².
    pub sliding: f64,
    /// Duration of sliding per m/s of slip, `2 / 7 mu_s g` (thesis equation 25), s²/m.
    pub slide_time: f64,
    /// Deceleration law of a rolling ball.
    pub rolling: Rolling,
    /// Time in which a rolling ball loses 1 m/s at constant deceleration (thesis equation 26), s²/m.
    pub roll_time: f64,
    /// Whether the table is level and the deceleration of a rolling ball is constant, as in the thesis.
    pub has_one_band: bool,
    /// Whether the table is level.
    pub level: bool,
    /// Acceleration of a table that is not level, m/s².
    pub tilt: DVec2,
    /// Rate at which `|w_z|` decays, `5 mu_sp g / 2R` (thesis equation 8), rad/s².
    pub spinning: f64,
    /// Upward velocity above which a rail lifts a ball off the cloth, m/s; infinity if balls stay on it.
    pub least_climb: f64,
    /// Tolerances below which gaps, speeds and accelerations count as zero.
    pub tolerance: Tolerance,
}

impl Constants {
    /// Computes the constants of `table`.
    pub fn of(table: &Table) -> Self {
        let tolerance = Tolerance::of(table);
        let sliding = table.sliding_friction * table.gravity;
        let level = table.tilt == DVec2::ZERO;
        Self {
            length: table.length,
            radius: table.radius,
            per_radius: 1.0 / table.radius,
            diameter: 2.0 * table.radius,
            reach: table.reach(),
            sliding,
            slide_time: 1.0 / (3.5 * sliding),
            rolling: Rolling::of(table),
            roll_time: 1.0 / Rolling::of(table).least,
            has_one_band: level && table.rolling_growth == 0.0,
            level,
            tilt: table.tilt,
            spinning: 2.5 * table.spinning_friction * table.gravity / table.radius,
            least_climb: if table.flight.is_some() { tolerance.least_lift } else { f64::INFINITY },
            tolerance,
        }
    }
}
