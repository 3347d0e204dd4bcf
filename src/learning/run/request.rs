//! Requests to a running training, a word in a file of its folder: anyone who may write there may steer it, from any
//! terminal.

use std::{fs, io, path::Path};

use crate::{
    printing::OneLine,
    storage::{self, replace},
};

/// The file's name.
pub const FILE: &str = "request";

/// The file while it is read; its name shows what a killed process has left ([`crate::storage`]).
const TAKEN: &str = ".carom-request.partial";

/// Characters that are shown of what is no request.
const LONGEST_SHOWN: usize = 30;

/// A request to a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Request {
    /// Save and wait.
    Pause,
    /// Go on after a pause.
    GoOn,
    /// Save, measure and end.
    Stop,
    /// End and remove the run, after a measurement that is under way.
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

    /// Takes what the run in `folder` is asked to do; nothing where there is no request.
    ///
    /// # Errors
    /// A sentence that names what is not understood, and what would be.
    pub fn take(folder: &Path) -> Option<Result<Self, String>> {
        // Who opens the file first and writes later has not asked yet.
        if fs::metadata(folder.join(FILE)).ok()?.len() == 0 {
            return None;
        }
        // Away first: another request may come while this one is read.
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

    /// Removes the request, if there is one: it was meant for a process that is gone.
    pub fn clear(folder: &Path) {
        // Where it stays it is done again, which changes nothing.
        let _ = fs::remove_file(folder.join(FILE));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_request_is_named_once_with_what_is_accepted() {
        let folder = tempfile::tempdir().unwrap();
        assert_eq!(Request::take(folder.path()), None);
        Request::GoOn.send(folder.path()).unwrap();
        assert_eq!(Request::take(folder.path()), Some(Ok(Request::GoOn)));
        // As a shell does whose command takes its time.
        let mut slow = fs::File::create(folder.path().join(FILE)).unwrap();
        assert_eq!(Request::take(folder.path()), None);
        io::Write::write_all(&mut slow, b"stop\n").unwrap();
        assert_eq!(Request::take(folder.path()), Some(Ok(Request::Stop)));
        fs::write(folder.path().join(FILE), "puase\u{1b}\n").unwrap();
        let said = Request::take(folder.path()).unwrap().unwrap_err();
        let accepted = "accepted are \"pause\", \"go on\", \"stop\", \"abandon\"";
        assert_eq!(said, format!("the request \"puase\\u{{1b}}\" is not understood; {accepted}"));
        assert_eq!(Request::take(folder.path()), None, "it is said once");
        fs::write(folder.path().join(FILE), "x".repeat(1000)).unwrap();
        assert!(Request::take(folder.path()).unwrap().unwrap_err().len() < 150);
    }
}
