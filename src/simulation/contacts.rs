//! Detection of contacts: balls that touch cushions or each other.

use glam::DVec2;

use super::{Constants, Rail, extrapolation::State};
use crate::{
    physics::{Contact, Contacts, Partner},
    table::{BALLS, PAIRS},
};

/// For each ball, its pairs as indices of [`PAIRS`], each with the other ball.
pub const PAIRS_OF: [[(usize, usize); 2]; BALLS] = [[(0, 1), (1, 2)], [(0, 0), (2, 2)], [(1, 0), (2, 1)]];

/// Returns all contacts of the balls `on_cloth` whose opening speed, m/s, is `wanted`.
pub fn touching(
    constants: &Constants,
    balls: &State,
    on_cloth: [bool; BALLS],
    wanted: impl Fn(f64) -> bool,
) -> Contacts {
    contacts_where(constants, balls, on_cloth, |gap, contact| {
        gap <= constants.tolerance.touching && wanted(contact.opening_speed(balls))
    })
}

/// Whether a ball touches two cushions; a prediction reports only one of several simultaneous cushion impacts.
#[inline(always)]
pub fn is_in_corner(constants: &Constants, position: DVec2) -> bool {
    (constants.reach - position.abs()).max_element() <= constants.tolerance.touching
}

/// Returns the possible contacts of the balls `on_cloth` that are `wanted` with their present gap, m.
pub fn contacts_where(
    constants: &Constants,
    balls: &State,
    on_cloth: [bool; BALLS],
    wanted: impl Fn(f64, &Contact) -> bool,
) -> Contacts {
    let mut contacts = Contacts::new();
    let mut add = |contact: Contact| {
        if wanted(gap(constants, balls, &contact), &contact) {
            contacts.push(contact);
        }
    };
    for ball in (0..BALLS).filter(|&ball| on_cloth[ball]) {
        for rail in Rail::ALL {
            add(Contact::with_cushion(ball, rail));
        }
    }
    for (first, second) in PAIRS.into_iter().filter(|&(first, second)| on_cloth[first] && on_cloth[second]) {
        add(Contact::of_balls(first, second));
    }
    contacts
}

/// Returns the distance of a contact's surfaces, m.
fn gap(constants: &Constants, balls: &State, contact: &Contact) -> f64 {
    let place = balls[contact.first].position;
    match contact.partner {
        Partner::Ball(second) => place.distance(balls[second].position) - constants.diameter,
        Partner::Cushion(rail) => rail.gap(constants.reach, place),
    }
}

/// Moves a ball exactly to the cushion with this normal: the rounding of a prediction must not leave a gap through which the ball could
/// pass.
#[inline(always)]
pub fn move_to_cushion(constants: &Constants, normal: DVec2, position: &mut DVec2) {
    *position += (-normal.abs().dot(constants.reach) - position.dot(normal)) * normal;
}

/// Number of passes that close gaps: closing one contact opens others slightly.
const CLOSING_ROUNDS: usize = 6;

/// Moves balls by the gaps of their contacts, which are as small as the omitted bounces.
pub fn close_gaps(constants: &Constants, balls: &mut State, contacts: &[Contact]) {
    for _ in 0..CLOSING_ROUNDS {
        for contact in contacts {
            let (gap, n) = (gap(constants, balls, contact), contact.normal(balls));
            let share = if contact.second().is_some() { 0.5 } else { 1.0 };
            balls[contact.first].position -= share * gap * n;
            if let Some(second) = contact.second() {
                balls[second].position += share * gap * n;
            }
        }
    }
}
