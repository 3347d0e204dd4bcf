//! The file in which entries are kept: each change is on the disk before anything else is done with it.

use std::{
    io,
    path::{Path, PathBuf},
};

use super::entries::{Entries, Entry};
use crate::storage::{self, Lock, target_of, write_atomic};

/// A change of the entries.
#[derive(Clone, Debug, PartialEq)]
pub enum Edit {
    /// A stroke was played.
    Add(Entry),
    /// This stroke is put at its place, from 0 on.
    Insert(usize, Entry),
    /// This stroke, which stands there, is taken out.
    TakeOut(usize, Entry),
    /// The first stroke, which stands there, becomes the second.
    Amend(usize, Entry, Entry),
    /// All of it becomes this; what there was is kept beside the file, with what was kept before.
    Anew(Entries),
}

/// Why entries are not read or kept.
#[derive(Debug, thiserror::Error)]
pub enum KeptError {
    /// The file cannot be read.
    #[error("{0} cannot be read: {1}")]
    Unread(PathBuf, io::Error),
    /// It holds no entries.
    #[error("{0}: {1}")]
    Wrong(PathBuf, String),
    /// It cannot be written.
    #[error("{0} cannot be written, so this change is not kept: {1}")]
    Unwritten(PathBuf, io::Error),
    /// What was to be changed is not there any more.
    #[error("the file {0} was changed by another program, and the stroke is not there any more")]
    Gone(PathBuf),
}

/// The entries of a file.
///
/// # Errors
/// Where it cannot be read, or holds something else.
pub fn entries_of(path: &Path) -> Result<Entries, KeptError> {
    let text = storage::read_text(path, storage::SMALL).map_err(|error| KeptError::Unread(path.to_owned(), error))?;
    Entries::parse(&text).map_err(|error| KeptError::Wrong(path.to_owned(), error))
}

/// The same; none where there is no file yet.
///
/// # Errors
/// As [`entries_of`].
pub fn kept_entries(path: &Path) -> Result<Entries, KeptError> {
    match entries_of(path) {
        Err(KeptError::Unread(_, error)) if error.kind() == io::ErrorKind::NotFound => Ok(Entries::default()),
        found => found,
    }
}

/// Makes a change of what the file holds now, whoever has written it; gives all entries, and the change back.
///
/// # Errors
/// Where the file cannot be read or written, or does not hold what was to be changed: then it stays as it is.
pub fn edit_entries(path: &Path, edit: &Edit) -> Result<(Entries, Edit), KeptError> {
    let _lock = lock(path)?;
    let mut entries = kept_entries(path)?;
    let place = |trials: &[Entry], place: usize, entry: &Entry| {
        let is_there = trials.get(place) == Some(entry);
        let found = if is_there { Some(place) } else { trials.iter().rposition(|one| one == entry) };
        found.ok_or_else(|| KeptError::Gone(path.to_owned()))
    };
    let trials = &mut entries.trials;
    let back = match edit {
        Edit::Add(entry) => {
            trials.push(entry.clone());
            Edit::TakeOut(trials.len() - 1, entry.clone())
        }
        Edit::Insert(at, entry) => {
            let at = trials.len().min(*at);
            trials.insert(at, entry.clone());
            Edit::TakeOut(at, entry.clone())
        }
        Edit::TakeOut(at, entry) => {
            let at = place(trials, *at, entry)?;
            Edit::Insert(at, trials.remove(at))
        }
        Edit::Amend(at, before, after) => {
            let at = place(trials, *at, before)?;
            trials[at] = after.clone();
            Edit::Amend(at, after.clone(), before.clone())
        }
        Edit::Anew(all) => {
            if !trials.is_empty() {
                put_aside(path, &entries)?;
            }
            Edit::Anew(std::mem::replace(&mut entries, all.clone()))
        }
    };
    write(path, &entries)?;
    Ok((entries, back))
}

/// Where entries are kept that were put aside last.
pub fn beside(path: &Path) -> PathBuf {
    path.with_extension("before.toml")
}

