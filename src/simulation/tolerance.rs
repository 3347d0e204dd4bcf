//! The numbers that decide when something counts as nothing and depend on the table: each with its unit, its reason and what goes wrong
//! where it is chosen badly. Those that depend on no table stand beside what uses them.

use crate::{
    physics::{FIRST_BOUNCE, rolling_deceleration},
    table::Table,
};

/// What counts as nothing on one table. Lengths grow with the table's length `L`, since coordinates are rounded to a share
/// of it; speeds with `√(g R)`, accelerations with `g`.
#[derive(Clone, Copy, Debug)]
pub struct Tolerance {
    /// Gaps below this are contact, m. Coordinates are rounded to `ε L / 4`, gaps to a few times that. Larger: real gaps
    /// are closed too early. Smaller: contacts are lost.
    pub touching: f64,
    /// Impacts that follow each other within this time may be at one moment, s: the gaps then tell which of them are. A ball of
    /// 2e-2 √(gR) closes a gap that counts as none meanwhile. Smaller: rounding decides whether balls are struck together or in turn.
    /// Larger: the gaps are asked in vain.
    pub moment: f64,
    /// A gap that stays above this is not closed by any rounding, m. Smaller: a prediction that is rounded otherwise than
    /// the test could be missed. Larger: roots are sought in vain.
    pub surely_apart: f64,
    /// Bounces that are given up together with others are lower than this, m: so far a ball may be moved at the end of a
    /// chatter. A moving ball nearer than this touches what rests. Larger: the course jumps. Smaller: coupled contacts end their
    /// chatters one at a time.
    pub coupled_gap: f64,
    /// Speeds along a contact's normal below this are none, m/s: in ten seconds they move a ball by some 1e-10 m. Smaller:
    /// what rounding leaves of an impact counts as a bounce.
    pub opening: f64,
    /// Accelerations along a contact's normal below this do not press, m/s²: a hundred roundings of g. Smaller: rounding
    /// presses balls together that roll on side by side.
    pub pressing: f64,
    /// Slips below this are none, m/s. It is well above the error of the integration, so that what sticks is seen to
    /// stick; what is cut off would have moved a ball by less than 1e-10 m.
    pub slip: f64,
    /// A slip below this is stopped at once if it then holds, m/s: what it still does until it ends, an impulse does too,
    /// but for the change of the other forces meanwhile, which is of second order.
    pub ending_slip: f64,
    /// Slips up to this may have begun slowly, m/s: their friction acts against their rate. Larger: the direction is wrong for
    /// longer. Smaller: the steps get as short as the direction is stiff.
    pub yielding: f64,
    /// Balls in resting contact that are all slower than this are at rest, m/s, unless another one that moves touches them: they would
    /// roll on for less than 1e-11 m, in ever smaller steps as their slips fade with their speeds.
    pub still: f64,
    /// Shortest step of a resting contact, s: frictions change a speed by less than a two-hundredth of what counts as a slip
    /// meanwhile, and it is never more than 1e-13 s.
    /// Larger: what ends is overshot, and flips. Smaller: steps are rounded away.
    pub shortest_step: f64,
    /// In shorter steps, s, the places at both ends, which are rounded, say less of the velocity than the velocities do where both agree.
    pub shortest_quintic: f64,
    /// Estimated error that a step of a resting contact may make, in m, m/s, or R times rad/s. A contact takes some tens
    /// of steps.
    pub step: f64,
    /// Forces per mass that are broken or missing by less than this count as rounding, m/s².
    pub slack: f64,
    /// Bounces slower than this may be the end of a chatter, m/s: the test costs nothing where it cannot matter. It grows
    /// with the number of bounces that a chatter has.
    pub slow_bounce: f64,
    /// What a rail lifts more slowly than this stays on the cloth, m/s.
    pub least_lift: f64,
    /// A chatter ends at this bounce speed whatever presses the ball, m/s: a slip about to end, or another ball behind it.
    /// Its bounces are 1e-19 m high, and what is left of them moves a ball by less than 1e-9 m.
    pub slowest_bounce: f64,
    /// A chatter of several coupled contacts ends at this bounce speed, m/s, where the bounces make slips: the places are then right to as
    /// many metres.
    pub slowest_coupled_bounce: f64,
    /// The `slowest_bounce` of bounces that lose nothing and go on as long as the ball is pressed, m/s: they are less than 1e-16 m high, and
    /// there are tens of millions of them a second. Larger: a ball that is pressed no more has lost the speed with which it would
    /// leave.
    pub slowest_lossless_bounce: f64,
    /// No bounce in the air, on a nose or on another ball, is slower than this, m/s: it is a quarter of a micrometre high.
    pub slowest_in_air: f64,
    /// Where nothing rests any more, bounces slower than this lose nothing, m/s: they are lower than a micrometre. Larger: balls that are
    /// pressed together are farther apart. Smaller: there are more bounces.
    pub fastest_micro_collision: f64,
    /// How far apart balls and cushions are put by such a bounce, m: those that begin from rest come to some speed by falling through it.
    /// Larger: the course jumps. Smaller: it takes more bounces.
    pub micro_room: f64,
    /// Balls that never slip and that no forces hold together begin to bounce at this speed, m/s: above the slowest bounce,
    /// so that the chatter does not end at once.
    pub first_bounce: f64,
    /// A contact that closes again sooner than this has not ended, s: balls that never slip on each other may press only while one of
    /// them slips on the cloth; when that ends they bounce, and the bounce makes it slip again. Four times as long as the friction of
    /// sliding takes to undo the `first_bounce`. Larger: contacts end late. Smaller: each of these bounces is told as an end.
    pub shortest_parting: f64,
    /// Error in speed that ending a chatter early may make, m/s: 1e-11 m after ten seconds.
    pub negligible: f64,
    /// The same where several contacts are coupled, whose bounces do not fade in order, m/s: 1e-9 m after ten seconds.
    pub negligible_coupled: f64,
}

