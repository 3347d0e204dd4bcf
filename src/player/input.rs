//! The five cue inputs by name, with the units for display.

use serde::Serialize;

use crate::{physics::CueInputs, table::Table};

/// One of the five cue inputs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Input {
    /// The tip position to the side, mm.
    #[serde(rename = "a")]
    Side,
    /// The tip position in height, mm.
    #[serde(rename = "b")]
    Height,
    /// The cue's elevation, degrees.
    #[serde(rename = "theta")]
    Elevation,
    /// The direction, degrees.
    #[serde(rename = "phi")]
    Direction,
    /// The speed, m/s.
    #[serde(rename = "V")]
    Speed,
}

impl Input {
    /// All five inputs.
    pub const ALL: [Self; 5] = [Self::Side, Self::Height, Self::Elevation, Self::Direction, Self::Speed];

    /// Returns the letter in the thesis.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Side => "a",
            Self::Height => "b",
            Self::Elevation => "theta",
            Self::Direction => "phi",
            Self::Speed => "V",
        }
    }

    /// Returns the unit for display.
    pub const fn unit(self) -> &'static str {
        match self {
            Self::Side | Self::Height => "mm",
            Self::Elevation | Self::Direction => "degrees",
            Self::Speed => "m/s",
        }
    }

    /// Returns the stroke with this input changed by `by` of its units.
    #[must_use]
    pub fn shifted(self, table: &Table, cue: &CueInputs, by: f64) -> CueInputs {
        let mut cue = *cue;
        match self {
            Self::Side => cue.a += 1e-3 * by / table.radius,
            Self::Height => cue.b += 1e-3 * by / table.radius,
            Self::Elevation => cue.theta += by.to_radians(),
            Self::Direction => cue.phi += by.to_radians(),
            Self::Speed => cue.speed += by,
        }
        cue
    }
}
