//! The player's choice of what the cue ball hits first.

use std::str::FromStr;

use super::ShotWords;
use crate::{
    game::{Point, Tally},
    table::{BALL_NAMES, BALLS},
};

/// What the cue ball must hit first.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FirstContact {
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
pub const NO_MATCHING_ATTEMPT: &str = "no attempt begins that way; this is a plain stroke";

/// Error: an unknown name of what is hit first.
#[derive(Debug, thiserror::Error, PartialEq)]
#[error("\"{word}\" cannot be hit first; use {}", FirstContact::ALL.map(|first| first.word(*names)).join(", "))]
pub struct UnknownFirstContact {
    word: String,
    names: [&'static str; BALLS],
}

impl FirstContact {
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

    /// Returns the rule that forbids a point to every shot that begins like this; `None` if none does.
    pub fn forbidden_by(self, point: Point) -> Option<&'static str> {
        (self == Self::OtherCueBall && point.first_ball() == 2).then_some("a game opens with red")
    }

    /// Returns the suffix that describes how a shot begins; empty for [`Any`](Self::Any).
    pub fn opening_words(self, names: [&'static str; BALLS]) -> String {
        if self == Self::Any { String::new() } else { format!(" with {} first", self.word(names)) }
    }

    /// Parses `word`, given the names of the balls, cue ball first.
    ///
    /// # Errors
    /// [`UnknownFirstContact`], which lists the accepted names.
    pub fn parse(word: &str, names: [&'static str; BALLS]) -> Result<Self, UnknownFirstContact> {
        let found = Self::ALL.into_iter().find(|first| first.word(names).eq_ignore_ascii_case(word));
        found.ok_or_else(|| UnknownFirstContact { word: word.to_owned(), names })
    }

    /// Whether a shot with this tally begins as chosen.
    pub fn allows(self, tally: &Tally) -> bool {
        self.is_met(tally.first_ball(), tally.cushions_before_first > 0)
    }

    /// Whether a shot that is described by `words` begins as chosen.
    pub fn allows_words(self, words: &ShotWords) -> bool {
        self.is_met(words.first.map(|hit| hit.ball), !words.before.is_empty())
    }

    fn is_met(self, first_ball: Option<usize>, after_cushion: bool) -> bool {
        match self {
            Self::Any => true,
            Self::OtherCueBall => first_ball == Some(1) && !after_cushion,
            Self::Red => first_ball == Some(2) && !after_cushion,
            Self::Cushion => first_ball.is_some() && after_cushion,
        }
    }
}

/// Parses the names of the command line, where white is the cue ball.
impl FromStr for FirstContact {
    type Err = UnknownFirstContact;

    fn from_str(text: &str) -> Result<Self, UnknownFirstContact> {
        Self::parse(text, BALL_NAMES)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tally_determines_the_allowed_first_contacts() {
        let allowed = |cushions_before_first, hit: [bool; 2]| {
            let tally = Tally { hit, red_first: hit[1], cushions_before_first, ..Tally::default() };
            FirstContact::ALL.map(|first| first.allows(&tally))
        };
        assert_eq!(allowed(0, [true, false]), [true, true, false, false]);
        assert_eq!(allowed(0, [false, true]), [true, false, true, false]);
        assert_eq!(allowed(2, [false, true]), [true, false, false, true]);
        assert_eq!(allowed(0, [false, false]), [true, false, false, false]);
    }

    #[test]
    fn choices_are_parsed_by_ball_names() {
        assert_eq!("yellow".parse(), Ok(FirstContact::OtherCueBall));
        assert_eq!(FirstContact::parse("white", ["yellow", "white", "red"]), Ok(FirstContact::OtherCueBall));
        let unknown = "white".parse::<FirstContact>().unwrap_err().to_string();
        assert_eq!(unknown, "\"white\" cannot be hit first; use any, yellow, red, cushion");
    }
}
