//! Which laws are in force for balls in resting contact: what slips, what rolls, what turns.
//!
//! What slips, moves or turns meets a friction of known size and direction. What does not is held still by a friction up
//! to that size. A contact pushes as hard as it needs to stay closed.

use super::{
    Motion, Numbers, Real,
    contact::{Balls, Contact},
    tolerance::settled,
};
use crate::table::BALLS;

/// Which laws are in force.
#[derive(Clone, Debug)]
pub struct Laws<R> {
    /// The contacts, and whether each slips.
    pub contacts: Vec<(Contact, bool)>,
    /// What each ball in contact does on the cloth.
    pub cloth: [Option<Motion>; BALLS],
    /// Sign of `w_z`, zero where it is held.
    turning: [R; BALLS],
}

impl<R: Real> Laws<R> {
    /// The laws of `contacts` that are closed and neither open nor close.
    pub fn of(numbers: &Numbers<R>, balls: &Balls<R>, contacts: &[Contact]) -> Self {
        Self::if_none(numbers, balls, contacts, settled())
    }

    /// The same if slips and speeds up to `none`, m/s, are zero.
    pub fn if_none(numbers: &Numbers<R>, balls: &Balls<R>, contacts: &[Contact], none: R) -> Self {
        let slips =
            |contact: &Contact| contact.friction(numbers).is_some() && contact.slip(numbers, balls).length() > none;
        let in_contact = |ball: usize| contacts.iter().any(|contact| contact.has(ball));
        Self {
            contacts: contacts.iter().map(|contact| (*contact, slips(contact))).collect(),
            cloth: std::array::from_fn(|ball| in_contact(ball).then(|| balls[ball].on_cloth(numbers, none))),
            turning: balls.map(|ball| {
                let speed = numbers.radius * ball.spin.z;
                let sign = R::of(if speed > R::zero() { 1.0 } else { -1.0 });
                if speed.abs() > none { sign } else { R::zero() }
            }),
        }
    }

    /// The directions that a law has and that end with a speed: its slip's, or that of a ball which rolls.
    pub fn ending_speeds(&self, numbers: &Numbers<R>, balls: &Balls<R>) -> impl Iterator<Item = R> {
        let on_cloth = self.cloth.iter().zip(balls).filter_map(|(motion, ball)| match (*motion)? {
            Motion::Sliding => Some(ball.slip(numbers).length()),
            Motion::Rolling => Some(ball.velocity.length()),
            Motion::Stationary | Motion::Flying | Motion::OffTable => None,
        });
        let slipping = self.contacts.iter().filter(|(_, slips)| *slips);
        on_cloth.chain(slipping.map(|(contact, _)| contact.slip(numbers, balls).length()))
    }

    /// The same as if there were no cloth.
    #[must_use]
    pub fn without_cloth(self) -> Self {
        Self { cloth: [None; BALLS], ..self }
    }

    /// Sign of a ball's `w_z`, zero where it is held.
    pub fn turning(&self, ball: usize) -> R {
        self.turning[ball]
    }

    /// Whether a ball in contact does not turn on the spot.
    pub fn turning_ended(&self, ball: usize) -> bool {
        self.cloth[ball].is_some() && self.turning[ball] == R::zero()
    }

    /// The largest slip or speed that counts as none.
    pub fn largest_held(&self, numbers: &Numbers<R>, balls: &Balls<R>) -> R {
        let on_cloth = self.cloth.iter().zip(balls).filter_map(|(motion, ball)| match (*motion)? {
            Motion::Sliding | Motion::Flying | Motion::OffTable => None,
            Motion::Rolling => Some(ball.slip(numbers).length()),
            Motion::Stationary => Some(ball.slip(numbers).length().max(ball.velocity.length())),
        });
        let held = self.contacts.iter().filter(|(contact, slips)| !slips && contact.friction(numbers).is_some());
        on_cloth.chain(held.map(|(contact, _)| contact.slip(numbers, balls).length())).fold(R::zero(), R::max)
    }

    /// How far every ball that turns is from the moment when it stops to, as a speed.
    pub fn turns(&self, numbers: &Numbers<R>, balls: &Balls<R>) -> impl Iterator<Item = R> {
        let turning = self.turning.iter().zip(balls).zip(&self.cloth);
        let counts = turning.filter(|((sign, _), cloth)| **sign != R::zero() && cloth.is_some());
        counts.map(|((sign, ball), _)| numbers.radius * ball.spin.z * *sign)
    }
}
