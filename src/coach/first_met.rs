//! The player's choice of what the cue ball hits first.

use std::str::FromStr;

use super::ShotWords;
use crate::{
    game::Tally,
    table::{BALL_NAMES, BALLS},
};

/// What the cue ball must hit first.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FirstMet {
    /// No preference.
    #[default]
    Any,
    /// The other cue ball, with no cushion before it.
    OtherCueBall,
    /// The red ball, with no cushion before it.
    Red,
    /// At least one cushion before the first ball, which may be either.
    Cushion,
}

/// Note on the reported stroke if no attempt begins as requested.
pub const NO_ATTEMPT: &str = "no such attempt either; this is a plain stroke";

/// Error: an unknown name of what is hit first.
#[derive(Debug, thiserror::Error, PartialEq)]
#[error("\"{word}\" cannot be hit first; use {}", FirstMet::ALL.map(|first| first.word(*names)).join(", "))]
pub struct UnknownFirstMet {
    word: String,
    names: [&'static str; BALLS],
}

impl FirstMet {
    /// All variants.
    pub const ALL: [Self; 4] = [Self::Any, Self::OtherCueBall, Self::Red, Self::Cushion];

    /// Returns the name of this choice, given the names of the balls, cue ball first.
    pub const fn word(self, [_, other, red]: [&'static str; BALLS]) -> &'static str {
        match self {
            Self::Any => "any",
            Self::OtherCueBall => other,
            Self::Red => red,
            Self::Cushion => "cushion",
        }
    }

    /// Returns the suffix that describes how a shot begins; empty for [`Any`](Self::Any).
    pub fn begins(self, names: [&'static str; BALLS]) -> String {
        if self == Self::Any { String::new() } else { format!(" with {} first", self.word(names)) }
    }

    /// Parses `word`, given the names of the balls, cue ball first.
    ///
    /// # Errors
    /// [`UnknownFirstMet`], which lists the accepted names.
    pub fn said(word: &str, names: [&'static str; BALLS]) -> Result<Self, UnknownFirstMet> {
        let said = Self::ALL.into_iter().find(|first| first.word(names) == word);
        said.ok_or_else(|| UnknownFirstMet { word: word.to_owned(), names })
    }

    /// Whether a shot with this tally begins as chosen.
    pub fn allows(self, tally: &Tally) -> bool {
        let met = if tally.cushions_before_first > 0 { Self::Cushion } else { Self::of_ball(tally.first_ball()) };
        self == Self::Any || self == met
    }

    /// Whether a shot that is described by `words` begins as chosen.
    pub fn allows_told(self, words: &ShotWords) -> bool {
        let met = match words.first {
            Some(_) if !words.before.is_empty() => Self::Cushion,
            first => Self::of_ball(first.map(|hit| hit.ball)),
        };
        self == Self::Any || self == met
    }

    const fn of_ball(ball: Option<usize>) -> Self {
        match ball {
            Some(1) => Self::OtherCueBall,
            Some(2) => Self::Red,
            _ => Self::Any,
        }
    }
}

/// Parses the names of the command line, where white is the cue ball.
impl FromStr for FirstMet {
    type Err = UnknownFirstMet;

    fn from_str(text: &str) -> Result<Self, UnknownFirstMet> {
        Self::said(text, BALL_NAMES)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shot_begins_with_a_cushion_or_a_ball() {
        let allowed = |cushions_before_first, met: [bool; 2]| {
            let tally = Tally { met, red_first: met[1], cushions_before_first, ..Tally::default() };
            FirstMet::ALL.map(|first| first.allows(&tally))
        };
        assert_eq!(allowed(0, [true, false]), [true, true, false, false]);
        assert_eq!(allowed(0, [false, true]), [true, false, true, false]);
        assert_eq!(allowed(2, [false, true]), [true, false, false, true]);
        assert_eq!(allowed(0, [false, false]), [true, false, false, false]);
    }

    #[test]
    fn names_are_those_of_the_balls() {
        assert_eq!("yellow".parse(), Ok(FirstMet::OtherCueBall));
        assert_eq!(FirstMet::said("white", ["yellow", "white", "red"]), Ok(FirstMet::OtherCueBall));
        let unknown = "white".parse::<FirstMet>().unwrap_err().to_string();
        assert_eq!(unknown, "\"white\" cannot be hit first; use any, yellow, red, cushion");
    }
}
