//! Whole files or none: written beside the target, synced, then renamed over it.

use std::{
    io::{self, Write},
    path::{Path, PathBuf},
    time::{Duration, SystemTime},
};

use tempfile::NamedTempFile;

use super::{confinement::may_write, reading::regular};
use crate::platform;

/// Begin and end of the names of files that are being written: they show what a killed process has left.
const PARTIAL: [&str; 2] = [".carom-", ".partial"];

/// Age from which a file that is being written has lost its writer: a few kilobytes do not take an hour.
const ABANDONED: Duration = Duration::from_secs(3600);

/// Replaces the file at `path` by `bytes`. A reader sees the old content or the new one, never a part; missing folders
/// are made.
///
/// # Errors
/// Where something else than a regular file is there, or whatever the file system reports; as with [`Staged::publish`], what is there is
/// then untouched.
pub fn write_atomic(path: &Path, bytes: &[u8]) -> io::Result<()> {
    Staged::new(path, bytes)?.publish()
}

/// Like [`write_atomic`] for a name that nobody has yet: of several programs that create the same file at once, one does.
///
/// # Errors
/// [`io::ErrorKind::AlreadyExists`] where there is such a file, else whatever the file system reports, as with [`Staged::publish`];
/// what stands there is untouched.
pub fn create_atomic(path: &Path, bytes: &[u8]) -> io::Result<()> {
    Staged::new(path, bytes)?.publish_new()
}

/// Like [`write_atomic`] for what need not outlive a power cut: a reader sees the old content or the new one, and nobody
/// waits for the disk.
///
/// # Errors
/// Where something else than a regular file is there, there is no folder for it, or whatever the file system reports; the old file is
/// then untouched.
pub fn replace(path: &Path, bytes: &[u8]) -> io::Result<()> {
    replaceable(path)?;
    let mut file = readable_by_all(folder_of(path))?;
    file.as_file_mut().write_all(bytes)?;
    file.persist(path)?;
    Ok(())
}

/// A file that is safe on the disk, under another name for now. Dropped without being published it is removed.
#[derive(Debug)]
pub struct Staged {
    file: NamedTempFile,
    path: PathBuf,
}

impl Staged {
    /// Writes what shall stand at `path`; missing folders are made.
    ///
    /// # Errors
    /// Whatever the file system reports; nothing is then left.
    pub fn new(path: &Path, bytes: &[u8]) -> io::Result<Self> {
        replaceable(path)?;
        let folder = folder_of(path);
        may_write(folder)?;
        std::fs::create_dir_all(folder)?;
        let mut file = readable_by_all(folder)?;
        // Not through the temporary file, which would add its own name to what went wrong.
        file.as_file_mut().write_all(bytes)?;
        file.as_file().sync_all()?;
        Ok(Self { file, path: path.to_owned() })
    }

    /// Puts the file in its place, over what stands there.
    ///
    /// # Errors
    /// Whatever the file system reports; what stands there is then untouched, unless the disk failed at the very last: the file is in
    /// its place then, and may not outlive a power cut.
    pub fn publish(self) -> io::Result<()> {
        self.file.persist(&self.path)?;
        platform::sync_folder(folder_of(&self.path))
    }

    /// Puts the file in its place if nothing stands there.
    ///
    /// # Errors
    /// [`io::ErrorKind::AlreadyExists`], or as [`Staged::publish`].
    pub fn publish_new(self) -> io::Result<()> {
        self.file.persist_noclobber(&self.path)?;
        platform::sync_folder(folder_of(&self.path))
    }
}

/// Removes from `folder` what a process that was killed while writing has left there. Nobody may be writing into it.
///
/// # Errors
/// Whatever the file system reports.
pub fn remove_partial_files(folder: &Path) -> io::Result<()> {
    partial_files(folder)?.iter().try_for_each(std::fs::remove_file)
}

/// The same where others may be writing: what is less than an hour old stays.
///
/// # Errors
/// Whatever the file system reports.
pub fn remove_abandoned_files(folder: &Path) -> io::Result<()> {
    let is_old = |file: &PathBuf| {
        let changed = std::fs::metadata(file).and_then(|metadata| metadata.modified());
        // One that has vanished meanwhile was somebody's who has finished it.
        changed.is_ok_and(|changed| SystemTime::now().duration_since(changed).is_ok_and(|age| age > ABANDONED))
    };
    partial_files(folder)?.iter().filter(|file| is_old(file)).try_for_each(std::fs::remove_file)
}

