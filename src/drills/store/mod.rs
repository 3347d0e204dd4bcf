//! Where practice is kept: one file a session and one file a position of the player's own, so that sessions of programs that
//! run at the same time are never in each other's way. Two programs may go on with one session, as with an exam that was left:
//! what one has noted meanwhile, the other does not write over. What cannot be read is named in a sentence and left as it is.

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
    marked::{self, MarkError},
};
use crate::storage::{self, Lock, Places, create_atomic, is_name, remove_abandoned_files, write_atomic};

/// What a session's file says that it is.
const SESSION: &str = "carom-session";

/// What the files are called after their names.
const EXTENSION: &str = "json";

/// What was found in a folder.
#[derive(Debug)]
pub struct Found<T> {
    /// What could be read, by name.
    pub items: Vec<T>,
    /// A sentence for every file that could not.
    pub notes: Vec<String>,
}

/// Sessions, positions and skill of a player, on the disk.
#[derive(Clone, Debug)]
pub struct Store {
    sessions: PathBuf,
    positions: PathBuf,
    player: PathBuf,
}

impl Store {
    /// The store in these places. Nothing is made before something is saved.
    pub fn new(places: &Places) -> Self {
        let Places { sessions, positions, player, .. } = places.clone();
        Self { sessions, positions, player }
    }

    /// All sessions, the oldest first.
    pub fn sessions(&self) -> Found<Session> {
        let mut found = read_all(&self.sessions, read_session);
        found.items.sort_by(|x, y| (x.started, &x.id).cmp(&(y.started, &y.id)));
        found
    }

    /// The session of this name, if there is one.
    ///
    /// # Errors
    /// Where its file cannot be read.
    pub fn session(&self, id: &str) -> Result<Option<Session>, StoreError> {
        let path = file(&self.sessions, id)?;
        if path.exists() { read_session(&path).map(Some) } else { Ok(None) }
    }

    /// Writes a session's file, or replaces one that has no other attempts than those that were known `before`, and still has the
    /// first `safe` of them, which are known to have been written. When this returns, the session is safe on the disk.
    ///
    /// # Errors
    /// [`StoreError::Changed`] where another program has noted something in it or taken it back; where writing fails, or a file
    /// of this name holds something else or is of a newer version. The file is then what it was.
    pub fn save(&self, session: &Session, before: &[Attempt], safe: usize) -> Result<(), StoreError> {
        self.save_locked(&self.lock()?, session, before, safe)
    }

    /// The same for who has the lock already.
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
            let kept: Kept = read_marked(&path)?;
            is_called(&path, &kept.id)?;
            // It may have fewer than `before`: what the disk has refused is only known here.
            if kept.attempts.len() < safe || !Attempt::is_prefix(&kept.attempts, before) {
                return Err(StoreError::Changed(Box::new(read_session(&path)?)));
            }
        }
        let written = self.write(lock, session);
        if is_new {
            self.remove_leavings();
        }
        written
    }

    /// Removes what programs have left behind that were killed while they wrote a session.
    fn remove_leavings(&self) {
        // Somebody else's leavings are no reason to fail.
        let _ = remove_abandoned_files(&self.sessions);
    }

    /// Writes a session's file, whatever attempts are in it.
    fn write(&self, _lock: &Lock, session: &Session) -> Result<(), StoreError> {
        let path = file(&self.sessions, &session.id)?;
        let bytes = marked::write(SESSION, session).map_err(|error| StoreError::unwritten(&path, error.into()))?;
        let written = if path.exists() { write_atomic(&path, &bytes) } else { create_atomic(&path, &bytes) };
        written.map_err(|error| StoreError::unwritten(&path, error))
    }

    /// The right to write sessions, which one program has at a time; waits for it.
    ///
    /// # Errors
    /// Where another keeps it for long, or whatever the file system reports.
    pub fn lock(&self) -> Result<Lock, StoreError> {
        Lock::wait(&self.sessions).map_err(|error| StoreError::unwritten(&self.sessions, error))
    }

    /// The player's own positions, by name.
    pub fn positions(&self) -> Found<Exercise> {
        let mut found = read_all(&self.positions, read_position);
        found.items.sort_by(|x, y| x.name.cmp(&y.name));
        found
    }

    /// The bundled exercises and the player's own, and a sentence for each of these that cannot be used.
    pub fn library(&self) -> (Library, Vec<String>) {
        let own = self.positions();
        let (library, refused) = Library::with_own(own.items);
        let refused = refused.into_iter().map(|error| format!("{}: {error}", self.positions.display()));
        (library, own.notes.into_iter().chain(refused).collect())
    }

    /// Keeps a position of the player's own, over another of its name only if `replaces` says so. Its category becomes
    /// [`Category::Own`].
    ///
    /// # Errors
    /// Where it cannot be played, its name is taken, or the file cannot be written; what was kept is then what it was.
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
            io::ErrorKind::AlreadyExists => StoreError::Taken(position.name.clone()),
            _ => StoreError::unwritten(&path, error),
        })
    }

    /// Removes a position of the player's own; what was practised on it stays in the sessions.
    ///
    /// # Errors
    /// Where there is none of this name, a newer program wrote it, or its file cannot be removed.
    pub fn remove_position(&self, name: &str) -> Result<(), StoreError> {
        let path = file(&self.positions, name)?;
        // What a newer program wrote is not ours to remove.
        let read = read_position(&path);
        if let Err(StoreError::Library { error: LibraryFileError::Mark(MarkError::Version(_)), .. }) = read {
            return read.map(drop);
        }
        fs::remove_file(&path).map_err(|error| match error.kind() {
            io::ErrorKind::NotFound => StoreError::Unknown(name.to_owned()),
            _ => StoreError::file(&path, error),
        })
    }
}

