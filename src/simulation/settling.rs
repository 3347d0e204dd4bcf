//! When bouncing becomes resting: the end of a chatter, whose bounces would go on for ever in a finite time.
//!
//! A ball that leaves with speed `s` and is pulled back with acceleration `p` bounces for `T = 2s / (p (1 - e))` in all.
//! Instead, the chatter can end at once with one inelastic impact followed by a resting contact. Both give the same
//! impulse, since both bring the speed to zero, and the same first moment of it, since both bring the gap to zero; so the
//! forces that follow the slip see the same slip on average. What is left is of third order: `s` times the square of the
//! share by which the friction's direction turns in the time `T`.

use glam::DVec2;

use super::{Constants, Segment};
use crate::physics::{BallState, Motion};

/// Error in speed that ending a chatter early may make, m/s: 1e-11 m after ten seconds.
const NEGLIGIBLE: f64 = 1e-12;

/// Below this speed a chatter ends whatever presses the ball, m/s: a slip about to end, or another ball behind it. What
/// is lost moves a ball by less than 1e-9 m.
const SLOWEST_BOUNCE: f64 = 1e-10;

/// A slip is one of its own if it lasts for this many bounces.
const LASTING_FLIGHTS: f64 = 10.0;

/// Speeds above this never settle, m/s: the test costs nothing where it matters.
const FASTEST: f64 = 1e-4;

/// Whether a ball that has just left the cushion with normal `n` will come to rest on it.
pub fn settles_on_cushion(constants: &Constants, n: DVec2, ball: &BallState) -> bool {
    let speed = ball.velocity.dot(n);
    if speed > FASTEST {
        return false;
    }
    let (segment, lasts) = Segment::free(constants, 0.0, ball);
    let pull = -2.0 * segment.half_acceleration.dot(n);
    settles(speed, pull, constants.rail_restitution, lasts)
}

/// Whether two balls that have just collided will come to rest against each other.
pub fn settles_together(constants: &Constants, first: &BallState, second: &BallState) -> bool {
    let apart = first.position - second.position;
    let relative = first.velocity - second.velocity;
    let n = apart.normalize();
    let speed = relative.dot(n);
    if speed > FASTEST {
        return false;
    }
    let (a, a_lasts) = Segment::free(constants, 0.0, first);
    let (b, b_lasts) = Segment::free(constants, 0.0, second);
    let across = relative.perp_dot(n);
    let centrifugal = across * across / apart.length();
    let pull = -2.0 * (a.half_acceleration - b.half_acceleration).dot(n) - centrifugal;
    // A slip that ends before many bounces is made by them, in proportion: it does not set the pace.
    let flight = 2.0 * speed / pull;
    let slide = |segment: &Segment, lasts: f64| {
        if segment.motion == Motion::Sliding && lasts > LASTING_FLIGHTS * flight { lasts } else { f64::INFINITY }
    };
    settles(speed, pull, constants.ball_restitution, slide(&a, a_lasts).min(slide(&b, b_lasts)))
}

/// `slide` is the time in which the slip, and so the direction of its friction, is used up.
fn settles(speed: f64, pull: f64, restitution: f64, slide: f64) -> bool {
    if speed <= SLOWEST_BOUNCE {
        return true;
    }
    if pull <= 0.0 {
        return false;
    }
    let chatter = 2.0 * speed / (pull * (1.0 - restitution));
    let turned = (chatter / slide).min(1.0);
    speed * turned * turned <= NEGLIGIBLE
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slow_ball_that_is_pulled_back_settles_and_one_that_is_not_leaves() {
        assert!(settles(1e-9, 2.0, 0.3, 0.5));
        assert!(!settles(1e-9, -2.0, 0.3, 0.5));
        assert!(!settles(1e-3, 2.0, 0.3, 0.5));
    }

    #[test]
    fn without_loss_a_bounce_settles_only_when_it_cannot_be_seen() {
        assert!(!settles(1e-9, 2.0, 1.0, 0.5));
        assert!(settles(1e-10, 2.0, 1.0, 0.5));
    }
}
