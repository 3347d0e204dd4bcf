//! How a command ends when it cannot do what was asked: one sentence and an exit code.

use std::{fmt::Display, io};

use crate::platform::UNFINISHED;

/// A sentence for the user and the process' exit code.
#[derive(Debug, thiserror::Error)]
#[error("{message}")]
pub struct Failure {
    message: String,
    code: u8,
}

impl Failure {
    /// Something was not found, could not be read or went wrong: exit code 1.
    pub fn failed(message: impl Display) -> Self {
        Self { message: message.to_string(), code: 1 }
    }

    /// The input is wrong: exit code 2.
    pub fn wrong_input(message: impl Display) -> Self {
        Self { message: message.to_string(), code: 2 }
    }

    /// What was begun can go on by the same command.
    pub fn unfinished(message: impl Display) -> Self {
        Self { message: message.to_string(), code: UNFINISHED }
    }

    /// The process' exit code.
    pub const fn code(&self) -> u8 {
        self.code
    }

    /// Whether there is nothing to say: the reader of the output has closed it.
    pub fn is_silent(&self) -> bool {
        self.message.is_empty()
    }
}

impl From<io::Error> for Failure {
    /// An error in writing the output. A closed pipe (`carom simulate | head`) is no failure of ours.
    fn from(error: io::Error) -> Self {
        if error.kind() == io::ErrorKind::BrokenPipe {
            Self { message: String::new(), code: 0 }
        } else {
            Self::failed(format_args!("the output cannot be written: {error}"))
        }
    }
}
