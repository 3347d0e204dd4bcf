//! Event-driven simulation of a shot: event prediction, the engine, and playback of the recorded trajectories.
//!
//! Suggested reading order: `segment` (motion of a ball between two events), `roots` and `predict` (when a gap closes), `scheduler`
//! (selection of the next event), `engine` (the event loop), `impacts` (collision events), `chatter` and `resting` (contacts that close
//! repeatedly or stay closed), `playback`.

mod aloft;
mod ball_ball;
mod bounded;
mod chatter;
mod constants;
mod contacts;
mod cushion_contacts;
mod cushions;
mod engine;
mod events;
mod extrapolation;
mod flights;
mod follower;
mod guards;
mod hops;
mod impacts;
mod jumps;
mod lone_ball;
mod micro_collisions;
mod playback;
mod predict;
mod pressing;
mod reach;
mod resting;
mod roots;
mod savings;
mod scheduler;
mod segment;
mod together;
mod tolerance;

#[cfg(test)]
mod tests;

pub use crate::table::Rail;
pub use aloft::Nose;
pub use bounded::BoundedRecorder;
pub use constants::Constants;
pub use cushion_contacts::CushionContacts;
pub use engine::{End, simulate, simulate_with, watch, watch_with};
pub use events::{Event, EventKind, Observer, StepBudget};
pub use follower::{Follower, lone_ball_layout};
pub use hops::{Arc, Hops};
pub use jumps::{Jump, OffTable, REPORTED_HEIGHT};
pub use playback::{Recorder, Recording, ShotError, Start};
pub use savings::{AllSavings, Savings};
pub use segment::{Course, Curve, Segment};
pub use tolerance::Tolerance;
