//! Table-dependent tolerances, each with its unit, its reason and the effect of a bad choice. Tolerances that do not depend on the table
//! are defined where they are used.

use crate::{
    physics::{FIRST_BOUNCE, Rolling},
    table::Table,
};

/// Tolerances of one table. Lengths scale with the table's length `L`, because coordinates are rounded to a share of it; speeds scale with
/// `√(g R)`, accelerations with `g`.
#[derive(Clone, Copy, Debug)]
pub struct Tolerance {
    /// Gaps below this count as contact, m. Coordinates are rounded to `ε L / 4`, gaps to a few times that. Larger: real gaps are closed
    /// too early. Smaller: contacts are lost.
    pub touching: f64,
    /// Impacts within this time may be simultaneous, s; their gaps decide. In this time, a ball with the speed 2e-2 √(gR) closes a gap of
    /// the touching tolerance. Smaller: rounding decides whether balls are struck together or in turn. Larger: gaps are checked needlessly.
    pub simultaneous: f64,
    /// A gap that stays above this cannot be closed by rounding, m. Smaller: a prediction with other rounding than the test could be
    /// missed. Larger: roots are sought needlessly.
    pub certain_gap: f64,
    /// Bounces that are given up together with others are lower than this, m: a ball may be moved by this much at the end of a chatter. A
    /// moving ball nearer than this touches resting balls. A gap that closes too slowly for an impact may become this negative. Larger:
    /// trajectories jump. Smaller: coupled contacts end their chatters one at a time, and weak forces cause many impacts.
    pub coupled_gap: f64,
    /// Speeds along a contact's normal below this count as zero, m/s: in ten seconds they move a ball by some 1e-10 m. Smaller: the
    /// rounding error of an impact counts as a bounce.
    pub opening: f64,
    /// Accelerations along a contact's normal below this do not press, m/s²: a hundred roundings of g. Smaller: rounding presses balls
    /// together that roll side by side.
    pub pressing: f64,
    /// Slips below this count as zero, m/s. This is well above the integration error, so that sticking is detected; the neglected slip
    /// would move a ball by less than 1e-10 m.
    pub slip: f64,
    /// A slip below this is stopped at once if friction can then hold it, m/s. An impulse has the same effect as the rest of the slip,
    /// except for the simultaneous change of the other forces, which is of second order.
    pub ending_slip: f64,
    /// Slips up to this may have begun slowly, m/s: their friction opposes their rate. Larger: the direction is wrong for longer. Smaller:
    /// the stiffness of the direction makes the steps short.
    pub yielding: f64,
    /// Balls in resting contact that are all slower than this are at rest, m/s, unless another moving ball touches them. They would roll
    /// for less than 1e-11 m, in ever smaller steps, because their slips fade with their speeds.
    pub still: f64,
    /// Shortest step of a resting contact, s. Frictions change a speed by less than a two-hundredth of the slip tolerance in it, and it is
    /// never more than 1e-13 s. Larger: transitions are overshot and reverse. Smaller: steps vanish in rounding.
    pub shortest_step: f64,
    /// In shorter steps, s, the rounded positions at both ends determine the velocity less accurately than the velocities themselves,
    /// provided that both agree.
    pub shortest_quintic: f64,
    /// Accepted estimated error of a step of a resting contact, in m, m/s, or R times rad/s. A contact takes some tens of steps.
    pub step_error: f64,
    /// Violations or differences of forces per mass below this count as rounding errors, m/s².
    pub force_error: f64,
    /// Bounces slower than this may be the end of a chatter, m/s; for faster ones the test is skipped, because it cannot matter. Scales
    /// with the number of bounces of a chatter.
    pub slow_bounce: f64,
    /// A ball that a rail lifts more slowly than this stays on the cloth, m/s.
    pub least_lift: f64,
    /// A chatter ends at this bounce speed whatever presses the ball, m/s, be it a slip about to end or another ball behind it. Its bounces
    /// are less than 1e-19 m high, and the rest of them moves a ball by less than 1e-9 m.
    pub slowest_bounce: f64,
    /// A chatter of several coupled contacts whose bounces create slips ends at this bounce speed, m/s; its value in metres is the
    /// resulting accuracy of the positions.
    pub slowest_coupled_bounce: f64,
    /// The `slowest_bounce` for bounces without loss, which continue as long as the ball is pressed, m/s. They are less than 1e-16 m high,
    /// and there are tens of millions of them a second. Larger: a ball that is no longer pressed has lost the speed with which it would
    /// leave.
    pub slowest_lossless_bounce: f64,
    /// Smallest separation speed in the air, on a nose or another ball, m/s: such a bounce is a quarter of a micrometre high.
    pub slowest_in_air: f64,
    /// After resting contacts are disabled, bounces slower than this lose nothing, m/s: they are lower than a micrometre. Larger: pressed
    /// balls are farther apart. Smaller: there are more bounces.
    pub fastest_micro_collision: f64,
    /// Gap that such a bounce creates between balls and cushions, m: balls that start from rest gain some speed by crossing it. Larger:
    /// trajectories jump. Smaller: more bounces are needed.
    pub micro_gap: f64,
    /// First bounce speed of balls that never slip in a state without consistent forces, m/s: above the slowest bounce, so that the chatter
    /// does not end at once.
    pub first_bounce: f64,
    /// A contact that closes again sooner than this has not ended, s. Balls that never slip on each other may press only while one of them
    /// slips on the cloth; when that slip ends they bounce, and the bounce makes the ball slip again. Four times as long as sliding
    /// friction takes to cancel the `first_bounce`. Larger: contacts end late. Smaller: each of these bounces is reported as an end.
    pub shortest_parting: f64,
    /// Accepted speed error of ending a chatter early, m/s: 1e-11 m after ten seconds.
    pub negligible: f64,
    /// The same if several contacts are coupled, whose bounces do not fade regularly, m/s: 1e-9 m after ten seconds.
    pub negligible_coupled: f64,
}

