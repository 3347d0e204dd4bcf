//! The one line that says what has just happened or what was refused.

/// What kind of news a message is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tone {
    /// Neither good nor bad.
    Plain,
    /// Something has worked.
    Good,
    /// Something was refused or has failed.
    Warning,
}

/// A sentence for the status line.
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

    /// A refusal or a failure.
    pub fn warning(text: impl Into<String>) -> Self {
        Self { tone: Tone::Warning, text: text.into() }
    }

    /// The same news after some other words.
    #[must_use]
    pub fn after(self, words: &str) -> Self {
        Self { text: format!("{words}: {}", self.text), ..self }
    }

    /// Whether it is a refusal or a failure.
    pub fn is_warning(&self) -> bool {
        self.tone == Tone::Warning
    }
}
