//! Rows of the balls' equations: a speed that a law constrains, and the force that acts along it.
//!
//! One set of coefficients describes both. The speed is `linear·v + lever·w`, summed over the balls. A force of size `f` per
//! ball mass accelerates a ball by `f linear` and its rotation by `f lever 5/(2R²)`.

use super::{
    Numbers, Real, Vector,
    contact::{Balls, Contact},
};
use crate::table::BALLS;

/// Velocity and spin of every ball, or their rates of change.
pub type Movement<R> = [(Vector<R>, Vector<R>); BALLS];

/// Returns the velocities and spins of `balls`.
pub fn movement<R: Real>(balls: &Balls<R>) -> Movement<R> {
    balls.map(|ball| (ball.velocity, ball.spin))
}

/// A row of coefficients: `None` for a ball that is not involved.
#[derive(Clone, Copy, Debug)]
pub struct Row<R> {
    parts: [Option<(Vector<R>, Vector<R>)>; BALLS],
}

impl<R: Real> Row<R> {
    fn of_ball(ball: usize, linear: Vector<R>, lever: Vector<R>) -> Self {
        let mut parts = [None; BALLS];
        parts[ball] = Some((linear, lever));
        Self { parts }
    }

    fn of_contact(contact: Contact, linear: Vector<R>, lever: Vector<R>) -> Self {
        let (first, second) = contact.balls();
        let mut row = Self::of_ball(first, linear, lever);
        if let Some(second) = second {
            // The second ball is pushed the opposite way at its opposite side, so both rotate alike.
            row.parts[second] = Some((-linear, lever));
        }
        row
    }

    /// The opening speed of a contact with normal `n`.
    pub fn opening(contact: Contact, n: Vector<R>) -> Self {
        Self::of_contact(contact, n, Vector::zero())
    }

    /// The slip of a contact with normal `n` in a direction across it. No force lifts a ball off the cloth.
    pub fn slip(numbers: &Numbers<R>, contact: Contact, n: Vector<R>, direction: Vector<R>) -> Self {
        Self::of_contact(contact, direction.flat(), direction.cross(n) * numbers.radius)
    }

    /// The slip of a contact with normal `n` in a direction across it, if its force may lift a ball.
    pub fn slip_in_space(numbers: &Numbers<R>, contact: Contact, n: Vector<R>, direction: Vector<R>) -> Self {
        Self::of_contact(contact, direction, direction.cross(n) * numbers.radius)
    }

    /// The slip of a ball on the cloth in a direction.
    pub fn cloth(numbers: &Numbers<R>, ball: usize, direction: Vector<R>) -> Self {
        Self::of_ball(ball, direction, direction.cross(Vector::up()) * numbers.radius)
    }

    /// The speed of a ball's centre in a direction.
    pub fn centre(ball: usize, direction: Vector<R>) -> Self {
        Self::of_ball(ball, direction, Vector::zero())
    }

    /// The side spin of a ball, as the speed of its equator.
    pub fn turning(numbers: &Numbers<R>, ball: usize) -> Self {
        Self::of_ball(ball, Vector::zero(), Vector::up() * numbers.radius)
    }

    /// Returns this row plus `size` times another.
    #[must_use]
    pub fn and(mut self, size: R, other: &Self) -> Self {
        for (part, other) in self.parts.iter_mut().zip(other.parts) {
            *part = match (*part, other) {
                (Some((linear, lever)), Some((more, turn))) => Some((linear + more * size, lever + turn * size)),
                (part, None) => part,
                (None, Some((more, turn))) => Some((more * size, turn * size)),
            };
        }
        self
    }

    /// Returns the speed, or its rate of change for a movement of accelerations.
    pub fn speed(&self, movement: &Movement<R>) -> R {
        let parts = self.parts.iter().zip(movement);
        parts.fold(R::zero(), |sum, (part, (v, w))| match part {
            Some((linear, lever)) => sum + linear.dot(*v) + lever.dot(*w),
            None => sum,
        })
    }

    /// Returns the acceleration per unit of force along `force`.
    pub fn response(&self, numbers: &Numbers<R>, force: &Self) -> R {
        self.parts.iter().zip(&force.parts).fold(R::zero(), |sum, parts| match parts {
            (Some((linear, lever)), Some((push, turn))) => {
                sum + linear.dot(*push) + lever.dot(*turn) * numbers.mass_over_inertia
            }
            _ => sum,
        })
    }

    /// Adds the effect of a force of this size.
    pub fn push(&self, numbers: &Numbers<R>, size: R, movement: &mut Movement<R>) {
        let angular = numbers.mass_over_inertia * size;
        for (part, (v, w)) in self.parts.iter().zip(movement) {
            if let Some((linear, lever)) = part {
                (*v, *w) = (*v + *linear * size, *w + *lever * angular);
            }
        }
    }
}
