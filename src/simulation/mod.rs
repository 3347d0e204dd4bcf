//! When things happen: event prediction, the engine, and playback of what it recorded.

mod events;

pub use events::{Event, EventKind, Observer, Rail};

/// Placeholder until the engine lands.
#[derive(Clone, Copy, Debug)]
pub struct Segment;
