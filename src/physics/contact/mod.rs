//! Resting contact: forces on balls that are pressed against cushions or each other, the limit of infinitely many ever smaller bounces.
//!
//! Every force obeys one of two laws. A normal force is just large enough to keep its contact closed, and never pulls. A friction sticks up
//! to its limit and then slips. Together they form a complementarity problem with at most a few dozen unknowns. [`Scene::resolve`] solves
//! it; [`Scene::forces`] follows its solution while the active set does not change.
//!
//! A resting contact is at the height of the ball's centre and has Coulomb friction with the coefficient of slow impacts, whatever the model
//! of the rails.

mod active_set;
mod constraints;
mod effort;
mod forces;
mod linear;
mod margin;
mod problem;
mod resolve;
mod solve;

use glam::{DVec2, DVec3};

use super::BallState;
use crate::table::{BALLS, Rail, Table};
pub use active_set::{ActiveSet, Contacts, Friction, MAX_CONTACTS};
pub use constraints::stop_by_impulses;
pub use effort::Effort;
pub use forces::{Forces, Resolved};
pub use linear::{factorize, substitute};

/// First bounce speed, in units of `√(g R)`, of balls that never slip in a state without consistent contact forces (Painlevé's paradox).
/// The force that would prevent slip separates the balls; once they are separated, nothing acts, and they come back. Each bounce is higher
/// than the last and, like every impact of such balls (17), removes their slip. The height after a given time depends on the first bounce
/// only through its logarithm. A larger value would add a relevant amount of energy; with a smaller one, the bounces take longer to grow.
pub const FIRST_BOUNCE: f64 = 8e-10;

/// Balls in contact in one state, with their friction modes.
#[derive(Clone, Copy, Debug)]
pub struct Scene<'a> {
    /// Table with the constants of all forces.
    pub table: &'a Table,
    /// States of the balls.
    pub balls: &'a [BallState; BALLS],
    /// Contacts of the balls.
    pub contacts: &'a [Contact],
    /// Modes of the frictions of cloth and contacts, as far as known.
    pub set: &'a ActiveSet,
}

/// A ball's contact with a cushion or with another ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// The ball on which the normal force acts along `n`.
    pub first: usize,
    /// What it touches.
    pub partner: Partner,
}

/// What a ball touches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Partner {
    /// The ball of this index.
    Ball(usize),
    /// The cushion of this rail.
    Cushion(Rail),
}

/// Whether `ball` takes part in any of the contacts.
pub fn involve(contacts: &[Contact], ball: usize) -> bool {
    contacts.iter().any(|contact| contact.involves(ball))
}

impl Contact {
    /// Creates a contact of a ball with a cushion.
    pub const fn with_cushion(ball: usize, rail: Rail) -> Self {
        Self { first: ball, partner: Partner::Cushion(rail) }
    }

    /// Creates a contact of two balls.
    pub const fn of_balls(first: usize, second: usize) -> Self {
        Self { first, partner: Partner::Ball(second) }
    }

    /// Returns the second of two balls; `None` for a cushion.
    pub const fn second(&self) -> Option<usize> {
        match self.partner {
            Partner::Ball(second) => Some(second),
            Partner::Cushion(_) => None,
        }
    }

    /// Returns the unit normal towards the first ball.
    pub fn normal(&self, balls: &[BallState; BALLS]) -> DVec2 {
        match self.partner {
            Partner::Cushion(rail) => rail.normal(),
            Partner::Ball(second) => (balls[self.first].position - balls[second].position).normalize(),
        }
    }

    /// Whether `ball` takes part in the contact.
    pub fn involves(&self, ball: usize) -> bool {
        self.first == ball || self.partner == Partner::Ball(ball)
    }

    /// Whether a ball takes part in both contacts.
    pub fn shares_a_ball(&self, other: &Self) -> bool {
        other.involves(self.first) || self.second().is_some_and(|second| other.involves(second))
    }

    /// Whether this is a contact of balls that never slip on each other, because they have no coefficient of friction (17).
    pub const fn never_slips(&self, table: &Table) -> bool {
        table.ball_friction.is_none() && self.second().is_some()
    }

    /// Returns the speed at which the contact opens, m/s.
    pub fn opening_speed(&self, balls: &[BallState; BALLS]) -> f64 {
        self.relative_velocity(balls).dot(self.normal(balls))
    }

    /// Returns the velocity of the first ball's surface relative to the other surface at the contact, along `t = z×n` and along z, m/s
    /// (thesis equation 21).
    pub fn slip(&self, radius: f64, balls: &[BallState; BALLS]) -> DVec2 {
        self.normal_and_slip(radius, balls).1
    }

    fn relative_velocity(&self, balls: &[BallState; BALLS]) -> DVec2 {
        balls[self.first].velocity - self.second().map_or(DVec2::ZERO, |second| balls[second].velocity)
    }

    /// Returns the part of the rates of opening, slip along `t = z×n` and slip along z that does not depend on the accelerations, m/s²: the
    /// contact frame of two balls rotates. The normal is `n`.
    fn rotation_bias(&self, radius: f64, balls: &[BallState; BALLS], n: DVec2) -> [f64; 3] {
        let Some(second) = self.second() else { return [0.0; 3] };
        let diameter = 2.0 * radius;
        let across = self.relative_velocity(balls).dot(n.perp());
        // The slip along z changes because t rotates, the slip along t because n does (where v·n = 0 contributes nothing).
        let spin = balls[self.first].spin + balls[second].spin;
        [across * across / diameter, 0.0, -radius * (across / diameter) * spin.truncate().dot(n)]
    }

    /// Returns the normal, and the slip along `t = z×n` and along z, m/s.
    #[inline(always)]
    fn normal_and_slip(&self, radius: f64, balls: &[BallState; BALLS]) -> (DVec2, DVec2) {
        let n = self.normal(balls);
        let t = n.perp();
        let spin = balls[self.first].spin + self.second().map_or(DVec3::ZERO, |second| balls[second].spin);
        let along = self.relative_velocity(balls).dot(t) - radius * spin.z;
        (n, DVec2::new(along, radius * spin.truncate().dot(t)))
    }
}
