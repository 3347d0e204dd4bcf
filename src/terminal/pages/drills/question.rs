//! The questions of the drill page.

use crate::{
    drills::Exercise,
    terminal::{DrillAction, shot::stroke::STROKE_PROMPT, ui::TextField},
};

/// Maximum length of a typed or pasted text, bytes. A share code that a chat program has wrapped into many lines fits.
pub(super) const MAX_TEXT_LENGTH: usize = 4000;

/// A question that waits for an answer.
#[derive(Clone, Debug, PartialEq)]
pub enum Question {
    /// The text of a search.
    Search {
        /// The text field.
        typed: TextField,
        /// The search text before this search.
        before: String,
        /// The name of the exercise that was marked before this search.
        marked: String,
    },
    /// A share code.
    Code(TextField),
    /// The stroke in words.
    Stroke(TextField),
    /// Whether to replace the saved position with the same name.
    Replace(Box<Exercise>),
    /// Whether to remove the position with this name.
    Remove(String),
    /// Whether to leave an unfinished exam: attempts so far, and number of exercises.
    Leave(usize, usize),
    /// Whether to discard an unfinished exam: attempts so far, and number of exercises.
    Discard(usize, usize),
    /// Whether to perform an action that starts another session although a run, game or match is unfinished: the action, the name of
    /// the goal, and the number of attempts so far.
    GiveUp(DrillAction, &'static str, usize),
}

impl Question {
    /// The question as shown in the status line, without the typed text.
    pub fn text(&self) -> String {
        match self {
            Self::Search { .. } => "find: ".to_owned(),
            Self::Code(_) => "paste or type the code of a position: ".to_owned(),
            Self::Stroke(_) => STROKE_PROMPT.to_owned(),
            Self::Replace(exercise) => {
                format!("there is a position called {} already; replace it?", exercise.name)
            }
            Self::Remove(name) => format!("remove your position {name}? Its results stay."),
            Self::Leave(made, all) => {
                format!("leave the exam after {made} of {all} exercises? c on the coach's page goes on with it.")
            }
            Self::Discard(made, all) => {
                format!(
                    "discard the exam after {made} of {all} exercises? It cannot be continued; its results stay in the record."
                )
            }
            Self::GiveUp(action, what, made) => {
                let attempts = if *made == 1 { "1 attempt? It stays" } else { &format!("{made} attempts? They stay") };
                let reason = match action {
                    DrillAction::ChangeGoalLength(_) => "for another length, ",
                    DrillAction::NextGoal => "for another goal, ",
                    DrillAction::NextPlayer => "for another player, ",
                    _ => "",
                };
                format!("{reason}give up the {what} after {attempts} in the record.")
            }
        }
    }

    /// The text field of the answer; `None` if the answer is yes or no.
    pub fn field(&self) -> Option<&TextField> {
        match self {
            Self::Search { typed, .. } | Self::Code(typed) | Self::Stroke(typed) => Some(typed),
            _ => None,
        }
    }
}
