//! Statistics and least-squares fits that several modules use.

mod least_squares;
mod normal;
mod sample;
mod success_rate;
mod symmetric;

pub use least_squares::{Fit, LeastSquaresProblem, Minimum, fit, minimize};
pub use normal::{normal_pair, normal_quantile};
pub use sample::mean_and_deviation;
pub use success_rate::SuccessRate;
pub use symmetric::{back_substitute, cholesky, dot, half_log_determinant, identity, inverse, normal_matrix, solve};
