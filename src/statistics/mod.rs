//! Numbers out of measurements: what more than one room fits with.

mod least_squares;

pub use least_squares::{Fit, Minimum, Problem, fit, minimize, solve};
