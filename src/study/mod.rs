//! Measurements of the program itself: accuracy against run time, numerical stability, throughput.

mod chart;
mod clock;
mod errors;
pub mod filmed;
pub mod fingerprint;
mod methods;
mod plots;
mod precision;
mod reference_check;
pub mod reference_engine;
mod report;
pub mod reproduction;
pub mod self_test;
mod shots;
pub mod stability;
mod statistics;
mod steps;
pub mod throughput;
mod truth;

pub use errors::Errors;
pub use methods::Method;
pub use plots::{error_against_condition, error_against_time};
pub use precision::{Plan, Study};
pub use reference_check::{GOAL_MEDIAN, GOAL_P99, ReferenceRow, check_references};
pub use report::{csv, text};
pub use shots::{MaxElevation, StudyShot, random_shots};
pub use statistics::Spread;
pub use steps::{StepError, SteppedShot, Steps};
pub use truth::Truth;
