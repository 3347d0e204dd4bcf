//! The program measuring itself: error against run time, stability, throughput.

pub mod stability;
pub mod throughput;
