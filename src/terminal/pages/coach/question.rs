//! The questions that the coach page asks over the table, and the handling of their answers.

use crate::{
    drills::Exercise,
    terminal::{
        Effect,
        pages::{
            Page,
            coach::{CoachPage, saving::named},
        },
        shot::stroke::STROKE_PROMPT,
        ui::TextField,
    },
};

/// A question that waits for an answer.
#[derive(Debug)]
pub enum Question {
    /// Ball positions, with the text typed so far.
    Positions(TextField),
    /// The player's own stroke in words, with the text typed so far.
    Stroke(TextField),
    /// Title and tags of the position to save, with the text typed so far.
    Title(TextField, Box<Exercise>),
    /// Whether to replace the saved position with the same name.
    Replace(Box<Exercise>),
}

impl Question {
    /// The question, without the typed answer. `selected` is the index in `names` of the ball that can be placed alone.
    pub fn text(&self, names: [&str; 3], selected: usize) -> String {
        match self {
            Self::Positions(_) => {
                // In one row of 80 columns, so that it does not cover the positions.
                format!("where is {}? (2d 0.5d, or all three, or a share code) ", names[selected])
            }
            Self::Stroke(_) => STROKE_PROMPT.to_owned(),
            Self::Title(..) => "save the balls as (a title, and #tags if you like): ".to_owned(),
            Self::Replace(exercise) => {
                format!("there is a position called {} already; replace it?", exercise.name)
            }
        }
    }

    /// The text field of the answer; `None` if the answer is yes or no.
    pub const fn field(&self) -> Option<&TextField> {
        match self {
            Self::Positions(typed) | Self::Stroke(typed) | Self::Title(typed, _) => Some(typed),
            Self::Replace(_) => None,
        }
    }
}

impl CoachPage {
    /// Performs what the open question asked about. If the typed text is not valid, the question stays open for a correction.
    pub(super) fn accept_answer(&mut self) -> Option<Effect> {
        let question = self.question.take()?;
        let done = match &question {
            Question::Positions(typed) => self.apply_positions(typed.text()).map(|()| None),
            Question::Stroke(typed) => self.set_stroke_in_words(typed.text()),
            Question::Title(typed, position) => {
                named(typed.text(), position).map(|exercise| Some(self.save(exercise, false)))
            }
            Question::Replace(exercise) => Ok(Some(self.save(exercise.clone(), true))),
        };
        done.unwrap_or_else(|sentence| {
            self.question = Some(question);
            self.refuse(sentence)
        })
    }
}
