//! The file of the player's entries: every change is written to the disk before the program uses it.

use std::{
    io,
    path::{Path, PathBuf},
};

use super::entries::{Entries, Entry};
use crate::storage::{self, Lock, resolve_symlinks, write_atomic};

/// A change of the entries.
#[derive(Clone, Debug, PartialEq)]
pub enum Edit {
    /// Appends a stroke.
    Add(Entry),
    /// Inserts a stroke at an index, from 0 on.
    Insert(usize, Entry),
    /// Removes the stroke at an index.
    Remove(usize, Entry),
    /// Replaces the first stroke, at an index, by the second.
    Replace(usize, Entry, Entry),
    /// Replaces all entries. The old ones are kept in a backup file, next to earlier backups.
    ReplaceAll(Entries),
}

/// Entries cannot be read or saved.
#[derive(Debug, thiserror::Error)]
pub enum EntriesFileError {
    /// The file cannot be read.
    #[error("{0} cannot be read: {1}")]
    Unreadable(PathBuf, io::Error),
    /// The file does not contain entries.
    #[error("{0}: {1}")]
    Invalid(PathBuf, String),
    /// The file cannot be written.
    #[error("{0} cannot be written, so this change is not saved: {1}")]
    Unwritable(PathBuf, io::Error),
    /// The stroke to change no longer exists.
    #[error("the file {0} was changed by another program, and the stroke no longer exists")]
    StrokeMissing(PathBuf),
}

/// Reads the entries of a file.
///
/// # Errors
/// Fails if the file cannot be read or does not contain entries.
pub fn load_entries(path: &Path) -> Result<Entries, EntriesFileError> {
    let text = storage::read_text(path, storage::MAX_SMALL_FILE)
        .map_err(|error| EntriesFileError::Unreadable(path.to_owned(), error))?;
    Entries::parse(&text).map_err(|error| EntriesFileError::Invalid(path.to_owned(), error))
}

/// Reads the entries of a file; no entries if the file does not exist yet.
///
/// # Errors
/// The same as [`load_entries`].
pub fn load_entries_or_empty(path: &Path) -> Result<Entries, EntriesFileError> {
    match load_entries(path) {
        Err(EntriesFileError::Unreadable(_, error)) if error.kind() == io::ErrorKind::NotFound => {
            Ok(Entries::default())
        }
        found => found,
    }
}

/// Applies a change to the current content of the file, including changes by other programs. Returns all entries, and the change that
/// reverts this one.
///
/// # Errors
/// Fails if the file cannot be read or written, or does not contain the stroke to change. The file is then unchanged.
pub fn edit_entries(path: &Path, edit: &Edit) -> Result<(Entries, Edit), EntriesFileError> {
    let _lock = lock(path)?;
    let mut entries = load_entries_or_empty(path)?;
    let index_of = |trials: &[Entry], index: usize, entry: &Entry| {
        let is_there = trials.get(index) == Some(entry);
        let found = if is_there { Some(index) } else { trials.iter().rposition(|one| one == entry) };
        found.ok_or_else(|| EntriesFileError::StrokeMissing(path.to_owned()))
    };
    let trials = &mut entries.trials;
    let undo = match edit {
        Edit::Add(entry) => {
            trials.push(entry.clone());
            Edit::Remove(trials.len() - 1, entry.clone())
        }
        Edit::Insert(at, entry) => {
            let at = trials.len().min(*at);
            trials.insert(at, entry.clone());
            Edit::Remove(at, entry.clone())
        }
        Edit::Remove(at, entry) => {
            let at = index_of(trials, *at, entry)?;
            Edit::Insert(at, trials.remove(at))
        }
        Edit::Replace(at, before, after) => {
            let at = index_of(trials, *at, before)?;
            trials[at] = after.clone();
            Edit::Replace(at, after.clone(), before.clone())
        }
        Edit::ReplaceAll(all) => {
            if !trials.is_empty() {
                rotate_backups(path)?;
                write(&latest_backup_path(path), &entries)?;
            }
            Edit::ReplaceAll(std::mem::replace(&mut entries, all.clone()))
        }
    };
    write(path, &entries)?;
    Ok((entries, undo))
}

/// Returns the path of the latest backup of the entries.
pub fn latest_backup_path(path: &Path) -> PathBuf {
    path.with_extension("before.toml")
}

/// Returns the path of a backup; `age` 1 is the latest.
fn backup_path(path: &Path, age: usize) -> PathBuf {
    if age == 1 { latest_backup_path(path) } else { path.with_extension(format!("before-{age}.toml")) }
}

/// Number of backups that are kept.
const MAX_BACKUPS: usize = 9;