/// Where they are kept that were put aside so many times ago; 1 is the last time.
fn aged(path: &Path, age: usize) -> PathBuf {
    if age == 1 { beside(path) } else { path.with_extension(format!("before-{age}.toml")) }
}

/// How often entries that were put aside are kept.
const MOST_KEPT: usize = 9;

/// Keeps a file beside its place that holds no entries that can be read, so that others can be kept there.
///
/// # Errors
/// Where it cannot be moved: then it stays.
pub fn put_aside_unread(path: &Path) -> Result<(), KeptError> {
    let _lock = lock(path)?;
    // Another program may have mended it, or put it aside.
    if kept_entries(path).is_ok() {
        return Ok(());
    }
    make_room_beside(path)?;
    std::fs::rename(path, beside(path)).map_err(|error| KeptError::Unwritten(beside(path), error))
}

/// The right to change the file, which one program has at a time.
fn lock(path: &Path) -> Result<Lock, KeptError> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    Lock::wait(folder).map_err(|error| KeptError::Unwritten(path.to_owned(), error))
}

/// Keeps entries beside the file.
fn put_aside(path: &Path, entries: &Entries) -> Result<(), KeptError> {
    make_room_beside(path)?;
    write(&beside(path), entries)
}

/// What was kept beside the file before becomes one older.
fn make_room_beside(path: &Path) -> Result<(), KeptError> {
    for age in (1..MOST_KEPT).rev() {
        let (from, to) = (aged(path, age), aged(path, age + 1));
        match std::fs::rename(&from, &to) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(KeptError::Unwritten(to, error)),
            _ => {}
        }
    }
    Ok(())
}

/// Writes the entries, whole or not at all.
fn write(path: &Path, entries: &Entries) -> Result<(), KeptError> {
    let unwritten = |error| KeptError::Unwritten(path.to_owned(), error);
    let text = toml::to_string(entries).map_err(|error| unwritten(io::Error::other(error)))?;
    write_atomic(&target_of(path), text.as_bytes()).map_err(unwritten)
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    fn entry(time: &str) -> Entry {
        let mut entry = Entry { test: "slow-roll".into(), ..Entry::default() };
        entry.take("time", time).unwrap();
        entry
    }

    #[test]
    fn every_change_is_on_the_disk_and_can_be_taken_back() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("deep/calibration.toml");
        let made = [
            Edit::Add(entry("9")),
            Edit::Add(entry("8")),
            Edit::Amend(0, entry("9"), entry("9.5 ± 0.3")),
            Edit::Insert(1, entry("7")),
            Edit::TakeOut(2, entry("8")),
            Edit::Anew(Entries::default()),
        ];
        let (mut states, mut backs) = (vec![Entries::default()], Vec::new());
        for edit in &made {
            let (entries, back) = edit_entries(&path, edit).unwrap();
            assert_eq!(kept_entries(&path).unwrap(), entries, "{edit:?}");
            states.push(entries);
            backs.push(back);
        }
        assert_eq!(kept_entries(&beside(&path)).unwrap(), states[5], "what was put aside");
        // What is put aside later leaves it there.
        edit_entries(&path, &Edit::Add(entry("6"))).unwrap();
        let (_, back) = edit_entries(&path, &Edit::Anew(Entries::default())).unwrap();
        assert_eq!(kept_entries(&beside(&path)).unwrap().trials, [entry("6")]);
        assert_eq!(kept_entries(&aged(&path, 2)).unwrap(), states[5]);
        edit_entries(&path, &back).unwrap();
        edit_entries(&path, &Edit::TakeOut(0, entry("6"))).unwrap();
        for (before, back) in states.iter().zip(&backs).rev() {
            assert_eq!(edit_entries(&path, back).unwrap().0, *before);
        }
    }

    #[test]
    fn what_another_program_has_entered_meanwhile_stays() {
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
        put_aside_unread(&path).unwrap();
        assert_eq!(fs::read_to_string(beside(&path)).unwrap(), "broken");
        edit_entries(&path, &Edit::Add(entry("7"))).unwrap();
        put_aside_unread(&path).unwrap();
        assert_eq!(kept_entries(&path).unwrap().trials, [entry("7")], "it can be read");
    }
}