/// Returns the number of bounces of a chatter relative to that at a restitution of 0.95, limited to 1 to 10: it is inversely proportional
/// to the loss. Chatters without loss do not end, and have the factor 1.
fn liveliness(table: &Table) -> f64 {
    let lost = 1.0 - table.largest_restitution();
    if lost > 0.0 { (0.05 / lost).clamp(1.0, 10.0) } else { 1.0 }
}

impl Tolerance {
    /// Returns the tolerances of `table`.
    pub fn of(table: &Table) -> Self {
        let speed = (table.gravity * table.radius).sqrt();
        let friction = table.sliding_friction.max(table.spinning_friction) * table.gravity;
        // Coordinates are rounded to a quarter of this, m.
        let rounding = f64::EPSILON * table.length.max(table.width);
        Self {
            touching: 16.0 * rounding,
            simultaneous: 800.0 * rounding / speed,
            certain_gap: 1.6e5 * rounding,
            coupled_gap: 1.6e4 * rounding,
            opening: 2e-11 * speed,
            pressing: 1e-14 * table.gravity.min(5.0 * friction),
            slip: 2e-10 * speed,
            ending_slip: 4e-10 * speed,
            yielding: 1e-5 * speed,
            still: (2e-11 * Rolling::of(table).least).sqrt(),
            shortest_step: (8e-13 * speed / friction).min(1e-13),
            shortest_quintic: 8.7e10 * rounding / speed,
            step_error: 2e-13 * speed.max(table.radius),
            force_error: 1e-12 * table.gravity.min(5.0 * friction),
            slow_bounce: 2e-2 * speed * liveliness(table),
            least_lift: 2e-2 * speed,
            slowest_bounce: 2e-10 * speed,
            slowest_lossless_bounce: 2e-8 * speed,
            slowest_in_air: 4e-3 * speed,
            fastest_micro_collision: 1e-3 * speed,
            micro_gap: 7e5 * rounding,
            first_bounce: FIRST_BOUNCE * speed,
            shortest_parting: 4.0 * FIRST_BOUNCE * speed / (table.sliding_friction * table.gravity),
            slowest_coupled_bounce: 2e-8 * speed,
            negligible: 2e-12 * speed,
            negligible_coupled: 2e-10 * speed,
        }
    }
}
