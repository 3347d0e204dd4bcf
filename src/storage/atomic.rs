//! Atomic file writes: the content is written to a temporary file next to the target, synced, and renamed over the target.

use std::{
    io::{self, Write},
    path::{Path, PathBuf},
    time::{Duration, SystemTime},
};

use serde::Serialize;
use tempfile::NamedTempFile;

use super::{confinement::check_write_allowed, reading::check_regular};
use crate::platform;

/// Prefix and suffix of temporary file names; they identify the files that a killed process left.
const PARTIAL: [&str; 2] = [".carom-", ".partial"];

/// Age at which a temporary file counts as abandoned: writing a few kilobytes does not take an hour.
const ABANDONED: Duration = Duration::from_secs(3600);

/// Replaces the file at `path` by `bytes`. A reader sees the old or the new content, never a part. Creates missing folders.
///
/// # Errors
/// Fails if `path` exists and is not a regular file, or with any error of the file system. The old file is then untouched, as for
/// [`StagedFile::publish`].
pub fn write_atomic(path: &Path, bytes: &[u8]) -> io::Result<()> {
    StagedFile::new(path, bytes)?.publish()
}

/// Like [`write_atomic`], but for a new file: of several programs that create the same file at once, exactly one succeeds.
///
/// # Errors
/// [`io::ErrorKind::AlreadyExists`] if the file exists, otherwise any error of the file system, as for [`StagedFile::publish`]. The
/// existing file is untouched.
pub fn create_atomic(path: &Path, bytes: &[u8]) -> io::Result<()> {
    StagedFile::new(path, bytes)?.publish_new()
}

/// Like [`write_atomic`] for data that need not survive a power cut: a reader sees the old or the new content, and nothing waits for the
/// disk.
///
/// # Errors
/// Fails if `path` exists and is not a regular file, if its folder is missing, or with any error of the file system. The old file is then
/// untouched.
pub fn write_atomic_unsynced(path: &Path, bytes: &[u8]) -> io::Result<()> {
    check_replaceable(path)?;
    let mut file = readable_by_all(folder_of(path))?;
    file.as_file_mut().write_all(bytes)?;
    file.persist(path)?;
    Ok(())
}

/// Writes `value` as JSON like [`write_atomic_unsynced`], and creates its folder if it is missing.
///
/// # Errors
/// Any error of the file system; the old file is then untouched.
pub fn save_json(path: &Path, value: &impl Serialize) -> io::Result<()> {
    std::fs::create_dir_all(folder_of(path))?;
    write_atomic_unsynced(path, &serde_json::to_vec(value)?)
}

/// A file that is safely on the disk under a temporary name. It is removed if it is dropped without being published.
#[derive(Debug)]
pub struct StagedFile {
    file: NamedTempFile,
    path: PathBuf,
}

impl StagedFile {
    /// Writes the future content of `path` to a temporary file. Creates missing folders.
    ///
    /// # Errors
    /// Returns any error of the file system; no file is left then.
    pub fn new(path: &Path, bytes: &[u8]) -> io::Result<Self> {
        check_replaceable(path)?;
        let folder = folder_of(path);
        check_write_allowed(folder)?;
        std::fs::create_dir_all(folder)?;
        let mut file = readable_by_all(folder)?;
        // Not through the temporary file's own methods, which would add its name to the error.
        file.as_file_mut().write_all(bytes)?;
        file.as_file().sync_all()?;
        Ok(Self { file, path: path.to_owned() })
    }

    /// Renames the file to its final path, over any existing file.
    ///
    /// # Errors
    /// Returns any error of the file system; the old file is then untouched. Exception: if the disk fails at the final sync, the new file
    /// is in place but may not survive a power cut.
    pub fn publish(self) -> io::Result<()> {
        self.file.persist(&self.path)?;
        platform::sync_folder(folder_of(&self.path))
    }

