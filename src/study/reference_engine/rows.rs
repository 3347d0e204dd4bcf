//! Rows of the balls' equations: a speed that a law is about, and the force that acts along it.
//!
//! One set of numbers tells both. The speed is `linear·v + lever·w`, summed over the balls; a force of size `f` per ball
//! mass accelerates a ball by `f linear` and turns it by `f lever 5/(2R²)`.

use super::{
    Numbers, Real, Vector,
    contact::{Balls, Contact},
};
use crate::table::BALLS;

/// Velocity and spin of every ball, or their rates of change.
pub type Movement<R> = [(Vector<R>, Vector<R>); BALLS];

/// Velocities and spins of `balls`.
pub fn movement<R: Real>(balls: &Balls<R>) -> Movement<R> {
    balls.map(|ball| (ball.velocity, ball.spin))
}

/// A row: `None` for a ball that takes no part.
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
            // It is pushed the other way, at the other side: both turn alike.
            row.parts[second] = Some((-linear, lever));
        }
        row
    }

    /// The opening of a contact with normal `n`.
    pub fn opening(contact: Contact, n: Vector<R>) -> Self {
        Self::of_contact(contact, n, Vector::zero())
    }

    /// The slip of a contact with normal `n` in a direction across it. No force lifts a ball off the cloth.
    pub fn slip(numbers: &Numbers<R>, contact: Contact, n: Vector<R>, direction: Vector<R>) -> Self {
        Self::of_contact(contact, direction.flat(), direction.cross(n) * numbers.radius)
    }

    /// The slip of a ball on the cloth in a direction.
    pub fn cloth(numbers: &Numbers<R>, ball: usize, direction: Vector<R>) -> Self {
        Self::of_ball(ball, direction, direction.cross(Vector::up()) * numbers.radius)
    }

    /// The speed of a ball's centre in a direction.
    pub fn centre(ball: usize, direction: Vector<R>) -> Self {
        Self::of_ball(ball, direction, Vector::zero())
    }

    /// The turning of a ball on the spot, as the speed of its equator.
    pub fn turning(numbers: &Numbers<R>, ball: usize) -> Self {
        Self::of_ball(ball, Vector::zero(), Vector::up() * numbers.radius)
    }

    /// This row and `size` times another.
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

    /// The speed, or its rate of change.
    pub fn speed(&self, movement: &Movement<R>) -> R {
        let parts = self.parts.iter().zip(movement);
        parts.fold(R::zero(), |sum, (part, (v, w))| match part {
            Some((linear, lever)) => sum + linear.dot(*v) + lever.dot(*w),
            None => sum,
        })
    }

    /// The speed that a unit of force along `force` makes.
    pub fn response(&self, numbers: &Numbers<R>, force: &Self) -> R {
        self.parts.iter().zip(&force.parts).fold(R::zero(), |sum, parts| match parts {
            (Some((linear, lever)), Some((push, turn))) => {
                sum + linear.dot(*push) + lever.dot(*turn) * numbers.turnability
            }
            _ => sum,
        })
    }

    /// Adds what a force of this size does.
    pub fn push(&self, numbers: &Numbers<R>, size: R, movement: &mut Movement<R>) {
        let twist = numbers.turnability * size;
        for (part, (v, w)) in self.parts.iter().zip(movement) {
            if let Some((linear, lever)) = part {
                (*v, *w) = (*v + *linear * size, *w + *lever * twist);
            }
        }
    }
}
