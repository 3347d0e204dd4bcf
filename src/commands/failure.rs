//! How a command ends when it cannot do what was asked: one sentence and an exit code. docs/command-line.md has the rule.

use std::{fmt::Display, io};

use crate::{learning::PolicyError, platform::UNFINISHED, storage::without_numbers};

/// A sentence for the user and the process' exit code.
#[derive(Clone, Debug, thiserror::Error)]
#[error("{message}")]
pub struct Failure {
    message: String,
    code: u8,
}

impl Failure {
    /// What was asked for is acceptable, but cannot be done: what a name or a path stands for is not there or cannot be read, or something
    /// went wrong: exit code 1.
    pub fn failed(message: impl Display) -> Self {
        Self { message: without_numbers(message.to_string()), code: 1 }
    }

    /// The command line, a line of the input or what a file holds is not acceptable, whatever there is on this machine: exit code 2.
    pub fn wrong_input(message: impl Display) -> Self {
        Self { message: without_numbers(message.to_string()), code: 2 }
    }

    /// What was begun can go on by the same command.
    pub fn unfinished(message: impl Display) -> Self {
        Self { message: message.to_string(), code: UNFINISHED }
    }

    /// All is said already.
    pub const fn said(code: u8) -> Self {
        Self { message: String::new(), code }
    }

    /// The process' exit code.
    pub const fn code(&self) -> u8 {
        self.code
    }

    /// Whether there is nothing to say: it is said already, or the reader of the output has closed it.
    pub fn is_silent(&self) -> bool {
        self.message.is_empty()
    }
}

impl From<PolicyError> for Failure {
    /// A file that cannot be read is another thing than one that holds no policy.
    fn from(error: PolicyError) -> Self {
        match error {
            PolicyError::Read { .. } => Self::failed(error),
            PolicyError::Content { .. } | PolicyError::Damaged { .. } | PolicyError::Version { .. } => {
                Self::wrong_input(error)
            }
        }
    }
}

impl From<io::Error> for Failure {
    /// An error in writing the output. A closed pipe (`carom simulate | head`) is no failure of ours.
    fn from(error: io::Error) -> Self {
        if error.kind() == io::ErrorKind::BrokenPipe {
            Self::said(0)
        } else {
            Self::failed(format_args!("the output cannot be written: {error}"))
        }
    }
}
