//! The real binary in a pseudo-terminal: a session from start to end, every way to leave, and slow or cut connections.

mod calibration;
mod connection;
mod exit;
mod follow;
mod guests;
mod line_output;

mod training;
mod using;
