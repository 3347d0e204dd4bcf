//! Numbers out of measurements: what more than one room fits with.

mod least_squares;
mod normal;
mod symmetric;

pub use least_squares::{Fit, Minimum, Problem, fit, minimize, solve};
pub use normal::{normal_pair, quantile};
pub use symmetric::{cholesky, dot, inverse, undo};
