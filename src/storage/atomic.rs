//! Whole files or none: written beside the target, synced, then renamed over it.

use std::{
    io::{self, Write},
    path::{Path, PathBuf},
};

use tempfile::NamedTempFile;

/// Begin and end of the names of files that are being written: what a killed process leaves can be told by them.
const PARTIAL: [&str; 2] = [".carom-", ".partial"];

/// Replaces the file at `path` by `bytes`. A reader sees the old content or the new one, never a part; missing folders
/// are made.
///
/// # Errors
/// Whatever the file system reports; the old file is then untouched.
pub fn write_atomic(path: &Path, bytes: &[u8]) -> io::Result<()> {
    Staged::new(path, bytes)?.publish()
}

/// Like [`write_atomic`] for what need not outlive a power cut: a reader sees the old content or the new one, and nobody
/// waits for the disk.
///
/// # Errors
/// Whatever the file system reports; the old file is then untouched.
pub fn replace(path: &Path, bytes: &[u8]) -> io::Result<()> {
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
        let folder = folder_of(path);
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
    /// Whatever the file system reports; what stands there is then untouched.
    pub fn publish(self) -> io::Result<()> {
        self.file.persist(&self.path)?;
        // The rename itself must outlive a power cut. Folders can be opened and synced on Unix alone.
        #[cfg(unix)]
        std::fs::File::open(folder_of(&self.path))?.sync_all()?;
        Ok(())
    }
}

/// Removes from `folder` what a process that was killed while writing has left there. Nobody may be writing into it.
///
/// # Errors
/// Whatever the file system reports.
pub fn remove_partial_files(folder: &Path) -> io::Result<()> {
    let [begin, end] = PARTIAL;
    for entry in std::fs::read_dir(folder)? {
        let name = entry?.file_name();
        if name.to_str().is_some_and(|name| name.starts_with(begin) && name.ends_with(end)) {
            std::fs::remove_file(folder.join(name))?;
        }
    }
    Ok(())
}

fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

/// A new file with the rights that the user's umask gives any other; a temporary file's own are the owner's alone.
fn readable_by_all(folder: &Path) -> io::Result<NamedTempFile> {
    let [begin, end] = PARTIAL;
    let mut builder = tempfile::Builder::new();
    builder.prefix(begin).suffix(end);
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(folder)
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

    #[test]
    fn what_a_killed_writer_left_is_told_from_other_files() {
        let folder = tempfile::tempdir().unwrap();
        let staged = Staged::new(&folder.path().join("file"), b"half").unwrap();
        let (_, left) = staged.file.keep().unwrap();
        std::fs::write(folder.path().join(".carom-notes"), b"kept").unwrap();
        remove_partial_files(folder.path()).unwrap();
        assert!(!left.exists() && folder.path().join(".carom-notes").exists());
    }
}
