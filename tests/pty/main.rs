//! The real binary in a pseudo-terminal: a session from start to end, every way of leaving, and lines that are slow or cut.

#[path = "../shared.rs"]
#[allow(dead_code, reason = "other tests use the rest")]
mod shared;

mod leaving;
mod line;
mod session;
mod training;
mod using;
