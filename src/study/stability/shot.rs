//! A shot in the units in which a person would write it, so that a failure can be reproduced exactly.

use serde::{Deserialize, Serialize};

use crate::{physics::CueDegrees, table::Layout};

/// A layout and a stroke.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Shot {
    /// Initial positions of the balls.
    pub layout: Layout,
    /// The stroke.
    pub cue: CueDegrees,
}
