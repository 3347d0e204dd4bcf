//! Stores the practice data: one file per session and one per own position, so that programs that run at the same time
//! do not interfere with each other's sessions. Two programs may continue the same session, such as an unfinished exam;
//! neither overwrites what the other has recorded meanwhile. Files that cannot be read are reported and left unchanged.

mod error;
mod player;
#[cfg(test)]
mod tests;
mod transfer;

use std::{
    fs, io,
    path::{Path, PathBuf},
};

use serde::{Deserialize, de::DeserializeOwned};

pub use self::{
    error::StoreError,
    player::OwnSkill,
    transfer::{Imported, Practice},
};
use super::{
    Attempt, Category, Exercise, ExerciseError, Library, LibraryFile, LibraryFileError, Session,
    header::{self, HeaderError},
};
use crate::storage::{self, DataPaths, Lock, create_atomic, is_name, remove_abandoned_files, write_atomic};

/// The format's name in session files.
const SESSION: &str = "carom-session";

/// File name extension.
const EXTENSION: &str = "json";

/// The content of a folder.
#[derive(Debug)]
pub struct FolderContents<T> {
    /// The readable items, by name.
    pub items: Vec<T>,
    /// A sentence for every file that cannot be read.
    pub notes: Vec<String>,
}

/// A player's sessions, positions and skill on disk.
#[derive(Clone, Debug)]
pub struct Store {
    sessions: PathBuf,
    positions: PathBuf,
    player: PathBuf,
}

impl Store {
    /// Creates a store for these places. Folders and files are created when something is first saved.
    pub fn new(places: &DataPaths) -> Self {
        let DataPaths { sessions, positions, player, .. } = places.clone();
        Self { sessions, positions, player }
    }

    /// Reads all sessions, the oldest first.
    pub fn sessions(&self) -> FolderContents<Session> {
        let mut found = read_all(&self.sessions, read_session);
        found.items.sort_by(|x, y| (x.started, &x.id).cmp(&(y.started, &y.id)));
        found
    }

    /// Reads the session with this identifier, if there is one.
    ///
    /// # Errors
    /// Fails if its file cannot be read.
    pub fn session(&self, id: &str) -> Result<Option<Session>, StoreError> {
        let path = file(&self.sessions, id)?;
        if path.exists() { read_session(&path).map(Some) } else { Ok(None) }
    }

    /// Writes a session's file. An existing file is replaced only if its attempts are a prefix of those known `before`,
    /// and include the first `safe` ones, which are known to have been written. When this returns, the session is safe
    /// on disk.
    ///
    /// # Errors
    /// [`StoreError::Changed`] if another program has added or removed attempts. Also fails if writing fails, or if a
    /// file of this name has other content or a newer version. The file is then unchanged.
    pub fn save(&self, session: &Session, before: &[Attempt], safe: usize) -> Result<(), StoreError> {
        self.save_locked(&self.lock()?, session, before, safe)
    }

    /// Like [`save`](Self::save), for a caller that already has the lock.
    ///
    /// # Errors
    /// As [`Store::save`].
    pub fn save_locked(
        &self,
        lock: &Lock,
        session: &Session,
        before: &[Attempt],
        safe: usize,
    ) -> Result<(), StoreError> {
        let path = file(&self.sessions, &session.id)?;
        let is_new = !path.exists();
        if !is_new {
            let stored: StoredSession = read_with_header(&path)?;
            check_name(&path, &stored.id)?;
            // The file may have fewer attempts than `before`, because attempts that could not be written exist only here.
            if stored.attempts.len() < safe || !Attempt::is_prefix(&stored.attempts, before) {
                return Err(StoreError::Changed(Box::new(read_session(&path)?)));
            }
        }
        let written = self.write(lock, session);
        if is_new {
            self.remove_abandoned();
        }
        written
    }

    /// Removes the temporary files of programs that were killed while writing a session.
    fn remove_abandoned(&self) {
        // Failing to remove them does not matter.
        let _ = remove_abandoned_files(&self.sessions);
    }

    /// Writes a session's file, whatever attempts are in the existing one.
    fn write(&self, _lock: &Lock, session: &Session) -> Result<(), StoreError> {
        let path = file(&self.sessions, &session.id)?;
        let bytes = header::write(SESSION, session).map_err(|error| StoreError::unwritten(&path, error.into()))?;
        let written = if path.exists() { write_atomic(&path, &bytes) } else { create_atomic(&path, &bytes) };
        written.map_err(|error| StoreError::unwritten(&path, error))
    }

    /// Waits for the exclusive lock for writing sessions.
    ///
    /// # Errors
    /// Fails if another program holds it for too long, or on a file system error.
    pub fn lock(&self) -> Result<Lock, StoreError> {
        Lock::acquire(&self.sessions).map_err(|error| StoreError::unwritten(&self.sessions, error))
    }

    /// Reads the player's own positions, by name.
    pub fn positions(&self) -> FolderContents<Exercise> {
        let mut found = read_all(&self.positions, read_position);
        found.items.sort_by(|x, y| x.name.cmp(&y.name));
        found
    }

    /// Returns the library of bundled exercises and own positions, and a sentence for each position that cannot be used.
    pub fn library(&self) -> (Library, Vec<String>) {
        let own = self.positions();
        let (library, refused) = Library::with_own(own.items);
        let refused = refused.into_iter().map(|error| format!("{}: {error}", self.positions.display()));
        (library, own.notes.into_iter().chain(refused).collect())
    }

