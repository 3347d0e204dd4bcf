//! What is asked over the table, and what is done about the answer.

use crate::{
    drills::Exercise,
    terminal::{
        Effect,
        pages::{
            Page,
            coach::{CoachPage, saving::named},
        },
        shot::stroke::SAY,
        ui::TextField,
    },
};

/// A question that waits for an answer.
#[derive(Debug)]
pub enum Question {
    /// Where the balls are to lie, as far as it is typed.
    Positions(TextField),
    /// The player's own stroke in words, as far as it is typed.
    Stroke(TextField),
    /// What the position that is saved is to be called, and tags, as far as they are typed.
    Title(TextField, Box<Exercise>),
    /// Whether the position of the same name may be replaced.
    Replace(Box<Exercise>),
}

impl Question {
    /// The question, without what is typed; `selected` is the ball of these `names` that may be placed alone.
    pub fn text(&self, names: [&str; 3], selected: usize) -> String {
        match self {
            Self::Positions(_) => {
                let [cue, other, _] = names;
                let one = names[selected];
                format!(
                    "where? 2d 0.5d for {one}; three such places for {cue}, {other} and red; red 4d 3.5d for red; \
                     or a share code: "
                )
            }
            Self::Stroke(_) => SAY.to_owned(),
            Self::Title(..) => "save the balls as (a title, and #tags if you like): ".to_owned(),
            Self::Replace(exercise) => {
                format!("there is a position called {} already; replace it?", exercise.name)
            }
        }
    }

    /// The text that is typed, where some is.
    pub const fn field(&self) -> Option<&TextField> {
        match self {
            Self::Positions(typed) | Self::Stroke(typed) | Self::Title(typed, _) => Some(typed),
            Self::Replace(_) => None,
        }
    }
}

impl CoachPage {
    /// Does what was asked. What is typed and cannot be taken stays, to be mended.
    pub(super) fn yes(&mut self) -> Option<Effect> {
        let question = self.question.take()?;
        let done = match &question {
            Question::Positions(typed) => self.take_typed(typed.text()).map(|()| None),
            Question::Stroke(typed) => self.say_stroke(typed.text()),
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
