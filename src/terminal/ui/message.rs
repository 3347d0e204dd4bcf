//! Messages to the player: news, answers, refusals and failures.

use crate::storage::without_error_numbers;

/// Tone of a message, which sets its colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tone {
    /// Neutral.
    Plain,
    /// Something has worked.
    Good,
    /// A disappointing answer.
    Poor,
    /// Something was refused or has failed; a new one becomes a toast.
    Warning,
}

/// A sentence for the status line or a toast.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Message {
    /// Tone of the message.
    pub tone: Tone,
    /// The sentence.
    pub text: String,
}

impl Message {
    /// Creates a neutral message.
    pub fn plain(text: impl Into<String>) -> Self {
        Self { tone: Tone::Plain, text: text.into() }
    }

    /// Creates a message of success.
    pub fn good(text: impl Into<String>) -> Self {
        Self { tone: Tone::Good, text: text.into() }
    }

    /// Creates a message with a disappointing answer.
    pub fn poor(text: impl Into<String>) -> Self {
        Self { tone: Tone::Poor, text: text.into() }
    }

    /// Creates a message of a refusal or a failure.
    pub fn warning(text: impl Into<String>) -> Self {
        Self { tone: Tone::Warning, text: without_error_numbers(text.into()) }
    }

    /// Puts `words` and a colon before the text.
    #[must_use]
    pub fn prefixed(self, words: &str) -> Self {
        Self { text: format!("{words}: {}", self.text), ..self }
    }

    /// Whether it is a refusal or a failure.
    pub fn is_warning(&self) -> bool {
        self.tone == Tone::Warning
    }
}
