//! Filmed balls: how far the simulation is from what real balls did.

pub mod chains;
pub mod film;
pub mod least_squares;
pub mod lone;
pub mod rail_hits;
pub mod systems;
pub mod whole;
