//! Why something cannot be kept or read.

use std::{
    io,
    path::{Path, PathBuf},
};

use super::super::{CodeError, ExerciseError, LibraryFileError, Session, SessionError, marked::MarkError};

/// Why something cannot be kept or read. Whatever is on the disk is what it was.
#[derive(Debug, thiserror::Error)]
pub enum StoreError {
    /// The file system refuses.
    #[error("{}: {reason}", path.display())]
    File {
        /// The file or folder.
        path: PathBuf,
        /// What the system says.
        reason: io::Error,
    },
    /// It cannot be written.
    #[error("{} cannot be written: {reason}", path.display())]
    Unwritten {
        /// The file or folder.
        path: PathBuf,
        /// What the system says.
        reason: io::Error,
    },
    /// It is no file of ours that is understood.
    #[error("{}: {error}", path.display())]
    Mark {
        /// The file.
        path: PathBuf,
        /// Why.
        error: MarkError,
    },
    /// It is no file of exercises that is understood.
    #[error("{}: {error}", path.display())]
    Library {
        /// The file.
        path: PathBuf,
        /// Why.
        error: LibraryFileError,
    },
    /// A position's file has none or several.
    #[error("{}: there are {found} exercises in it; a position's file has one, carom drill import takes more", path.display())]
    Many {
        /// The file.
        path: PathBuf,
        /// Exercises in it.
        found: usize,
    },
    /// What it holds cannot be played.
    #[error("{}: {error}", path.display())]
    Impossible {
        /// The file.
        path: PathBuf,
        /// Why.
        error: ExerciseError,
    },
    /// It is called otherwise than what it holds.
    #[error("{}: it holds \"{name}\"; rename the file or remove it", path.display())]
    Copy {
        /// The file.
        path: PathBuf,
        /// What is in it.
        name: String,
    },
    /// A session that cannot have been played.
    #[error("the session \"{session}\": {error}")]
    Session {
        /// The session.
        session: String,
        /// Why.
        error: SessionError,
    },
    /// Another program has noted something in this session or taken it back; it is given as it stands now.
    #[error("another program has changed the session \"{}\" meanwhile; nothing of yours was written over it", .0.id)]
    Changed(Box<Session>),
    /// A session has gone on here and elsewhere.
    #[error("the session \"{0}\" has gone on both here and in the file, so it stays as it is here")]
    Diverged(String),
    /// An exercise cannot be played.
    #[error(transparent)]
    Exercise(#[from] ExerciseError),
    /// A share code cannot be read.
    #[error(transparent)]
    Code(#[from] CodeError),
    /// A bundled exercise has this name.
    #[error("there is a bundled exercise \"{0}\"; give this one another name")]
    Bundled(String),
    /// There is one of this name.
    #[error("there is a position \"{0}\" already; give this one another name, or have it replaced")]
    Taken(String),
    /// There is none.
    #[error("there is no position \"{0}\" of your own")]
    Unknown(String),
}

impl StoreError {
    pub(super) fn file(path: &Path, reason: io::Error) -> Self {
        Self::File { path: path.to_owned(), reason }
    }

    pub(super) fn unwritten(path: &Path, reason: io::Error) -> Self {
        Self::Unwritten { path: path.to_owned(), reason }
    }
}