/// Moves an unreadable file to the backups, so that new entries can be saved under its name.
///
/// # Errors
/// Fails if the file cannot be moved; it then stays.
pub fn back_up_unreadable(path: &Path) -> Result<(), EntriesFileError> {
    let _lock = lock(path)?;
    // Another program may have repaired or moved it.
    if load_entries_or_empty(path).is_ok() {
        return Ok(());
    }
    rotate_backups(path)?;
    std::fs::rename(path, latest_backup_path(path))
        .map_err(|error| EntriesFileError::Unwritable(latest_backup_path(path), error))
}

/// Waits for the exclusive right to change the file.
fn lock(path: &Path) -> Result<Lock, EntriesFileError> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    Lock::acquire(folder).map_err(|error| EntriesFileError::Unwritable(path.to_owned(), error))
}

/// Renames each backup to the next age, and drops the oldest.
fn rotate_backups(path: &Path) -> Result<(), EntriesFileError> {
    for age in (1..MAX_BACKUPS).rev() {
        let (from, to) = (backup_path(path, age), backup_path(path, age + 1));
        match std::fs::rename(&from, &to) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => {
                return Err(EntriesFileError::Unwritable(to, error));
            }
            _ => {}
        }
    }
    Ok(())
}

/// Writes the entries atomically.
fn write(path: &Path, entries: &Entries) -> Result<(), EntriesFileError> {
    let unwritten = |error| EntriesFileError::Unwritable(path.to_owned(), error);
    let text = toml::to_string(entries).map_err(|error| unwritten(io::Error::other(error)))?;
    write_atomic(&resolve_symlinks(path), text.as_bytes()).map_err(unwritten)
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    fn entry(time: &str) -> Entry {
        let mut entry = Entry { test: "slow-roll".into(), ..Entry::default() };
        entry.set_field("time", time).unwrap();
        entry
    }

    #[test]
    fn every_change_is_saved_and_can_be_undone() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("deep/calibration.toml");
        let made = [
            Edit::Add(entry("9")),
            Edit::Add(entry("8")),
            Edit::Replace(0, entry("9"), entry("9.5 ± 0.3")),
            Edit::Insert(1, entry("7")),
            Edit::Remove(2, entry("8")),
            Edit::ReplaceAll(Entries::default()),
        ];
        let (mut states, mut backs) = (vec![Entries::default()], Vec::new());
        for edit in &made {
            let (entries, back) = edit_entries(&path, edit).unwrap();
            assert_eq!(load_entries_or_empty(&path).unwrap(), entries, "{edit:?}");
            states.push(entries);
            backs.push(back);
        }
        assert_eq!(load_entries_or_empty(&latest_backup_path(&path)).unwrap(), states[5], "the backup");
        // A later backup does not replace it.
        edit_entries(&path, &Edit::Add(entry("6"))).unwrap();
        let (_, back) = edit_entries(&path, &Edit::ReplaceAll(Entries::default())).unwrap();
        assert_eq!(load_entries_or_empty(&latest_backup_path(&path)).unwrap().trials, [entry("6")]);
        assert_eq!(load_entries_or_empty(&backup_path(&path, 2)).unwrap(), states[5]);
        edit_entries(&path, &back).unwrap();
        edit_entries(&path, &Edit::Remove(0, entry("6"))).unwrap();
        for (before, back) in states.iter().zip(&backs).rev() {
            assert_eq!(edit_entries(&path, back).unwrap().0, *before);
        }
    }

    #[test]
    fn changes_by_other_programs_are_kept() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("calibration.toml");
        let (_, back) = edit_entries(&path, &Edit::Add(entry("9"))).unwrap();
        edit_entries(&path, &Edit::Insert(0, entry("8"))).unwrap();
        let (entries, _) = edit_entries(&path, &back).unwrap();
        assert_eq!(entries.trials, [entry("8")]);
        let gone = edit_entries(&path, &back).unwrap_err();
        assert!(gone.to_string().contains("changed by another program"), "{gone}");
        fs::write(&path, "broken").unwrap();
        assert!(edit_entries(&path, &Edit::Add(entry("7"))).unwrap_err().to_string().contains("line 1"));
        assert_eq!(fs::read_to_string(&path).unwrap(), "broken");
        back_up_unreadable(&path).unwrap();
        assert_eq!(fs::read_to_string(latest_backup_path(&path)).unwrap(), "broken");
        edit_entries(&path, &Edit::Add(entry("7"))).unwrap();
        back_up_unreadable(&path).unwrap();
        assert_eq!(load_entries_or_empty(&path).unwrap().trials, [entry("7")], "it can be read");
    }
}
