//! What the drill screens ask before they do something.

use crate::drills::Exercise;

/// Longest text that is typed or pasted, bytes: a code of many lines that a chat has wrapped fits.
const LONGEST: usize = 4000;

/// A question that waits for an answer.
#[derive(Clone, Debug, PartialEq)]
pub enum Question {
    /// Words to look for.
    Search(String),
    /// A share code.
    Code(String),
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
            Self::Replace(exercise) => {
                format!("there is a position called {} already; replace it? y/n", exercise.name)
            }
            Self::Remove(name) => format!("remove your position {name}? Its results stay. y/n"),
            Self::Leave(made, all) => {
                format!("leave the exam after {made} of {all} exercises? c on the coach's page goes on with it. y/n")
            }
        }
    }

    /// The text that is typed, where some is.
    pub(super) fn typed_mut(&mut self) -> Option<&mut String> {
        match self {
            Self::Search(typed) | Self::Code(typed) => Some(typed),
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pasted_lines_are_one_line_and_nothing_is_typed_into_a_yes_or_no() {
        let mut code = Question::Code(String::new());
        assert!(code.type_in("carom:abc\r\ndef") && code == Question::Code("carom:abc  def".to_owned()));
        code.type_in(&"x".repeat(9000));
        assert_eq!(code.typed_mut().unwrap().len(), LONGEST);
        assert!(!Question::Remove("mine".to_owned()).type_in("y"));
    }
}