/// How many times as many bounces a chatter has as at a restitution of 0.95, from as many up to ten times: in inverse proportion
/// to what is lost. Without loss none ends.
fn liveliness(table: &Table) -> f64 {
    let lost = 1.0 - table.largest_restitution();
    if lost > 0.0 { (0.05 / lost).clamp(1.0, 10.0) } else { 1.0 }
}

impl Tolerance {
    /// What counts as nothing on `table`.
    pub fn of(table: &Table) -> Self {
        let speed = (table.gravity * table.radius).sqrt();
        let friction = table.sliding_friction.max(table.spinning_friction) * table.gravity;
        Self {
            touching: 16.0 * f64::EPSILON * table.length.max(table.width),
            moment: 800.0 * f64::EPSILON * table.length.max(table.width) / speed,
            surely_apart: 1.6e5 * f64::EPSILON * table.length.max(table.width),
            coupled_gap: 1.6e4 * f64::EPSILON * table.length.max(table.width),
            opening: 2e-11 * speed,
            pressing: 1e-14 * table.gravity.min(5.0 * friction),
            slip: 2e-10 * speed,
            ending_slip: 4e-10 * speed,
            yielding: 1e-5 * speed,
            still: (2e-11 * rolling_deceleration(table)).sqrt(),
            shortest_step: (8e-13 * speed / friction).min(1e-13),
            shortest_quintic: 8.7e10 * f64::EPSILON * table.length.max(table.width) / speed,
            step: 2e-13 * speed.max(table.radius),
            slack: 1e-12 * table.gravity.min(5.0 * friction),
            slow_bounce: 2e-2 * speed * liveliness(table),
            least_lift: 2e-2 * speed,
            slowest_bounce: 2e-10 * speed,
            slowest_lossless_bounce: 2e-8 * speed,
            slowest_in_air: 4e-3 * speed,
            fastest_micro_collision: 1e-3 * speed,
            micro_room: 7e5 * f64::EPSILON * table.length.max(table.width),
            first_bounce: FIRST_BOUNCE * speed,
            shortest_parting: 4.0 * FIRST_BOUNCE * speed / (table.sliding_friction * table.gravity),
            slowest_coupled_bounce: 2e-8 * speed,
            negligible: 2e-12 * speed,
            negligible_coupled: 2e-10 * speed,
        }
    }
}
