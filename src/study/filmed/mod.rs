//! Filmed balls: how far the simulation is from what real balls did.

pub mod film;
pub mod rail_hits;
pub mod chains;
pub mod least_squares;
pub mod lone;
