//! The four cushions by name.

use glam::DVec2;
use serde::Serialize;

/// One of the four cushions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Rail {
    /// The short cushion at `-L/2`.
    Left,
    /// The short cushion at `+L/2`.
    Right,
    /// The long cushion at `-l/2`.
    Bottom,
    /// The long cushion at `+l/2`.
    Top,
}

impl Rail {
    /// All four, in a fixed order.
    pub const ALL: [Self; 4] = [Self::Left, Self::Right, Self::Bottom, Self::Top];

    /// The name used in JSON and on the screen.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Left => "left",
            Self::Right => "right",
            Self::Bottom => "bottom",
            Self::Top => "top",
        }
    }

    /// Unit vector from the cushion into the table.
    pub const fn normal(self) -> DVec2 {
        match self {
            Self::Left => DVec2::X,
            Self::Right => DVec2::NEG_X,
            Self::Bottom => DVec2::Y,
            Self::Top => DVec2::NEG_Y,
        }
    }

    /// The cushion whose normal into the table is `n`, one of the four.
    pub fn with_normal(n: DVec2) -> Self {
        Self::ALL.into_iter().find(|rail| rail.normal() == n).unwrap_or(Self::Left)
    }
}
