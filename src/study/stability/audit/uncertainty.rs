//! The uncertainty of an energy: rounding, and the tolerances of resting contacts.

use crate::{
    physics::FIRST_BOUNCE,
    table::{BALLS, Rail, Table},
};

/// Rounding of an energy relative to the largest involved energy, at most: some thirty operations from the state at a piece's
/// start through its end to the next piece's, half an ε each.
const SHARE: f64 = 32.0 * f64::EPSILON;

/// Accuracy of the speeds in resting contacts, m/s: it moves a ball by 1e-9 m in ten seconds. A sticking contact may slip by as
/// much.
pub const RESTING_SPEED: f64 = 1e-10;

/// Speed at which the chatters of several coupled contacts end, in √(g R): an impulse of this size may be missing, and its
/// friction with it.
const COUPLED_SPEED: f64 = 2e-8;

/// Accuracy of the positions in resting contacts, m: the distance over which a force works is as uncertain.
const RESTING_PLACE: f64 = 1e-10;

/// Relative accuracy of the work of frictions in a resting contact: that of the integration, and of slips that begin or end on
/// the way and are still slow.
const RESTING_WORK: f64 = 1e-5;

/// Slips and speeds below this may be set to zero, m/s.
pub const STOPPED_SPEED: f64 = 1e-7;

/// Maximum energy that this dissipates, m²/s²: an impulse that stops a speed `s` dissipates `7/10 s²` per mass of a ball, at
/// any other speed of the balls.
const STOPPED_ENERGY: f64 = 0.7 * STOPPED_SPEED * STOPPED_SPEED;

/// Change of the energy that an impact dissipates with its normal, as a share of the energy per radian: at most `(1 - e²) v_n
/// v_t` from the approach and, from a slip `u` of at most 4 √E, `μ (1 + e) v u` and `2/7 u v`.
const TURNED: f64 = 5.0;

/// The circumstances that determine the uncertainty of an energy.
#[derive(Clone, Copy, Debug, Default)]
pub struct Uncertainty {
    /// The largest involved energy, m²/s².
    pub energy: f64,
    /// Time since the stroke, s.
    pub time: f64,
    /// Whether a resting contact is involved.
    pub rests: bool,
    /// Whether an impact is involved, or a contact that begins.
    pub is_struck: bool,
    /// Number of impacts.
    pub impacts: usize,
    /// Whether several impacts leave a ball at rest: their impulses then determine what stopped it only to [`STOPPED_SPEED`].
    pub stops: bool,
    /// Displacement of a ball onto the body that it hits, m: the normals of other contacts rotate by this over the distance of
    /// two balls.
    pub moved: f64,
}

impl Uncertainty {
    /// Returns the tolerance of a gain of energy, m²/s².
    pub fn of_a_gain(&self, table: &Table) -> f64 {
        let resting = if self.rests { RESTING_SPEED * (2.0 * self.energy).sqrt() } else { 0.0 };
        // |u| and R|w| are both at most 4 √E, and the power of every friction is its coefficient times g times one of them. A
        // time is rounded, and friction works during this rounding error.
        let coefficient =
            table.sliding_friction + table.rolling_friction + table.spinning_friction + 2.0 * rail_friction(table);
        let power = 4.0 * coefficient * table.gravity * (BALLS as f64 * self.energy).sqrt();
        // Balls that never slip, and that no forces hold together, separate at this speed, each of three pairs at most once.
        let first_bounce = FIRST_BOUNCE * (table.gravity * table.radius).sqrt();
        let parted = if table.ball_friction.is_none() { 3.0 * 0.25 * first_bounce * first_bounce } else { 0.0 };
        SHARE * self.energy + f64::EPSILON * self.time * power + resting + parted
    }

    /// Returns the tolerance of a loss on a stretch on which frictions do `work`, m²/s².
    pub fn on_the_way(&self, table: &Table, work: f64) -> f64 {
        let integrated = if self.rests { RESTING_WORK * work } else { 0.0 };
        self.of_a_gain(table) + self.of_a_place(table) + integrated
    }

    /// Returns the tolerance of a loss at a change, m²/s².
    pub fn at_a_change(&self, table: &Table) -> f64 {
        let stopped = if self.stops { STOPPED_SPEED * (2.0 * self.energy).sqrt() } else { 0.0 };
        let turned = TURNED * self.moved / (2.0 * table.radius) * self.energy;
        self.of_a_gain(table)
            + self.of_a_place(table)
            + self.of_an_impulse(table)
            + BALLS as f64 * STOPPED_ENERGY
            + stopped
            + turned
    }

    /// Returns the error of an impulse's work because of uncertain speeds: it works against a slip of at most 4 √E.
    fn of_an_impulse(&self, table: &Table) -> f64 {
        if !(self.rests && self.is_struck) {
            return 0.0;
        }
        let coefficient = rail_friction(table) + table.ball_friction.unwrap_or(0.0);
        let coupled = coefficient * COUPLED_SPEED * (table.gravity * table.radius).sqrt();
        4.0 * self.energy.sqrt() * (RESTING_SPEED + if self.impacts > 1 { coupled } else { 0.0 })
    }

    /// Returns the work of all frictions over the uncertainty of a position in a resting contact.
    fn of_a_place(&self, table: &Table) -> f64 {
        let coefficient = table.sliding_friction + rail_friction(table) + table.ball_friction.unwrap_or(0.0);
        if self.rests { RESTING_PLACE * coefficient * table.gravity } else { 0.0 }
    }
}

/// Returns the largest coefficient of friction of a cushion.
fn rail_friction(table: &Table) -> f64 {
    Rail::ALL.iter().fold(0.0, |most, rail| table.friction_of(*rail).max(most))
}
