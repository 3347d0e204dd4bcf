//! Requests to a running training, as a word in a file in its folder: every user with write access may control the run from any terminal.

use std::{fs, io, path::Path};

use crate::{
    printing::OneLine,
    storage::{self, replace},
};

/// File name of a request.
pub const FILE: &str = "request";

/// File name while the request is read; by its form [`crate::storage`] recognises a leftover of a killed process.
const TAKEN: &str = ".carom-request.partial";

/// Largest number of characters of an unknown request in the error message.
const LONGEST_SHOWN: usize = 30;

/// A request to a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Request {
    /// Save and wait.
    Pause,
    /// Resume after a pause.
    GoOn,
    /// Save, evaluate and end.
    Stop,
    /// End and delete the run; an evaluation in progress is completed first.
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

    /// Sends the request to the run in `folder`. It replaces an earlier request that was not read yet.
    ///
    /// # Errors
    /// The errors of the file system.
    pub fn send(self, folder: &Path) -> io::Result<()> {
        replace(&folder.join(FILE), self.word().as_bytes())
    }

    /// Reads and removes the request to the run in `folder`; `None` if there is none.
    ///
    /// # Errors
    /// For an unknown request, a sentence that names it and the accepted ones.
    pub fn take(folder: &Path) -> Option<Result<Self, String>> {
        // An empty file is not a request yet: its writer has opened it and will write later.
        if fs::metadata(folder.join(FILE)).ok()?.len() == 0 {
            return None;
        }
        // Moved away before it is read, because another request may arrive meanwhile.
        let taken = folder.join(TAKEN);
        fs::rename(folder.join(FILE), &taken).ok()?;
        let word = storage::read_text(&taken, storage::SMALL).unwrap_or_default();
        let _ = fs::remove_file(taken);
        let word = word.trim();
        Some(Self::ALL.into_iter().find(|request| request.word() == word).ok_or_else(|| {
            let begin: String = word.chars().take(LONGEST_SHOWN).collect();
            let dots = if begin.len() < word.len() { "..." } else { "" };
            let accepted = Self::ALL.map(|request| format!("\"{}\"", request.word())).join(", ");
            format!("the request \"{}{dots}\" is not understood; accepted are {accepted}", OneLine(begin))
        }))
    }

    /// Removes the request, if there is one, because it was meant for a process that has ended.
    pub fn clear(folder: &Path) {
        // Errors are ignored: a request that stays is carried out again, which changes nothing.
        let _ = fs::remove_file(folder.join(FILE));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_unknown_request_is_reported_once_with_the_accepted_ones() {
        let folder = tempfile::tempdir().unwrap();
        assert_eq!(Request::take(folder.path()), None);
        Request::GoOn.send(folder.path()).unwrap();
        assert_eq!(Request::take(folder.path()), Some(Ok(Request::GoOn)));
        // A shell with a slow command opens the file before it writes.
        let mut slow = fs::File::create(folder.path().join(FILE)).unwrap();
        assert_eq!(Request::take(folder.path()), None);
        io::Write::write_all(&mut slow, b"stop\n").unwrap();
        assert_eq!(Request::take(folder.path()), Some(Ok(Request::Stop)));
        fs::write(folder.path().join(FILE), "puase\u{1b}\n").unwrap();
        let message = Request::take(folder.path()).unwrap().unwrap_err();
        let accepted = "accepted are \"pause\", \"go on\", \"stop\", \"abandon\"";
        assert_eq!(message, format!("the request \"puase\\u{{1b}}\" is not understood; {accepted}"));
        assert_eq!(Request::take(folder.path()), None, "it is reported once");
        fs::write(folder.path().join(FILE), "x".repeat(1000)).unwrap();
        assert!(Request::take(folder.path()).unwrap().unwrap_err().len() < 150);
    }
}
