//! What an energy may be wrong by: rounding, and the tolerances of resting contacts.

use crate::{
    physics::FIRST_BOUNCE,
    table::{BALLS, Table},
};

/// Rounding of an energy is at most this share of the largest that entered it: some thirty operations on the way from the
/// state at a piece's start through its end to the next one's, half an ε each.
const SHARE: f64 = 32.0 * f64::EPSILON;

/// Speed to which the states of resting contacts are right, m/s: it moves a ball by 1e-9 m in ten seconds. What sticks is
/// only known to slip by less than that.
pub const RESTING_SPEED: f64 = 1e-10;

/// Speed at which the chatters of several coupled contacts end, in √(g R): so much of an impulse may be missing, and its friction with it.
const COUPLED_SPEED: f64 = 2e-8;

/// Place to which the courses of resting contacts are right, m: the work of a force is as uncertain as its way.
const RESTING_PLACE: f64 = 1e-10;

/// Share to which the work of frictions in a resting contact is known: that of its integration, and of slips that begin or
/// end on the way and are still slow.
const RESTING_WORK: f64 = 1e-5;

/// Slips and speeds below this may be stopped at once, m/s.
pub const STOPPED_SPEED: f64 = 1e-7;

/// What that takes at most, m²/s²: an impulse that stops a speed `s` takes `7/10 s²` per mass of a ball, however fast the
/// balls move besides.
const STOPPED_ENERGY: f64 = 0.7 * STOPPED_SPEED * STOPPED_SPEED;

/// How much what an impact takes changes with its normal, in shares of the energy over radians: of the approach `(1 - e²) v_n v_t` at
/// most, and of a slip `u`, which is 4 √E at most, `μ (1 + e) v u` and `2/7 u v`.
const TURNED: f64 = 5.0;

/// What has a doubtful energy.
#[derive(Clone, Copy, Debug, Default)]
pub struct Doubt {
    /// The largest energy that entered, m²/s².
    pub energy: f64,
    /// Time since the stroke, s.
    pub time: f64,
    /// Whether a resting contact takes part.
    pub rests: bool,
    /// Whether an impact takes part, or a contact that begins.
    pub is_struck: bool,
    /// How many impacts take part.
    pub impacts: usize,
    /// Whether several impacts leave a ball still: what stopped it is then told from their impulses only to
    /// [`STOPPED_SPEED`].
    pub stops: bool,
    /// How far a ball is moved on to what it hits, m: the normals of other contacts turn by as much over the distance of
    /// two balls.
    pub moved: f64,
}

impl Doubt {
    /// For energy that is gained, m²/s².
    pub fn of_a_gain(&self, table: &Table) -> f64 {
        let resting = if self.rests { RESTING_SPEED * (2.0 * self.energy).sqrt() } else { 0.0 };
        // |u| and R|w| are both at most 4 √E, and every friction's power is its coefficient times g times one of them. A
        // time is rounded, and meanwhile friction works.
        let coefficient =
            table.sliding_friction + table.rolling_friction + table.spinning_friction + 2.0 * table.rail_friction;
        let power = 4.0 * coefficient * table.gravity * (BALLS as f64 * self.energy).sqrt();
        // Balls that never slip and that no forces hold together are sent apart at this speed, each of three pairs at most.
        let first_bounce = FIRST_BOUNCE * (table.gravity * table.radius).sqrt();
        let parted = if table.ball_friction.is_none() { 3.0 * 0.25 * first_bounce * first_bounce } else { 0.0 };
        SHARE * self.energy + f64::EPSILON * self.time * power + resting + parted
    }

    /// For what is lost along a stretch where frictions do so much `work`, m²/s².
    pub fn on_the_way(&self, table: &Table, work: f64) -> f64 {
        let integrated = if self.rests { RESTING_WORK * work } else { 0.0 };
        self.of_a_gain(table) + self.of_a_place(table) + integrated
    }

    /// For what is lost at a change, m²/s².
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

    /// What an impulse may take wrongly because the speeds are uncertain: it works against a slip of at most 4 √E.
    fn of_an_impulse(&self, table: &Table) -> f64 {
        if !(self.rests && self.is_struck) {
            return 0.0;
        }
        let coefficient = table.rail_friction + table.ball_friction.unwrap_or(0.0);
        let coupled = coefficient * COUPLED_SPEED * (table.gravity * table.radius).sqrt();
        4.0 * self.energy.sqrt() * (RESTING_SPEED + if self.impacts > 1 { coupled } else { 0.0 })
    }

    /// What all frictions together take on the way that a place in a resting contact is uncertain by.
    fn of_a_place(&self, table: &Table) -> f64 {
        let coefficient = table.sliding_friction + table.rail_friction + table.ball_friction.unwrap_or(0.0);
        if self.rests { RESTING_PLACE * coefficient * table.gravity } else { 0.0 }
    }
}
