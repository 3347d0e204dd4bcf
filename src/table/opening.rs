//! How a game opens: which ball stands on the near spot, and which sides the other may stand at.

use std::str::FromStr;

use serde::{Deserialize, Serialize};

/// How the balls are placed for the first shot of a game, and what it has to meet.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Opening {
    /// The cue ball stands on the near spot, the opponent's beside it (thesis Figure 8).
    #[default]
    Thesis,
    /// The opponent's ball stands on the near spot and the cue ball beside it, left or right as the player likes; in
    /// three-cushion the first shot has to meet the red ball first (UMB rules).
    Umb,
}

impl Opening {
    #[expect(clippy::trivially_copy_pass_by_ref, reason = "serde asks for a reference")]
    pub(super) fn is_default(&self) -> bool {
        *self == Self::default()
    }
}

/// The side of the opponent's ball at which the cue ball stands, as the player sees it who looks along the table.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Side {
    /// Left.
    #[default]
    Left,
    /// Right.
    Right,
}

/// A word that is no side.
#[derive(Debug, thiserror::Error, PartialEq)]
#[error("there is no side \"{0}\"; use left or right")]
pub struct UnknownSide(String);

impl Side {
    /// Name on the command line and in sentences.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Left => "left",
            Self::Right => "right",
        }
    }

    /// The other one.
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
