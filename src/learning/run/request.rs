//! Requests to a running training, as a word in a file in its folder: every user with write access may control the run from any terminal.

use std::{fs, io, path::Path};

use crate::{
    printing::OneLine,
    storage::{self, write_atomic_unsynced},
};

/// File name of a request.
pub const FILE: &str = "request";

/// File name while the request is read; by its form [`crate::storage`] recognises a leftover of a killed process.
const RECEIVED_FILE: &str = ".carom-request.partial";

/// Largest number of characters of an unknown request in the error message.
const MAX_SHOWN: usize = 30;

/// A request to a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Request {
    /// Save and wait.
    Pause,
    /// Resume after a pause.
    Resume,
    /// Save, evaluate and end.
    Stop,
    /// End and delete the run; an evaluation in progress is completed first.
    Abandon,
}

impl Request {
    const ALL: [Self; 4] = [Self::Pause, Self::Resume, Self::Stop, Self::Abandon];

    const fn word(self) -> &'static str {
        match self {
            Self::Pause => "pause",
            Self::Resume => "go on",
            Self::Stop => "stop",
            Self::Abandon => "abandon",
        }
    }

    /// Sends the request to the run in `folder`. It replaces an earlier request that was not read yet.
    ///
    /// # Errors
    /// The errors of the file system.
    pub fn send(self, folder: &Path) -> io::Result<()> {
        write_atomic_unsynced(&folder.join(FILE), self.word().as_bytes())
    }

    /// Reads and removes the request to the run in `folder`; `None` if there is none. The error for an unknown request is a sentence that
    /// names it and the accepted ones.
    pub(super) fn receive(folder: &Path) -> Option<Result<Self, String>> {
        // An empty file is not a request yet: its writer has opened it and will write later.
        if fs::metadata(folder.join(FILE)).ok()?.len() == 0 {
            return None;
        }
        // Moved away before it is read, because another request may arrive meanwhile.
        let taken = folder.join(RECEIVED_FILE);
        fs::rename(folder.join(FILE), &taken).ok()?;
        let word = storage::read_text(&taken, storage::MAX_SMALL_FILE).unwrap_or_default();
        let _ = fs::remove_file(taken);
        let word = word.trim();
        Some(Self::ALL.into_iter().find(|request| request.word() == word).ok_or_else(|| {
            let begin: String = word.chars().take(MAX_SHOWN).collect();
            let dots = if begin.len() < word.len() { "..." } else { "" };
            let accepted = Self::ALL.map(|request| format!("\"{}\"", request.word())).join(", ");
            format!("the request \"{}{dots}\" is not understood; accepted are {accepted}", OneLine(begin))
        }))
    }

    /// Removes the request, if there is one, because it was meant for a process that has ended.
    pub(super) fn clear(folder: &Path) {
        // Errors are ignored: a request that stays is carried out again, which changes nothing.
        let _ = fs::remove_file(folder.join(FILE));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unknown_requests_are_reported_once() {
        let folder = tempfile::tempdir().unwrap();
        assert_eq!(Request::receive(folder.path()), None);
        Request::Resume.send(folder.path()).unwrap();
        assert_eq!(Request::receive(folder.path()), Some(Ok(Request::Resume)));
        // A shell with a slow command opens the file before it writes.
        let mut slow = fs::File::create(folder.path().join(FILE)).unwrap();
        assert_eq!(Request::receive(folder.path()), None);
        io::Write::write_all(&mut slow, b"stop\n").unwrap();
        assert_eq!(Request::receive(folder.path()), Some(Ok(Request::Stop)));
        fs::write(folder.path().join(FILE), "puase\u{1b}\n").unwrap();
        let message = Request::receive(folder.path()).unwrap().unwrap_err();
        let accepted = "accepted are \"pause\", \"go on\", \"stop\", \"abandon\"";
        assert_eq!(message, format!("the request \"puase\\u{{1b}}\" is not understood; {accepted}"));
        assert_eq!(Request::receive(folder.path()), None, "it is reported once");
        fs::write(folder.path().join(FILE), "x".repeat(1000)).unwrap();
        assert!(Request::receive(folder.path()).unwrap().unwrap_err().len() < 150);
    }
}
