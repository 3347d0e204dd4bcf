//! The real binary in a pseudo-terminal: a session from start to end, every way of leaving, and lines that are slow or cut.

mod calibration;
mod follow;
mod guests;
mod leaving;
mod line;
mod lines;

mod training;
mod using;
