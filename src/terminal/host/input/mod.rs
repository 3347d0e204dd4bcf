//! What comes from the terminal: bytes, made into keys, pastes and reports of the mouse.
//!
//! crossterm's own reader waits for the end of a sequence for as long as it takes, and takes every later key for a part of it:
//! one that is cut makes the screen deaf. This one gives up after a silence, and a control character ends whatever was begun.

mod csi;
mod decoder;
mod keys;
mod mouse;
mod paste;

pub use decoder::Decoder;
