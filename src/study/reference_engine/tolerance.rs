//! All tolerances of the engine, derived from the rounding of its number type.

use super::Real;

/// Gaps below this count as contact, m: the rounding of positions on the table.
pub fn touching<R: Real>() -> R {
    R::of(64.0 * R::ROUNDING)
}

/// Speeds and slips below this count as zero, m/s.
pub fn settled<R: Real>() -> R {
    R::of(R::ROUNDING.powf(0.75))
}

/// Contacts that open or close more slowly than this count as closed and at rest, m/s. The effect of a slip that has just begun
/// on a contact is smaller.
pub fn closed<R: Real>() -> R {
    R::of(256.0) * settled()
}

/// A bounce slower than this ends a chatter if the contact presses, m/s. The rest of the chatter would move a ball by about its
/// square, which is rounding.
pub fn chatter<R: Real>() -> R {
    R::of(R::ROUNDING.sqrt())
}

/// A hop slower than this is the last, m/s: all further hops together are below rounding.
pub fn last_hop<R: Real>() -> R {
    R::of(0.1 * R::ROUNDING)
}

/// Forces per mass and accelerations below this count as zero, m/s². A violated law is detected with a delay of this size; the
/// missed slip or gap grows with its square.
pub fn slack<R: Real>() -> R {
    R::of(R::ROUNDING.sqrt())
}

/// Slips below this follow their driving force without delay, m/s, if they grow so slowly that the direction of their friction
/// settles much faster.
pub fn creeping<R: Real>() -> R {
    R::of(R::ROUNDING.powf(0.375))
}
