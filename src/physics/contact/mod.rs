//! Resting contact: the forces on balls that are pressed against cushions or each other, the limit of infinitely many
//! ever smaller bounces.
//!
//! Every force obeys one of two laws: a contact pushes just as hard as is needed to stay closed and never pulls; friction
//! holds up to its limit and then slips. All of them together form a complementarity problem in at most a few dozen
//! unknowns: [`Scene::resolve`] solves it, [`Scene::forces`] follows its solution while nothing changes sides.

mod active_set;
mod effort;
mod forces;
mod held;
mod linear;
mod margin;
mod problem;
mod resolve;
mod solve;

use glam::{DVec2, DVec3};

use super::BallState;
use crate::table::{BALLS, Table};
pub use active_set::{ActiveSet, Contacts, Friction, MAX_CONTACTS};
pub use effort::Effort;
pub use forces::{Forces, Resolved};
pub use held::stop_by_impulses;
pub use linear::{factorize, substitute};

/// Speed at which balls that never slip begin to bounce where no forces hold them together (Painlevé's paradox), in units of
/// `√(g R)`. What would hold the slip parts them, and once they have parted, and nothing holds, they come back: each bounce is
/// higher than the last, and takes their slip as every impact of theirs does (17). How high they have got after a time
/// depends on the first bounce by its logarithm alone. Larger: what is added counts. Smaller: the bounces take longer to grow.
pub const FIRST_BOUNCE: f64 = 8e-10;

/// Balls in contact in one state, and what their frictions do.
#[derive(Clone, Copy, Debug)]
pub struct Scene<'a> {
    /// Where they are.
    pub table: &'a Table,
    /// Their state.
    pub balls: &'a [BallState; BALLS],
    /// Their contacts.
    pub contacts: &'a [Contact],
    /// What the frictions of cloth and contacts do, as far as that is known.
    pub set: &'a ActiveSet,
}

impl Scene<'_> {
    /// Whether a ball takes part in any contact.
    fn holds(&self, ball: usize) -> bool {
        self.contacts.iter().any(|contact| contact.has(ball))
    }
}

/// A ball's contact with a cushion or with another ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// The ball on which the normal force acts along `n`.
    pub first: usize,
    /// The other ball, or `None` for a cushion.
    pub second: Option<usize>,
    /// The cushion's normal into the table; for two balls the normal follows from their positions.
    pub cushion_normal: DVec2,
}

impl Contact {
    /// A ball on the cushion with this normal into the table.
    pub const fn with_cushion(ball: usize, normal: DVec2) -> Self {
        Self { first: ball, second: None, cushion_normal: normal }
    }

    /// Two balls.
    pub const fn of_balls(first: usize, second: usize) -> Self {
        Self { first, second: Some(second), cushion_normal: DVec2::ZERO }
    }

    /// Unit normal towards the first ball.
    pub fn normal(&self, balls: &[BallState; BALLS]) -> DVec2 {
        match self.second {
            None => self.cushion_normal,
            Some(second) => (balls[self.first].position - balls[second].position).normalize(),
        }
    }

    /// Whether this ball takes part.
    pub fn has(&self, ball: usize) -> bool {
        self.first == ball || self.second == Some(ball)
    }

    /// Whether a ball takes part in both contacts.
    pub fn shares_a_ball(&self, other: &Self) -> bool {
        other.has(self.first) || self.second.is_some_and(|second| other.has(second))
    }

    /// Whether it is one of balls that never slip on each other, since they have no coefficient of friction (17).
    pub const fn never_slips(&self, table: &Table) -> bool {
        table.ball_friction.is_none() && self.second.is_some()
    }

    /// Speed at which the contact opens, m/s.
    pub fn opening_speed(&self, balls: &[BallState; BALLS]) -> f64 {
        self.relative_velocity(balls).dot(self.normal(balls))
    }

    /// Velocity of the first ball's surface over the other at the contact, along `t = z×n` and along z, m/s (thesis
    /// equation 21).
    pub fn slip(&self, radius: f64, balls: &[BallState; BALLS]) -> DVec2 {
        self.normal_and_slip(radius, balls).1
    }

    fn relative_velocity(&self, balls: &[BallState; BALLS]) -> DVec2 {
        balls[self.first].velocity - self.second.map_or(DVec2::ZERO, |second| balls[second].velocity)
    }

    /// What the rates of opening, of the slip along `t = z×n` and of that along z have besides the accelerations' part, m/s²: two
    /// balls' courses around each other bend. The normal is `n`.
    fn bends(&self, radius: f64, balls: &[BallState; BALLS], n: DVec2) -> [f64; 3] {
        let Some(second) = self.second else { return [0.0; 3] };
        let diameter = 2.0 * radius;
        let across = self.relative_velocity(balls).dot(n.perp());
        // The slip's z part changes because t turns, its t part because n does (to which v·n = 0 adds nothing).
        let spin = balls[self.first].spin + balls[second].spin;
        [across * across / diameter, 0.0, -radius * (across / diameter) * spin.truncate().dot(n)]
    }

    /// The normal, and the slip along `t = z×n` and along z, m/s.
    #[inline(always)]
    fn normal_and_slip(&self, radius: f64, balls: &[BallState; BALLS]) -> (DVec2, DVec2) {
        let n = self.normal(balls);
        let t = n.perp();
        let spin = balls[self.first].spin + self.second.map_or(DVec3::ZERO, |second| balls[second].spin);
        let along = self.relative_velocity(balls).dot(t) - radius * spin.z;
        (n, DVec2::new(along, radius * spin.truncate().dot(t)))
    }
}
