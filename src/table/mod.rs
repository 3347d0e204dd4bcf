//! What is played on: the table's parameters and the layout of its three balls.

mod cue_ball;
mod layout;
mod opening;
mod parameters;
mod rail;
mod room;

pub use cue_ball::{CueBall, UnknownCueBall};
pub use layout::{BALL_NAMES, BALLS, Layout, LayoutError, TOUCHING_TOLERANCE};
pub use opening::{Opening, Side, UnknownSide};
pub use parameters::{PRESETS, Table, TableError};
pub use rail::Rail;
pub use room::Room;
