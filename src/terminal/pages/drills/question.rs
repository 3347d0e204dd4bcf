//! What the drill screens ask before they do something.

use crate::{drills::Exercise, learning::policy::kept::is_name};

/// Longest text that is typed or pasted, bytes: a code of many lines that a chat has wrapped fits.
const LONGEST: usize = 4000;
/// Longest name that is made of a title, letters.
const LONGEST_NAME: usize = 40;

/// A question that waits for an answer.
#[derive(Clone, Debug, PartialEq)]
pub enum Question {
    /// Words to look for.
    Search(String),
    /// A share code.
    Code(String),
    /// What the position is to be called, and tags.
    Name(String, Box<Exercise>),
    /// Whether the position of the same name may be replaced.
    Replace(Box<Exercise>),
    /// Whether the position of this name may be removed.
    Remove(String),
    /// Whether to leave an exam that is not over: attempts made and to be made.
    Leave(usize, usize),
}

impl Question {
    /// The question as it stands on the status line.
    pub fn text(&self) -> String {
        match self {
            Self::Search(typed) => format!("find: {typed}_"),
            Self::Code(typed) => format!("paste or type the code of a position: {typed}_"),
            Self::Name(typed, _) => format!("save the balls as (a title, and #tags if you like): {typed}_"),
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
    pub(super) fn typed_mut(&mut self) -> Option<&mut String> {
        match self {
            Self::Search(typed) | Self::Code(typed) | Self::Name(typed, _) => Some(typed),
            _ => None,
        }
    }

    /// Takes what was typed or pasted; `false` where nothing is.
    pub(super) fn type_in(&mut self, text: &str) -> bool {
        let Some(typed) = self.typed_mut() else { return false };
        for letter in text.chars().map(|letter| if letter.is_control() { ' ' } else { letter }) {
            if typed.len() + letter.len_utf8() <= LONGEST {
                typed.push(letter);
            }
        }
        true
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

    #[test]
    fn pasted_lines_are_one_line_and_nothing_is_typed_into_a_yes_or_no() {
        let mut code = Question::Code(String::new());
        assert!(code.type_in("carom:abc\r\ndef") && code == Question::Code("carom:abc  def".to_owned()));
        code.type_in(&"x".repeat(9000));
        assert_eq!(code.typed_mut().unwrap().len(), LONGEST);
        assert!(!Question::Remove("mine".to_owned()).type_in("y"));
    }
}
