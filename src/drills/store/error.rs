//! Errors of the practice store.

use std::{
    io,
    path::{Path, PathBuf},
};

use super::super::{CodeError, ExerciseError, LibraryFileError, Session, SessionError, header::HeaderError};

/// Why something cannot be saved or read. The files on disk are unchanged.
#[derive(Debug, thiserror::Error)]
pub enum StoreError {
    /// A file system error.
    #[error("{}: {reason}", path.display())]
    File {
        /// The file or folder.
        path: PathBuf,
        /// The system's error.
        reason: io::Error,
    },
    /// The file cannot be written.
    #[error("{} cannot be written: {reason}", path.display())]
    Unwritten {
        /// The file or folder.
        path: PathBuf,
        /// The system's error.
        reason: io::Error,
    },
    /// The file has an unknown format or version, or is damaged.
    #[error("{}: {error}", path.display())]
    Header {
        /// The file.
        path: PathBuf,
        /// The cause.
        error: HeaderError,
    },
    /// The file is not a readable file of exercises.
    #[error("{}: {error}", path.display())]
    Library {
        /// The file.
        path: PathBuf,
        /// The cause.
        error: LibraryFileError,
    },
    /// A position's file contains no exercise, or several.
    #[error("{}: it contains {found} exercises; a position's file has one, carom drill import accepts more", path.display())]
    Many {
        /// The file.
        path: PathBuf,
        /// Number of exercises in it.
        found: usize,
    },
    /// The exercise in the file cannot be played.
    #[error("{}: {error}", path.display())]
    Impossible {
        /// The file.
        path: PathBuf,
        /// The cause.
        error: ExerciseError,
    },
    /// The file's name differs from the name in it.
    #[error("{}: it contains \"{name}\"; rename the file or remove it", path.display())]
    Copy {
        /// The file.
        path: PathBuf,
        /// The name in the file.
        name: String,
    },
    /// A session with invalid content.
    #[error("the session \"{session}\": {error}")]
    Session {
        /// The session.
        session: String,
        /// The cause.
        error: SessionError,
    },
    /// Another program has added or removed attempts in this session. Contains the session as it is stored now.
    #[error("another program has changed the session \"{}\" meanwhile; your changes were not written", .0.id)]
    Changed(Box<Session>),
    /// A session has different new attempts here and in an imported file.
    #[error("the session \"{0}\" was continued both here and in the file; the one here is kept")]
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
    /// A position has this name.
    #[error("there is a position \"{0}\" already; give this one another name, or have it replaced")]
    NameTaken(String),
    /// No position has this name.
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
