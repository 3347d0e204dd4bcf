//! A shot as the studies keep it: with the very numbers that a person would write, so that a failure can be repeated.

use serde::{Deserialize, Serialize};

use crate::{physics::CueDegrees, table::Layout};

/// A layout and a stroke.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Shot {
    /// Where the balls lie.
    pub layout: Layout,
    /// How the cue ball is struck.
    pub cue: CueDegrees,
}
