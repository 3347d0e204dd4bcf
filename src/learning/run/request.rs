//! Requests to a running training, a word in a file of its folder: anyone who may write there may steer it, from any
//! terminal.

use std::{fs, io, path::Path};

use crate::storage::{self, replace};

/// The file's name.
pub const FILE: &str = "request";

/// The file while it is read; its name shows what a killed process has left ([`crate::storage`]).
const TAKEN: &str = ".carom-request.partial";

/// A request to a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Request {
    /// Save and wait.
    Pause,
    /// Go on after a pause.
    GoOn,
    /// Measure, save and end.
    Stop,
    /// End at once and remove the run.
    Abandon,
}

impl Request {
    const ALL: [Self; 4] = [Self::Pause, Self::GoOn, Self::Stop, Self::Abandon];

    const fn word(self) -> &'static str {
        match self {
            Self::Pause => "pause",
            Self::GoOn => "go on",
            Self::Stop => "stop",
            Self::Abandon => "abandon",
        }
    }

    /// Asks the run in `folder`. The newest request replaces the one before.
    ///
    /// # Errors
    /// Whatever the file system reports.
    pub fn send(self, folder: &Path) -> io::Result<()> {
        replace(&folder.join(FILE), self.word().as_bytes())
    }

    /// Takes what the run in `folder` is asked to do; nothing where there is no request, or one that is not understood.
    pub fn take(folder: &Path) -> Option<Self> {
        // Away first: another request may come while this one is read.
        let taken = folder.join(TAKEN);
        fs::rename(folder.join(FILE), &taken).ok()?;
        let word = storage::read_text(&taken, storage::SMALL).unwrap_or_default();
        let _ = fs::remove_file(taken);
        Self::ALL.into_iter().find(|request| request.word() == word.trim())
    }

    /// Removes the request, if there is one: it was meant for a process that is gone.
    pub fn clear(folder: &Path) {
        // Where it stays it is done again, which changes nothing.
        let _ = fs::remove_file(folder.join(FILE));
    }
}
