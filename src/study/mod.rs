//! The program measuring itself: error against run time.

pub mod plain;
