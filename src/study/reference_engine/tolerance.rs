//! What counts as nothing: every tolerance of the engine, derived from the rounding of its numbers.

use super::Real;

/// Gaps below this are contact, m: rounding of places on the table.
pub fn touching<R: Real>() -> R {
    R::of(64.0 * R::ROUNDING)
}

/// Speeds and slips below this are zero, m/s.
pub fn settled<R: Real>() -> R {
    R::of(R::ROUNDING.powf(0.75))
}

/// Contacts that open or close more slowly than this are closed and rest, m/s: what slips that have just begun do to a
/// contact is less.
pub fn closed<R: Real>() -> R {
    R::of(256.0) * settled()
}

/// A bounce slower than this ends a chatter where the contact presses, m/s: what is left of the chatter would move a
/// ball by about the square of it, which is rounding.
pub fn chatter<R: Real>() -> R {
    R::of(R::ROUNDING.sqrt())
}

/// A hop that is slower than this has ended, m/s: what is left of all that follow is rounding.
pub fn last_hop<R: Real>() -> R {
    R::of(0.1 * R::ROUNDING)
}

/// Forces per mass and accelerations below this are zero, m/s². A law that breaks is seen so much late: the slip or gap
/// that is missed grows with the square of it.
pub fn slack<R: Real>() -> R {
    R::of(R::ROUNDING.sqrt())
}

/// Slips below this follow the force that drives them without delay, m/s, where they grow so slowly that the direction of
/// their friction settles much faster than they do.
pub fn creeping<R: Real>() -> R {
    R::of(R::ROUNDING.powf(0.375))
}
