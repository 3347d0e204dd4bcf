//! When bouncing becomes resting: the end of a chatter, whose bounces would go on for ever in a finite time.
//!
//! A ball that leaves with speed `s` and is pulled back with acceleration `p` bounces for `T = 2s / (p (1 - e))` in all.
//! Instead, the chatter can end at once with one inelastic impact followed by a resting contact. Both give the same
//! impulse, since both bring the speed to zero, and the same first moment of it, since both bring the gap to zero; so the
//! forces that follow the slip see the same slip on average. The second moments differ by twice the area under the gap,
//! `4 s³ / (3 p² (1 - e³))`, and what is left of the chatter is half of that over the square of the time in which the
//! friction's direction turns.

use super::{
    Constants, Segment,
    touches::{SLOWEST_OPENING, Touches},
};
use crate::{
    physics::{BallState, ENDING_SLIP, Laws, Motion, Touch, contact_forces},
    table::{BALLS, Table},
};

/// Error in speed that ending a chatter early may make, m/s: 1e-11 m after ten seconds.
const NEGLIGIBLE: f64 = 1e-12;

/// Below this speed a chatter ends whatever presses the ball, m/s: a slip about to end, or another ball behind it. What
/// is lost moves a ball by less than 1e-9 m, but for two slow balls in one shot of a thousand on `thesis`.
const SLOWEST_BOUNCE: f64 = 1e-10;

/// A bounce of two balls makes a slip of this many times its speed at most, and so does one against a cushion.
const MADE_BY_BOUNCES: f64 = 4.0;

/// Speeds above this never settle, m/s: the test costs nothing where it matters.
pub const FASTEST: f64 = 1e-4;

/// The bounces of one contact shake others, and the slip of the balls, by this many times their speed at most.
const SHAKEN: f64 = 10.0;

/// Whether the balls of a contact that has just bounced, and opens in the state `balls`, will come to rest there.
#[cold]
pub fn settles(
    table: &Table,
    constants: &Constants,
    touch: &Touch,
    balls: &[BallState; BALLS],
    coarseness: f64,
) -> bool {
    let speed = touch.opening_speed(balls);
    if speed > FASTEST {
        return false;
    }
    if speed <= coarseness * SLOWEST_BOUNCE {
        return true;
    }
    let free = balls.map(|ball| Segment::free(constants, 0.0, &ball));
    let mut others = Touches::of(constants, balls, SLOWEST_OPENING.max(SHAKEN * speed));
    others.retain(|other| other != touch && other.shares_a_ball(touch));
    let accelerations = if others.as_slice().is_empty() {
        std::array::from_fn(|ball| 2.0 * free[ball].0.half_acceleration)
    } else {
        // What the bounces shake loose holds on average.
        let laws = Laws::of(table.radius, balls, others.as_slice(), ENDING_SLIP.max(SHAKEN * speed));
        contact_forces(table, balls, others.as_slice(), &laws, None).linear
    };
    let pull = -touch.opening_acceleration(balls, &accelerations);
    let slide = |ball: usize| {
        let (segment, lasts) = &free[ball];
        // A slip that the bounces make, in proportion to their speed, does not set the pace.
        let slip = 3.5 * constants.sliding * lasts;
        if segment.motion == Motion::Sliding && slip > MADE_BY_BOUNCES * speed { *lasts } else { f64::INFINITY }
    };
    let shortest = |touch: &Touch| slide(touch.first).min(touch.second.map_or(f64::INFINITY, slide));
    let slide = others.as_slice().iter().map(shortest).fold(shortest(touch), f64::min);
    let restitution = if touch.second.is_some() { constants.ball_restitution } else { constants.rail_restitution };
    settles_in_time(speed, pull, restitution, slide)
}

/// `slide` is the time in which the slip, and so the direction of its friction, is used up.
fn settles_in_time(speed: f64, pull: f64, restitution: f64, slide: f64) -> bool {
    if speed <= SLOWEST_BOUNCE {
        return true;
    }
    if pull <= 0.0 {
        return false;
    }
    let chatter = 2.0 * speed / (pull * (1.0 - restitution));
    let moment = 4.0 * speed.powi(3) / (3.0 * pull * pull * (1.0 - restitution.powi(3)));
    if chatter > slide { speed <= NEGLIGIBLE } else { 0.5 * moment <= NEGLIGIBLE * slide * slide }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slow_ball_that_is_pulled_back_settles_and_one_that_is_not_leaves() {
        assert!(settles_in_time(1e-9, 2.0, 0.3, 0.5));
        assert!(!settles_in_time(1e-9, -2.0, 0.3, 0.5));
        assert!(!settles_in_time(1e-3, 2.0, 0.3, 0.5));
    }

    #[test]
    fn without_loss_a_bounce_settles_only_when_it_cannot_be_seen() {
        assert!(!settles_in_time(1e-9, 2.0, 1.0, 0.5));
        assert!(settles_in_time(1e-10, 2.0, 1.0, 0.5));
    }
}
