//! What the drill screens ask before they do something.

use crate::{
    drills::Exercise,
    terminal::{DrillAction, shot::stroke::SAY, ui::TextField},
};

/// Longest text that is typed or pasted, bytes: a code of many lines that a chat has wrapped fits.
pub(super) const LONGEST: usize = 4000;

/// A question that waits for an answer.
#[derive(Clone, Debug, PartialEq)]
pub enum Question {
    /// Words to look for.
    Search {
        /// As far as they are typed.
        typed: TextField,
        /// Those that were looked for before.
        before: String,
        /// The name of the exercise that was marked then.
        marked: String,
    },
    /// A share code.
    Code(TextField),
    /// The stroke in words.
    Stroke(TextField),
    /// Whether the position of the same name may be replaced.
    Replace(Box<Exercise>),
    /// Whether the position of this name may be removed.
    Remove(String),
    /// Whether to leave an exam that is not over: attempts made and to be made.
    Leave(usize, usize),
    /// Whether to do what begins another session, though the run, game or match that is called this is not over, after so many
    /// attempts.
    GiveUp(DrillAction, &'static str, usize),
}

impl Question {
    /// The question as it stands on the status line, without what is typed.
    pub fn text(&self) -> String {
        match self {
            Self::Search { .. } => "find: ".to_owned(),
            Self::Code(_) => "paste or type the code of a position: ".to_owned(),
            Self::Stroke(_) => SAY.to_owned(),
            Self::Replace(exercise) => {
                format!("there is a position called {} already; replace it?", exercise.name)
            }
            Self::Remove(name) => format!("remove your position {name}? Its results stay."),
            Self::Leave(made, all) => {
                format!("leave the exam after {made} of {all} exercises? c on the coach's page goes on with it.")
            }
            Self::GiveUp(_, what, made) => {
                let attempts = if *made == 1 { "1 attempt? It stays" } else { &format!("{made} attempts? They stay") };
                format!("give up the {what} after {attempts} in the record.")
            }
        }
    }

    /// The text that is typed, where some is.
    pub fn field(&self) -> Option<&TextField> {
        match self {
            Self::Search { typed, .. } | Self::Code(typed) | Self::Stroke(typed) => Some(typed),
            _ => None,
        }
    }
}
