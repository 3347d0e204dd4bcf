//! Resting contact: the forces on balls that are pressed against cushions or each other, the limit of infinitely many
//! ever smaller bounces.
//!
//! Every force obeys a law of one of two kinds: a contact pushes just as hard as is needed to stay closed and never
//! pulls; friction holds up to its limit and then slips. All of them together form a complementarity problem in at most
//! a few dozen unknowns, which `forces` solves exactly.

mod forces;
mod linear;
mod problem;
mod regime;
mod sweeps;

use glam::{DVec2, DVec3};

use super::{BallState, slip};
use crate::table::BALLS;
pub use forces::{Forces, contact_forces, forces_in_regime, stop_by_impulses};

/// Most contacts that three balls can have: with each other and with two cushions each.
pub const MAX_TOUCHES: usize = 9;

/// Speeds below this are none for the question whether something slips, m/s. It is well above the errors of the
/// integration, so that what sticks is seen to stick; the slip that is cut off would have moved a ball by less than
/// 1e-10 m.
pub const SLIP_TOLERANCE: f64 = 1e-10;

/// A slip below this is stopped at once if it then holds, m/s: what it still does until it ends, an impulse does too, but
/// for the change of the other forces meanwhile, which is of second order.
pub const ENDING_SLIP: f64 = 1e-7;

/// A ball's contact with a cushion or with another ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touch {
    /// The ball on which the normal force acts along `n`.
    pub first: usize,
    /// The other ball, or `None` for a cushion.
    pub second: Option<usize>,
    /// The cushion's normal into the table; for two balls the normal follows from their positions.
    pub rail_normal: DVec2,
}

impl Touch {
    /// Unit normal towards the first ball.
    pub fn normal(&self, balls: &[BallState; BALLS]) -> DVec2 {
        match self.second {
            None => self.rail_normal,
            Some(second) => (balls[self.first].position - balls[second].position).normalize(),
        }
    }

    /// Whether a ball takes part in both contacts.
    pub fn shares_a_ball(&self, other: &Self) -> bool {
        let has = |ball| other.first == ball || other.second == Some(ball);
        has(self.first) || self.second.is_some_and(has)
    }

    /// Speed at which the contact opens, m/s.
    pub fn opening_speed(&self, balls: &[BallState; BALLS]) -> f64 {
        self.relative_velocity(balls).dot(self.normal(balls))
    }

    /// Rate at which the opening speed grows under the accelerations of all balls, m/s²: two balls that pass each other
    /// part, too.
    pub fn opening_acceleration(&self, balls: &[BallState; BALLS], linear: &[DVec2; BALLS]) -> f64 {
        let n = self.normal(balls);
        match self.second {
            None => linear[self.first].dot(n),
            Some(second) => {
                let apart = balls[self.first].position.distance(balls[second].position);
                let across = self.relative_velocity(balls).perp_dot(n);
                (linear[self.first] - linear[second]).dot(n) + across * across / apart
            }
        }
    }

    /// Velocity of the first ball's surface over the other at the contact, along `t = z×n` and along z, m/s (thesis
    /// equation 21).
    pub fn slip(&self, radius: f64, balls: &[BallState; BALLS]) -> DVec2 {
        let (_, along, up) = contact_slip(radius, balls, self);
        DVec2::new(along, up)
    }

    fn relative_velocity(&self, balls: &[BallState; BALLS]) -> DVec2 {
        balls[self.first].velocity - self.second.map_or(DVec2::ZERO, |second| balls[second].velocity)
    }
}

/// Which of the laws hold for the duration of one integration step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Laws {
    /// Whether each ball slips on the cloth.
    pub slips: [bool; BALLS],
    /// Whether each ball moves at all.
    pub moves: [bool; BALLS],
    /// Whether each ball spins about the vertical.
    pub spins: [bool; BALLS],
    /// Whether each contact slips.
    pub rubs: [bool; MAX_TOUCHES],
}

impl Laws {
    /// Everything slips but contacts that never do.
    pub const SLIPPING: Self =
        Self { slips: [true; BALLS], moves: [true; BALLS], spins: [true; BALLS], rubs: [true; MAX_TOUCHES] };

    /// The laws that hold in the state `balls` with the given contacts, if slips and speeds below `none`, m/s, are zero.
    pub fn of(radius: f64, balls: &[BallState; BALLS], touches: &[Touch], none: f64) -> Self {
        let mut rubs = [false; MAX_TOUCHES];
        for (rub, touch) in rubs.iter_mut().zip(touches) {
            let (_, along, up) = contact_slip(radius, balls, touch);
            *rub = along.hypot(up) > none;
        }
        Self {
            slips: balls.map(|ball| slip(radius, ball.velocity, ball.spin).length() > none),
            moves: balls.map(|ball| ball.velocity.length() > none),
            spins: balls.map(|ball| radius * ball.spin.z.abs() > none),
            rubs,
        }
    }
}

/// The normal and the slip of a contact along `t = z×n` and along z, m/s (thesis equation 21).
fn contact_slip(radius: f64, balls: &[BallState; BALLS], touch: &Touch) -> (DVec2, f64, f64) {
    let n = touch.normal(balls);
    let t = n.perp();
    let spin = balls[touch.first].spin + touch.second.map_or(DVec3::ZERO, |second| balls[second].spin);
    let along = touch.relative_velocity(balls).dot(t) - radius * spin.z;
    (n, along, radius * spin.truncate().dot(t))
}
