//! The laws in force for balls in resting contact: what slips, rolls or spins.
//!
//! Slipping, rolling and spinning meet a friction of known size and direction. Without slip, roll or spin, the body is held at rest
//! by a friction of up to that size. The normal force of a contact is as large as needed to keep it closed.

use super::{
    Motion, Numbers, Real,
    contact::{Balls, Contact},
    tolerance::settled,
};
use crate::table::BALLS;

/// The laws in force.
#[derive(Clone, Debug)]
pub struct Laws<R> {
    /// The contacts, and whether each slips.
    pub contacts: Vec<(Contact, bool)>,
    /// The motion on the cloth of each ball in contact; `None` for other balls.
    pub cloth: [Option<Motion>; BALLS],
    /// Sign of each ball's `w_z`, zero if the ball does not spin.
    pub spin_signs: [R; BALLS],
}

impl<R: Real> Laws<R> {
    /// Returns the laws of `contacts` that are closed and neither open nor close.
    pub fn of(numbers: &Numbers<R>, balls: &Balls<R>, contacts: &[Contact]) -> Self {
        Self::if_none(numbers, balls, contacts, settled())
    }

    /// Returns the same if slips and speeds up to `none`, m/s, count as zero.
    pub fn if_none(numbers: &Numbers<R>, balls: &Balls<R>, contacts: &[Contact], none: R) -> Self {
        let slips =
            |contact: &Contact| contact.friction(numbers).is_some() && contact.slip(numbers, balls).length() > none;
        let in_contact = |ball: usize| contacts.iter().any(|contact| contact.involves(ball));
        Self {
            contacts: contacts.iter().map(|contact| (*contact, slips(contact))).collect(),
            cloth: std::array::from_fn(|ball| in_contact(ball).then(|| balls[ball].on_cloth(numbers, none))),
            spin_signs: balls.map(|ball| {
                let speed = numbers.radius * ball.spin.z;
                let sign = R::of(if speed > R::zero() { 1.0 } else { -1.0 });
                if speed.abs() > none { sign } else { R::zero() }
            }),
        }
    }

    /// Returns the speeds whose directions enter a law and that can end: slips, and the speeds of rolling balls.
    pub fn ending_speeds(&self, numbers: &Numbers<R>, balls: &Balls<R>) -> impl Iterator<Item = R> {
        let on_cloth = self.cloth.iter().zip(balls).filter_map(|(motion, ball)| match (*motion)? {
            Motion::Sliding => Some(ball.slip(numbers).length()),
            Motion::Rolling => Some(ball.velocity.length()),
            Motion::Stationary | Motion::Flying | Motion::OffTable => None,
        });
        let slipping = self.contacts.iter().filter(|(_, slips)| *slips);
        on_cloth.chain(slipping.map(|(contact, _)| contact.slip(numbers, balls).length()))
    }

    /// Returns the same laws without the cloth.
    #[must_use]
    pub fn without_cloth(self) -> Self {
        Self { cloth: [None; BALLS], ..self }
    }

    /// Returns the largest slip or speed that counts as zero.
    pub fn largest_held(&self, numbers: &Numbers<R>, balls: &Balls<R>) -> R {
        let on_cloth = self.cloth.iter().zip(balls).filter_map(|(motion, ball)| match (*motion)? {
            Motion::Sliding | Motion::Flying | Motion::OffTable => None,
            Motion::Rolling => Some(ball.slip(numbers).length()),
            Motion::Stationary => Some(ball.slip(numbers).length().max(ball.velocity.length())),
        });
        let held = self.contacts.iter().filter(|(contact, slips)| !slips && contact.friction(numbers).is_some());
        on_cloth.chain(held.map(|(contact, _)| contact.slip(numbers, balls).length())).fold(R::zero(), R::max)
    }

    /// Returns the remaining side spin of every spinning ball in contact, as the speed of its equator, negative after its end.
    pub fn spin_speeds(&self, numbers: &Numbers<R>, balls: &Balls<R>) -> impl Iterator<Item = R> {
        let spinning = self.spin_signs.iter().zip(balls).zip(&self.cloth);
        let counts = spinning.filter(|((sign, _), cloth)| **sign != R::zero() && cloth.is_some());
        counts.map(|((sign, ball), _)| numbers.radius * ball.spin.z * *sign)
    }
}
