//! The player's choice of cue ball: white or yellow.

use std::{fmt, str::FromStr};

use serde::{Deserialize, Serialize};

use super::{BALL_NAMES, BALLS};

/// The ball that a player strikes. In a layout the cue ball is always ball 0 and the opponent's ball is ball 1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum CueBall {
    /// White; the opponent has yellow.
    #[default]
    White,
    /// Yellow; the opponent has white.
    Yellow,
}

/// Error for a word that does not name a cue ball.
#[derive(Debug, thiserror::Error, PartialEq)]
#[error("there is no cue ball \"{0}\"; use white or yellow")]
pub struct UnknownCueBall(String);

impl CueBall {
    /// Returns the ball's colour as a word.
    pub const fn name(self) -> &'static str {
        self.names()[0]
    }

    /// Returns the colours of the cue ball, the opponent's ball and the red ball, in this order.
    pub const fn names(self) -> [&'static str; BALLS] {
        let [white, yellow, red] = BALL_NAMES;
        match self {
            Self::White => [white, yellow, red],
            Self::Yellow => [yellow, white, red],
        }
    }

    /// Reorders values from the order white, yellow, red to the order of a layout's balls. The same call converts back.
    pub fn to_ball_order<T>(self, mut colours: [T; BALLS]) -> [T; BALLS] {
        if self == Self::Yellow {
            colours.swap(0, 1);
        }
        colours
    }

    /// Returns the opponent's cue ball.
    #[must_use]
    pub const fn other(self) -> Self {
        match self {
            Self::White => Self::Yellow,
            Self::Yellow => Self::White,
        }
    }
}

impl fmt::Display for CueBall {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.pad(self.name())
    }
}

impl FromStr for CueBall {
    type Err = UnknownCueBall;

    fn from_str(text: &str) -> Result<Self, UnknownCueBall> {
        [Self::White, Self::Yellow]
            .into_iter()
            .find(|ball| ball.name() == text)
            .ok_or_else(|| UnknownCueBall(text.to_owned()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ball_order_follows_the_player_and_names_parse() {
        assert_eq!(CueBall::White.names(), BALL_NAMES);
        assert_eq!(CueBall::Yellow.names(), ["yellow", "white", "red"]);
        for ball in [CueBall::White, CueBall::Yellow] {
            assert_eq!(ball.name().parse(), Ok(ball));
            assert_eq!(ball.other().other(), ball);
            assert_eq!(ball.to_ball_order(BALL_NAMES), ball.names());
            assert_eq!(ball.to_ball_order(ball.names()), BALL_NAMES);
        }
        assert!("red".parse::<CueBall>().unwrap_err().to_string().contains("red"));
    }
}
