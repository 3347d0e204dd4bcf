//! The table's parameters and the layout of its three balls.

mod cue_ball;
mod doubt;
mod flaws;
mod flight;
mod layout;
mod models;
mod opening;
mod parameters;
mod positions;
mod rail;
mod room;
mod sampler;

pub use cue_ball::{CueBall, UnknownCueBall};
pub use doubt::{AlternativeLaw, DoubtError, TableDoubt};
pub use flaws::{max_sliding_friction, steepest_tilt};
pub use flight::Flight;
pub use layout::{BALL_NAMES, BALLS, Layout, LayoutError, PAIRS, TOUCHING_TOLERANCE};
pub(crate) use models::is_default;
pub use models::{Fade, RailModel, RailOverrides, Rails, SlipFriction};
pub use opening::{Opening, Side, UnknownSide};
pub use parameters::{PRESETS, THESIS_PRESETS, Table, TableError};
pub use positions::PositionsError;
pub use rail::Rail;
pub use room::Room;
pub use sampler::TableSampler;
