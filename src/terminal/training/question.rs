//! What the training screen asks before it does something.

use super::watch::Watch;
use crate::terminal::{keymap::TrainingWhen, words::count};

/// What a name for a file may hold.
const ACCEPTED: &str = "letters, digits, '-', '_' and '.', which does not come first";
/// Most letters of a name.
const LONGEST_NAME: usize = 60;

/// A question that waits for an answer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Question {
    /// Whether to stop the run and save it.
    Stop,
    /// Whether to abandon the run.
    Abandon,
    /// Under which name the policy is kept, as far as it is typed.
    Name(String),
    /// Whether the policy that has this name already may be replaced.
    Replace(String),
}

impl Question {
    /// The question about the run that is watched.
    pub fn text(&self, watch: &Watch) -> String {
        let name = &watch.own.name;
        match self {
            Self::Stop => format!("stop {name}: measure it, save it and end it? y/n"),
            Self::Abandon => {
                let shots = count(watch.own.run.shots());
                let best = watch.own.run.history.best();
                let best = best.map_or(String::new(), |best| format!(", with a best held-out reward of {best:.3}"));
                format!("abandon {name}: end it now and delete its folder? {shots} shots are lost{best}. y/n")
            }
            Self::Name(typed) => format!("keep the weights under the name: {typed}_"),
            Self::Replace(name) => format!("there is a policy called {name} already; replace it? y/n"),
        }
    }

    /// As long as what it may be asked and answered.
    pub const fn when(&self) -> TrainingWhen {
        match self {
            Self::Stop | Self::Abandon => TrainingWhen::AtWork,
            Self::Name(_) | Self::Replace(_) => TrainingWhen::Known,
        }
    }

    /// A letter was typed; `false` where none is taken.
    pub fn typed(&mut self, letter: char) -> bool {
        let Self::Name(name) = self else { return false };
        if !letter.is_control() && name.chars().count() < LONGEST_NAME {
            name.push(letter);
        }
        true
    }

    /// Takes the last letter back.
    pub fn erase(&mut self) {
        if let Self::Name(name) = self {
            name.pop();
        }
    }
}

/// What is wrong with a name for a file; `None` where nothing is.
pub fn wrong_name(name: &str) -> Option<String> {
    if name.is_empty() {
        return Some(format!("a name is needed; accepted are {ACCEPTED}"));
    }
    let is_sign = |letter: char| letter.is_alphanumeric() || "-_.".contains(letter);
    let is_wrong = name.starts_with('.') || !name.chars().all(is_sign);
    is_wrong.then(|| format!("{name:?} is no name for a policy; accepted are {ACCEPTED}"))
}
