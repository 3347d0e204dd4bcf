//! The failure of a command: one sentence and an exit code. docs/command-line.md states the rule.

use std::{fmt::Display, io};

use crate::{learning::PolicyError, platform::UNFINISHED, storage::without_error_numbers};

/// A sentence for the user and the exit code of the process.
#[derive(Clone, Debug, thiserror::Error)]
#[error("{message}")]
pub struct Failure {
    message: String,
    code: u8,
}

impl Failure {
    /// The request is acceptable but cannot be fulfilled: a named thing or a path is missing or unreadable, or an operation failed. Exit
    /// code 1.
    pub fn failed(message: impl Display) -> Self {
        Self { message: without_error_numbers(message.to_string()), code: 1 }
    }

    /// The command line, an input line or the content of a file is not acceptable, on any machine. Exit code 2.
    pub fn wrong_input(message: impl Display) -> Self {
        Self { message: without_error_numbers(message.to_string()), code: 2 }
    }

    /// The work was stopped and can be resumed by the same command. Exit code 75.
    pub fn unfinished(message: impl Display) -> Self {
        Self { message: message.to_string(), code: UNFINISHED }
    }

    /// Everything was already reported: there is no further message.
    pub const fn silent(code: u8) -> Self {
        Self { message: String::new(), code }
    }

    /// Returns the exit code of the process.
    pub const fn code(&self) -> u8 {
        self.code
    }

    /// Whether there is no message, because it was already reported or because the reader closed the output.
    pub fn is_silent(&self) -> bool {
        self.message.is_empty()
    }
}

impl From<PolicyError> for Failure {
    /// An unreadable file gives another exit code than a file without a valid policy.
    fn from(error: PolicyError) -> Self {
        match error {
            PolicyError::Read(..) => Self::failed(error),
            PolicyError::Content(_) => Self::wrong_input(error),
        }
    }
}

impl From<io::Error> for Failure {
    /// An error in writing the output. A closed pipe (`carom simulate | head`) does not count as a failure.
    fn from(error: io::Error) -> Self {
        if error.kind() == io::ErrorKind::BrokenPipe {
            Self::silent(0)
        } else {
            Self::failed(format_args!("the output cannot be written: {error}"))
        }
    }
}
