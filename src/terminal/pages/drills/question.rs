//! What the drill screens ask before they do something.

use crate::{drills::Exercise, learning::policy::kept::is_name, terminal::ui::input::TextField};

/// Longest text that is typed or pasted, bytes: a code of many lines that a chat has wrapped fits.
const LONGEST: usize = 4000;
/// Longest name that is made of a title, letters.
const LONGEST_NAME: usize = 40;

/// A question that waits for an answer.
#[derive(Clone, Debug, PartialEq)]
pub enum Question {
    /// Words to look for.
    Search(TextField),
    /// A share code.
    Code(TextField),
    /// What the position is to be called, and tags.
    Name(TextField, Box<Exercise>),
    /// Whether the position of the same name may be replaced.
    Replace(Box<Exercise>),
    /// Whether the position of this name may be removed.
    Remove(String),
    /// Whether to leave an exam that is not over: attempts made and to be made.
    Leave(usize, usize),
}

impl Question {
    /// Asks for words to look for.
    pub(super) const fn search() -> Self {
        Self::Search(TextField::new(LONGEST))
    }

    /// Asks for a share code.
    pub(super) const fn code() -> Self {
        Self::Code(TextField::new(LONGEST))
    }

    /// Asks what a position is to be called.
    pub(super) fn name(position: Exercise) -> Self {
        Self::Name(TextField::new(LONGEST), Box::new(position))
    }

    /// The question as it stands on the status line, without what is typed.
    pub fn text(&self) -> String {
        match self {
            Self::Search(_) => "find: ".to_owned(),
            Self::Code(_) => "paste or type the code of a position: ".to_owned(),
            Self::Name(..) => "save the balls as (a title, and #tags if you like): ".to_owned(),
            Self::Replace(exercise) => {
                format!("there is a position called {} already; replace it? y/n", exercise.name)
            }
            Self::Remove(name) => format!("remove your position {name}? Its results stay. y/n"),
            Self::Leave(made, all) => {
                format!("leave the exam after {made} of {all} exercises? It cannot be gone on with. y/n")
            }
        }
    }

    /// The text that is typed, where some is.
    pub fn field(&self) -> Option<&TextField> {
        match self {
            Self::Search(typed) | Self::Code(typed) | Self::Name(typed, _) => Some(typed),
            _ => None,
        }
    }

    /// The same, to be changed.
    pub(super) fn field_mut(&mut self) -> Option<&mut TextField> {
        match self {
            Self::Search(typed) | Self::Code(typed) | Self::Name(typed, _) => Some(typed),
            _ => None,
        }
    }
}

/// The title, the name that is made of it, and the tags of a position, from what was typed.
///
/// # Errors
/// A sentence where no name comes of it.
pub fn named(typed: &str) -> Result<(String, String, Vec<String>), String> {
    let (tags, words): (Vec<&str>, Vec<&str>) = typed.split_whitespace().partition(|word| word.starts_with('#'));
    let title = words.join(" ");
    let mut name = String::new();
    for letter in title.to_lowercase().chars() {
        match letter {
            _ if letter.is_alphanumeric() => name.push(letter),
            // One hyphen between two words, whatever else stands there.
            _ if !name.is_empty() && !name.ends_with('-') => name.push('-'),
            _ => {}
        }
    }
    let name: String = name.chars().take(LONGEST_NAME).collect();
    let name = name.trim_end_matches('-').to_owned();
    if !is_name(&name) {
        return Err(format!("\"{title}\" makes no name; accepted is a title with letters or digits in it"));
    }
    let tags = tags.iter().map(|tag| tag.trim_start_matches('#').to_owned()).filter(|tag| !tag.is_empty()).collect();
    Ok((title, name, tags))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_title_makes_a_name_that_is_accepted_and_tags_are_told_from_it() {
        let (title, name, tags) = named("  Draw to the #draw  corner, (hard!)  #club #").unwrap();
        assert_eq!((title.as_str(), name.as_str()), ("Draw to the corner, (hard!)", "draw-to-the-corner-hard"));
        assert_eq!(tags, ["draw", "club"]);
        assert!(is_name(&named(&"a very long title ".repeat(20)).unwrap().1));
        for bad in ["", " #tag ", "(?)", "---"] {
            assert!(named(bad).is_err(), "{bad}");
        }
    }
}
