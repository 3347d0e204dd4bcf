//! Messages to the player: news, answers, refusals and failures.

use crate::storage::without_numbers;

/// What kind of news a message is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tone {
    /// Neither good nor bad.
    Plain,
    /// Something has worked.
    Good,
    /// An answer that is not what one had hoped for.
    Poor,
    /// Something was refused or has failed: where it is news it becomes a toast.
    Warning,
}

/// A sentence for the status line or a toast.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Message {
    /// What kind of news it is.
    pub tone: Tone,
    /// The sentence.
    pub text: String,
}

impl Message {
    /// Neither good nor bad news.
    pub fn plain(text: impl Into<String>) -> Self {
        Self { tone: Tone::Plain, text: text.into() }
    }

    /// Good news.
    pub fn good(text: impl Into<String>) -> Self {
        Self { tone: Tone::Good, text: text.into() }
    }

    /// A bad answer.
    pub fn poor(text: impl Into<String>) -> Self {
        Self { tone: Tone::Poor, text: text.into() }
    }

    /// A refusal or a failure.
    pub fn warning(text: impl Into<String>) -> Self {
        Self { tone: Tone::Warning, text: without_numbers(text.into()) }
    }

    /// The same news, with other words before it.
    #[must_use]
    pub fn prefixed(self, words: &str) -> Self {
        Self { text: format!("{words}: {}", self.text), ..self }
    }

    /// Whether it is a refusal or a failure.
    pub fn is_warning(&self) -> bool {
        self.tone == Tone::Warning
    }
}
