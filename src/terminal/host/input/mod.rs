//! Terminal input: decodes bytes into keys, pastes and mouse reports.
//!
//! crossterm's own reader waits for the end of a sequence without a time limit and takes all later keys as part of it, so that a truncated
//! sequence blocks all input. This decoder gives up after a silence, and a control character ends any sequence.

mod csi;
mod decoder;
mod keys;
mod mouse;
mod paste;

pub use decoder::Decoder;