/// The text of a position's file: a library of one.
fn position_text(position: &Exercise) -> Result<String, serde_json::Error> {
    LibraryFile::new(vec![Exercise { category: Category::Own, ..position.clone() }]).to_text()
}

/// The file called `name`.
fn file(folder: &Path, name: &str) -> Result<PathBuf, StoreError> {
    if is_name(name) {
        Ok(folder.join(format!("{name}.{EXTENSION}")))
    } else {
        Err(ExerciseError::Name(name.to_owned()).into())
    }
}

/// The part of a session's file that tells whose it is, and what is noted there.
#[derive(Deserialize)]
struct Kept {
    id: String,
    attempts: Vec<Attempt>,
}

fn read_marked<T: DeserializeOwned>(path: &Path) -> Result<T, StoreError> {
    let text = storage::read(path, storage::PRACTICE).map_err(|error| StoreError::file(path, error))?;
    marked::read(SESSION, &text).map_err(|error| StoreError::Mark { path: path.into(), error })
}

fn read_session(path: &Path) -> Result<Session, StoreError> {
    let session: Session = read_marked(path)?;
    is_called(path, &session.id)?;
    validate(&session)?;
    Ok(session)
}

fn validate(session: &Session) -> Result<(), StoreError> {
    session.validate().map_err(|error| StoreError::Session { session: session.id.clone(), error })
}

fn read_position(path: &Path) -> Result<Exercise, StoreError> {
    let text = storage::read_text(path, storage::PRACTICE).map_err(|error| StoreError::file(path, error))?;
    let library = LibraryFile::parse(&text).map_err(|error| StoreError::Library { path: path.into(), error })?;
    let [exercise] = <[Exercise; 1]>::try_from(library.exercises)
        .map_err(|found| StoreError::Many { path: path.into(), found: found.len() })?;
    is_called(path, &exercise.name)?;
    exercise.validate().map_err(|error| StoreError::Impossible { path: path.into(), error })?;
    // The player's own, whatever somebody wrote into the file.
    Ok(Exercise { category: Category::Own, ..exercise })
}

/// Names are unique because those of files are: a copy under another name is none.
fn is_called(path: &Path, name: &str) -> Result<(), StoreError> {
    if path.file_stem().is_some_and(|stem| stem == name) {
        Ok(())
    } else {
        Err(StoreError::Copy { path: path.into(), name: name.to_owned() })
    }
}

/// Reads every file in a folder; one that is not there is empty.
fn read_all<T>(folder: &Path, read: impl Fn(&Path) -> Result<T, StoreError>) -> Found<T> {
    let mut found = Found { items: Vec::new(), notes: Vec::new() };
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
        // Those that are being written have another extension.
        if path.extension().is_none_or(|extension| extension != EXTENSION) {
            continue;
        }
        match read(&path) {
            Ok(item) => found.items.push(item),
            // Removed since the folder was read.
            Err(StoreError::File { reason, .. }) if reason.kind() == io::ErrorKind::NotFound => {}
            Err(error) => found.notes.push(format!("{error}; it is left as it is")),
        }
    }
    found.notes.sort();
    found
}
