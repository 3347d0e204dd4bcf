//! Filmed balls: how far the simulation is from what real balls did.

pub mod chains;
mod contacts;
pub mod film;
pub mod least_squares;
pub mod lone;
pub mod rail_hits;
mod replay;
pub mod systems;
pub mod whole;

pub use film::{FilmedShot, bundled};
pub use replay::{Replay, ReplayError};
pub use whole::FITTED;
