//! When things happen: event prediction, the engine, the fixed-step method, and playback of what it recorded.

mod constants;
mod engine;
mod events;
mod playback;
mod predict;
mod resting;
mod roots;
mod segment;
mod settling;
mod steps;

pub use constants::Constants;
pub use engine::{End, simulate};
pub use events::{Event, EventKind, Observer, Rail};
pub use playback::{Recording, ShotError};
pub use segment::{Curve, Segment};
pub use steps::{StepError, Stepped, Steps};
