//! When things happen: event prediction, the engine, and playback of what it recorded.

mod alone;
mod chatter;
mod constants;
mod contact_mode;
mod contacts;
mod cushions;
mod engine;
mod events;
mod extrapolation;
mod foresight;
mod impacts;
mod meetings;
mod playback;
mod predict;
mod pressing;
mod regime;
mod resting;
mod roots;
mod savings;
mod segment;
mod tolerance;

#[cfg(test)]
mod tests;

pub use crate::table::Rail;
pub use constants::Constants;
pub use engine::{End, simulate, simulate_with, watch, watch_with};
pub use events::{Event, EventKind, Observer, Patience};
pub use playback::{Recorder, Recording, ShotError};
pub use savings::{All, Savings};
pub use segment::{Curve, Segment};
pub use tolerance::Tolerance;
