//! Opening rules of a game: which ball stands on the near spot, and on which side of it the other ball may stand.

use std::str::FromStr;

use serde::{Deserialize, Serialize};

/// Positions of the balls for the first shot of a game, and the ball that this shot must hit first.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Opening {
    /// The cue ball stands on the near spot, the opponent's ball next to it (thesis Figure 8).
    #[default]
    Thesis,
    /// The opponent's ball stands on the near spot. The cue ball stands next to it, on the left or right as the player chooses. The first
    /// shot must hit the red ball first (rules of carom, common to all its games).
    Umb,
}

/// The side of the opponent's ball on which the cue ball stands, for a player who looks along the table.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Side {
    /// Left.
    #[default]
    Left,
    /// Right.
    Right,
}

/// Error for a word that is not a side.
#[derive(Debug, thiserror::Error, PartialEq)]
#[error("there is no side \"{0}\"; use left or right")]
pub struct UnknownSide(String);

impl Side {
    /// Returns the name used on the command line and in sentences.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Left => "left",
            Self::Right => "right",
        }
    }

    /// Returns the opposite side.
    #[must_use]
    pub const fn other(self) -> Self {
        match self {
            Self::Left => Self::Right,
            Self::Right => Self::Left,
        }
    }
}

impl FromStr for Side {
    type Err = UnknownSide;

    fn from_str(text: &str) -> Result<Self, UnknownSide> {
        [Self::Left, Self::Right]
            .into_iter()
            .find(|side| side.name() == text)
            .ok_or_else(|| UnknownSide(text.to_owned()))
    }
}
