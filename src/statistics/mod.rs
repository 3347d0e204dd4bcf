//! Statistics and least-squares fits that several modules use.

mod least_squares;
mod normal;
mod sample;
mod success_rate;
mod symmetric;

pub use least_squares::{Fit, Minimum, Problem, fit, minimize};
pub use normal::{normal_pair, quantile};
pub use sample::mean_and_deviation;
pub use success_rate::SuccessRate;
pub use symmetric::{cholesky, dot, half_log_determinant, identity, inverse, normal_matrix, solve, undo};