    /// Saves an own position, replacing one of the same name only if `replaces` is set. Its category becomes
    /// [`Category::Own`].
    ///
    /// # Errors
    /// Fails if the position cannot be played, its name is taken, or the file cannot be written. An existing file is then unchanged.
    pub fn save_position(&self, position: &Exercise, replaces: bool) -> Result<(), StoreError> {
        position.validate()?;
        if Library::bundled().get(&position.name).is_ok() {
            return Err(StoreError::Bundled(position.name.clone()));
        }
        let path = file(&self.positions, &position.name)?;
        let text = position_text(position).map_err(|error| StoreError::unwritten(&path, error.into()))?;
        let written = if replaces && path.exists() {
            read_position(&path)?;
            write_atomic(&path, text.as_bytes())
        } else {
            create_atomic(&path, text.as_bytes())
        };
        written.map_err(|error| match error.kind() {
            io::ErrorKind::AlreadyExists => StoreError::NameTaken(position.name.clone()),
            _ => StoreError::unwritten(&path, error),
        })
    }

    /// Removes an own position; practice on it remains in the sessions.
    ///
    /// # Errors
    /// Fails if there is none of this name, a newer program wrote it, or its file cannot be removed.
    pub fn remove_position(&self, name: &str) -> Result<(), StoreError> {
        let path = file(&self.positions, name)?;
        // Files of newer versions are never removed.
        let read = read_position(&path);
        if let Err(StoreError::Library { error: LibraryFileError::Header(HeaderError::Version(_)), .. }) = read {
            return read.map(drop);
        }
        fs::remove_file(&path).map_err(|error| match error.kind() {
            io::ErrorKind::NotFound => StoreError::Unknown(name.to_owned()),
            _ => StoreError::file(&path, error),
        })
    }
}

/// Returns the text of a position's file: a library with one exercise.
fn position_text(position: &Exercise) -> Result<String, serde_json::Error> {
    LibraryFile::new(vec![Exercise { category: Category::Own, ..position.clone() }]).to_text()
}

/// Returns the path of the file for `name`.
fn file(folder: &Path, name: &str) -> Result<PathBuf, StoreError> {
    if is_name(name) {
        Ok(folder.join(format!("{name}.{EXTENSION}")))
    } else {
        Err(ExerciseError::Name(name.to_owned()).into())
    }
}

/// The part of a session's file that is needed to detect changes by other programs.
#[derive(Deserialize)]
struct StoredSession {
    id: String,
    attempts: Vec<Attempt>,
}

fn read_with_header<T: DeserializeOwned>(path: &Path) -> Result<T, StoreError> {
    let text = storage::read(path, storage::MAX_PRACTICE_FILE).map_err(|error| StoreError::file(path, error))?;
    header::read(SESSION, &text).map_err(|error| StoreError::Header { path: path.into(), error })
}

fn read_session(path: &Path) -> Result<Session, StoreError> {
    let session: Session = read_with_header(path)?;
    check_name(path, &session.id)?;
    validate(&session)?;
    Ok(session)
}

fn validate(session: &Session) -> Result<(), StoreError> {
    session.validate().map_err(|error| StoreError::Session { session: session.id.clone(), error })
}

fn read_position(path: &Path) -> Result<Exercise, StoreError> {
    let text = storage::read_text(path, storage::MAX_PRACTICE_FILE).map_err(|error| StoreError::file(path, error))?;
    let library = LibraryFile::parse(&text).map_err(|error| StoreError::Library { path: path.into(), error })?;
    let [exercise] = <[Exercise; 1]>::try_from(library.exercises)
        .map_err(|found| StoreError::Many { path: path.into(), found: found.len() })?;
    check_name(path, &exercise.name)?;
    exercise.validate().map_err(|error| StoreError::Impossible { path: path.into(), error })?;
    // The category in the file is ignored.
    Ok(Exercise { category: Category::Own, ..exercise })
}

/// Checks that the file has the name of its content. Names are unique because file names are, so a copy under another
/// name is rejected.
fn check_name(path: &Path, name: &str) -> Result<(), StoreError> {
    if path.file_stem().is_some_and(|stem| stem == name) {
        Ok(())
    } else {
        Err(StoreError::Copy { path: path.into(), name: name.to_owned() })
    }
}

/// Reads every file in a folder; a missing folder counts as empty.
fn read_all<T>(folder: &Path, read: impl Fn(&Path) -> Result<T, StoreError>) -> FolderContents<T> {
    let mut found = FolderContents { items: Vec::new(), notes: Vec::new() };
    let entries = match fs::read_dir(folder) {
        Ok(entries) => entries,
        Err(error) => {
            if error.kind() != io::ErrorKind::NotFound {
                found.notes.push(StoreError::file(folder, error).to_string());
            }
            return found;
        }
    };
    for entry in entries {
        let path = match entry {
            Ok(entry) => entry.path(),
            Err(error) => {
                found.notes.push(StoreError::file(folder, error).to_string());
                continue;
            }
        };
        // Files that are being written have another extension.
        if path.extension().is_none_or(|extension| extension != EXTENSION) {
            continue;
        }
        match read(&path) {
            Ok(item) => found.items.push(item),
            // The file was removed after the folder was listed.
            Err(StoreError::File { reason, .. }) if reason.kind() == io::ErrorKind::NotFound => {}
            Err(error) => found.notes.push(format!("{error}; it is left as it is")),
        }
    }
    found.notes.sort();
    found
}
