//! The real binary in a pseudo-terminal: a session from start to end, every way to leave, and slow or cut connections.

mod calibration;
mod follow;
mod guests;
mod leaving;
mod line;
mod lines;

mod training;
mod using;