/// The files in `folder` that are being written, or were when their writer was killed.
fn partial_files(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let [begin, end] = PARTIAL;
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder)? {
        let name = entry?.file_name();
        if name.to_str().is_some_and(|name| name.starts_with(begin) && name.ends_with(end)) {
            files.push(folder.join(name));
        }
    }
    Ok(files)
}

/// The file to replace where `path` is meant: what is linked from elsewhere stays linked.
pub fn target_of(path: &Path) -> PathBuf {
    std::fs::canonicalize(path).unwrap_or_else(|_| path.to_owned())
}

/// Refuses what is there and is no regular file: a pipe or a device would be one afterwards.
fn replaceable(path: &Path) -> io::Result<()> {
    std::fs::metadata(path).map_or(Ok(()), |found| regular(&found))
}

fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

/// A new file with the rights that the user's umask gives any other; a temporary file's own are the owner's alone.
fn readable_by_all(folder: &Path) -> io::Result<NamedTempFile> {
    may_write(folder)?;
    let [begin, end] = PARTIAL;
    let mut builder = tempfile::Builder::new();
    builder.prefix(begin).suffix(end);
    platform::for_all_to_read(&mut builder);
    builder.tempfile_in(folder).map_err(without_its_name)
}

/// What a temporary file adds to an error is its own name, which tells nobody anything.
fn without_its_name(error: io::Error) -> io::Error {
    let text = error.to_string();
    match text.split_once(" at path ") {
        Some((reason, _)) => io::Error::new(error.kind(), reason.to_owned()),
        None => error,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_replaced_whole_and_nothing_else_is_left() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("deep/file.json");
        write_atomic(&path, b"old").unwrap();
        write_atomic(&path, b"new").unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), b"new");
        assert_eq!(std::fs::read_dir(path.parent().unwrap()).unwrap().count(), 1);
    }

    #[test]
    fn a_target_that_cannot_be_replaced_stays_as_it_was() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir(folder.path().join("taken")).unwrap();
        std::fs::write(folder.path().join("taken/inside"), b"kept").unwrap();
        assert!(write_atomic(&folder.path().join("taken"), b"new").is_err());
        assert_eq!(std::fs::read(folder.path().join("taken/inside")).unwrap(), b"kept");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[cfg(unix)]
    #[test]
    fn a_device_stays_one() {
        let folder = tempfile::tempdir().unwrap();
        let link = folder.path().join("link");
        std::os::unix::fs::symlink("/dev/null", &link).unwrap();
        for write in [write_atomic, replace, create_atomic] {
            let refused = write(&link, b"new").unwrap_err().to_string();
            assert!(refused.contains("a device") && refused.contains("regular file"), "{refused}");
        }
        assert!(link.is_symlink());
    }

    #[test]
    fn a_new_file_is_created_once() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("deep/file.json");
        create_atomic(&path, b"first").unwrap();
        let error = create_atomic(&path, b"second").unwrap_err();
        assert_eq!(error.kind(), io::ErrorKind::AlreadyExists);
        assert_eq!(std::fs::read(&path).unwrap(), b"first");
        assert_eq!(std::fs::read_dir(path.parent().unwrap()).unwrap().count(), 1);
    }

    #[test]
    fn what_a_killed_writer_left_is_told_from_other_files() {
        let folder = tempfile::tempdir().unwrap();
        let staged = Staged::new(&folder.path().join("file"), b"half").unwrap();
        let (_, left) = staged.file.keep().unwrap();
        std::fs::write(folder.path().join(".carom-notes"), b"kept").unwrap();
        remove_abandoned_files(folder.path()).unwrap();
        assert!(left.exists(), "its writer may still be at work");
        let long_ago = SystemTime::now() - 2 * ABANDONED;
        std::fs::File::options().write(true).open(&left).unwrap().set_modified(long_ago).unwrap();
        remove_abandoned_files(folder.path()).unwrap();
        assert!(!left.exists());
        std::fs::write(&left, b"half").unwrap();
        remove_partial_files(folder.path()).unwrap();
        assert!(!left.exists() && folder.path().join(".carom-notes").exists());
    }
}