    /// Renames the file to its final path if no file exists there.
    ///
    /// # Errors
    /// [`io::ErrorKind::AlreadyExists`], or any error of [`StagedFile::publish`].
    pub fn publish_new(self) -> io::Result<()> {
        self.file.persist_noclobber(&self.path)?;
        platform::sync_folder(folder_of(&self.path))
    }
}

/// Removes the temporary files that a killed process left in `folder`. No process may be writing into it.
///
/// # Errors
/// Returns any error of the file system.
pub fn remove_partial_files(folder: &Path) -> io::Result<()> {
    partial_files(folder)?.iter().try_for_each(remove_if_exists)
}

/// Like [`remove_partial_files`] while other processes may be writing: files less than an hour old are kept.
///
/// # Errors
/// Returns any error of the file system.
pub fn remove_abandoned_files(folder: &Path) -> io::Result<()> {
    let is_old = |file: &PathBuf| {
        let changed = std::fs::metadata(file).and_then(|metadata| metadata.modified());
        // A file that has vanished meanwhile was completed by its writer.
        changed.is_ok_and(|changed| SystemTime::now().duration_since(changed).is_ok_and(|age| age > ABANDONED))
    };
    partial_files(folder)?.iter().filter(|file| is_old(file)).try_for_each(remove_if_exists)
}

/// Removes a file, which another process may have removed or renamed meanwhile.
///
/// # Errors
/// Any error of the file system, except that the file does not exist.
pub fn remove_if_exists(file: impl AsRef<Path>) -> io::Result<()> {
    std::fs::remove_file(file)
        .or_else(|error| if error.kind() == io::ErrorKind::NotFound { Ok(()) } else { Err(error) })
}

/// Returns the temporary files in `folder`: those still being written, and those of killed writers.
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

/// Returns the file to replace when `path` is meant: symbolic links are followed, so that they stay links.
pub fn resolve_symlinks(path: &Path) -> PathBuf {
    std::fs::canonicalize(path).unwrap_or_else(|_| path.to_owned())
}

/// Refuses an existing path that is not a regular file: replacing a pipe or a device would turn it into a regular file.
fn check_replaceable(path: &Path) -> io::Result<()> {
    std::fs::metadata(path).map_or(Ok(()), |found| check_regular(&found))
}

fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

/// Creates a temporary file with the permissions that the umask grants to any new file, instead of access for the owner alone.
fn readable_by_all(folder: &Path) -> io::Result<NamedTempFile> {
    check_write_allowed(folder)?;
    let [begin, end] = PARTIAL;
    let mut builder = tempfile::Builder::new();
    builder.prefix(begin).suffix(end);
    platform::use_umask_permissions(&mut builder);
    builder.tempfile_in(folder).map_err(without_its_name)
}

/// Removes the temporary file's own name from an error: it means nothing to users.
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
    fn a_write_replaces_the_file_and_leaves_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("deep/file.json");
        write_atomic(&path, b"old").unwrap();
        write_atomic(&path, b"new").unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), b"new");
        assert_eq!(std::fs::read_dir(path.parent().unwrap()).unwrap().count(), 1);
    }

    #[test]
    fn an_irreplaceable_target_stays_unchanged() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir(folder.path().join("taken")).unwrap();
        std::fs::write(folder.path().join("taken/inside"), b"kept").unwrap();
        assert!(write_atomic(&folder.path().join("taken"), b"new").is_err());
        assert_eq!(std::fs::read(folder.path().join("taken/inside")).unwrap(), b"kept");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[cfg(unix)]
    #[test]
    fn devices_are_not_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let link = folder.path().join("link");
        std::os::unix::fs::symlink("/dev/null", &link).unwrap();
        for write in [write_atomic, write_atomic_unsynced, create_atomic] {
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
    fn leftover_temporary_files_are_removed_and_others_kept() {
        let folder = tempfile::tempdir().unwrap();
        let staged = StagedFile::new(&folder.path().join("file"), b"half").unwrap();
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
