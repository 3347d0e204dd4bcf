//! How a command ends when it cannot do what was asked: one sentence and an exit code.

use std::fmt::Display;

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

    /// The process' exit code.
    pub const fn code(&self) -> u8 {
        self.code
    }
}
