//! Several players in one account: each has a separate folder, and no other player's name can lead into it.

use std::{fmt, str::FromStr};

/// Longest name, in characters.
const MAX_CHARACTERS: usize = 32;

/// A player of a shared account. The name is safe to use as a folder name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Player(String);

/// Error for a name that is not accepted for a player.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "\"{0}\" is not accepted as a player's name; accepted are 1 to {MAX_CHARACTERS} letters a to z and A to Z, digits, \"-\" and \"_\", \
     beginning with a letter or a digit"
)]
pub struct PlayerNameError(String);

impl Player {
    /// Returns the name as the player typed it.
    pub fn name(&self) -> &str {
        &self.0
    }

    /// Returns the name of the player's folder: in lower case, because some file systems do not distinguish upper case.
    pub fn folder(&self) -> String {
        self.0.to_ascii_lowercase()
    }
}

impl Default for Player {
    /// A guest who gives no name.
    fn default() -> Self {
        Self("guest".to_owned())
    }
}

impl FromStr for Player {
    type Err = PlayerNameError;

    fn from_str(name: &str) -> Result<Self, PlayerNameError> {
        let is_letter = |letter: u8| letter.is_ascii_alphanumeric() || matches!(letter, b'-' | b'_');
        let is_name = name.len() <= MAX_CHARACTERS
            && name.bytes().all(is_letter)
            && name.bytes().next().is_some_and(|letter| letter.is_ascii_alphanumeric());
        if is_name { Ok(Self(name.to_owned())) } else { Err(PlayerNameError(name.to_owned())) }
    }
}

impl fmt::Display for Player {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hostile_names_are_refused_with_the_accepted_form() {
        for name in [
            "", ".", "..", "../anna", "a/b", "a\\b", "-rf", "_", ".hidden", "a b", "a\0", "\x1b[2J", "Anna\n", "\u{fc}",
        ] {
            let said = name.parse::<Player>().unwrap_err().to_string();
            assert!(said.contains("accepted are"), "{said}");
        }
        assert!("a".repeat(33).parse::<Player>().is_err() && "a".repeat(32).parse::<Player>().is_ok());
        assert_eq!("Anna-2_b".parse::<Player>().unwrap().folder(), "anna-2_b");
    }
}
