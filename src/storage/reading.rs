//! Safe reading of untrusted paths: only regular files up to a maximum size. A pipe would block the program, and a device may never end.

use std::{
    fs::{self, File},
    io::{self, Read},
    path::Path,
};

use super::confinement::check_read_allowed;

/// Largest table, settings file or other small file, bytes.
pub const MAX_SMALL_FILE: u64 = 1 << 20;

/// Largest practice file, bytes: ten thousand sessions take a tenth of it.
pub const MAX_PRACTICE_FILE: u64 = 1 << 28;

/// Largest file of weights or metrics, bytes: a checkpoint with a full replay buffer takes a tenth of it.
pub const MAX_LARGE_FILE: u64 = 1 << 32;

/// Returns the content of the file at `path`, if it is a regular file of at most `largest` bytes.
///
/// # Errors
/// Fails if it is not, or with any error of the file system.
pub fn read(path: &Path, largest: u64) -> io::Result<Vec<u8>> {
    let file = open(path)?;
    let mut bytes = Vec::new();
    // The limit also holds for a file that grows while it is read.
    file.take(largest + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > largest {
        return Err(io::Error::new(
            io::ErrorKind::FileTooLarge,
            format!("it has more than {largest} bytes, too many for a file of this kind"),
        ));
    }
    Ok(bytes)
}

/// Like [`read`], for text.
///
/// # Errors
/// Fails like [`read`], and for text that is not UTF-8.
pub fn read_text(path: &Path, largest: u64) -> io::Result<String> {
    let no_text = |_| io::Error::new(io::ErrorKind::InvalidData, "it is not text: it has bytes that are not UTF-8");
    String::from_utf8(read(path, largest)?).map_err(no_text)
}

/// Like [`read`], but returns `None` if the file does not exist.
///
/// # Errors
/// Fails like [`read`], except for a missing file.
pub fn read_if_exists(path: &Path, largest: u64) -> io::Result<Option<Vec<u8>>> {
    match read(path, largest) {
        Err(error) if matches!(error.kind(), io::ErrorKind::NotFound | io::ErrorKind::NotADirectory) => Ok(None),
        bytes => bytes.map(Some),
    }
}

/// Renames an unreadable file, so that a new one can be written in its place. Returns the outcome as the end of a sentence about the file.
pub fn rename_unreadable(path: &Path) -> String {
    let (mut aside, mut number) = (path.with_extension("unread.json"), 1);
    // Files that were renamed earlier are kept.
    while aside.exists() {
        number += 1;
        aside = path.with_extension(format!("unread-{number}.json"));
    }
    match fs::rename(path, &aside) {
        Ok(()) => format!("it is kept as {}", aside.display()),
        Err(error) => format!("it cannot be kept aside: {error}"),
    }
}

/// Opens the regular file at `path` for reading.
///
/// # Errors
/// Fails if it is not a regular file, or with any error of the file system.
pub fn open(path: &Path) -> io::Result<File> {
    check_read_allowed(path)?;
    // Check before opening, because opening a pipe without a writer blocks.
    check_regular(&fs::metadata(path).map_err(missing)?)?;
    let file = File::open(path)?;
    check_regular(&file.metadata()?)?;
    Ok(file)
}

/// Opens the file, pipe or device at `path` for reading. A pipe without a writer waits for one.
///
/// # Errors
/// Fails if it is a folder, or with any error of the file system.
pub fn open_stream(path: &Path) -> io::Result<File> {
    check_read_allowed(path)?;
    let found = fs::metadata(path).map_err(missing)?;
    if found.is_dir() {
        check_regular(&found)?;
    }
    File::open(path)
}

/// Rewrites the error for a missing file; other errors keep the system's text.
fn missing(error: io::Error) -> io::Error {
    match error.kind() {
        kind @ (io::ErrorKind::NotFound | io::ErrorKind::NotADirectory) => {
            io::Error::new(kind, "there is no such file; accepted is a regular file")
        }
        _ => error,
    }
}

/// Refuses a path that is not a regular file.
///
/// # Errors
/// Fails with the kind of the file that was found.
pub fn check_regular(found: &fs::Metadata) -> io::Result<()> {
    if found.is_file() {
        return Ok(());
    }
    let (kind, what) = if found.is_dir() {
        (io::ErrorKind::IsADirectory, "a folder")
    } else {
        (io::ErrorKind::InvalidInput, "a pipe, a device or the like")
    };
    Err(io::Error::new(kind, format!("it is {what}; accepted is a regular file")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_regular_files_up_to_the_limit_are_read() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("file");
        fs::write(&path, "four").unwrap();
        assert_eq!(read_text(&path, 4).unwrap(), "four");
        assert!(read(&path, 3).unwrap_err().to_string().contains("more than 3 bytes"));
        assert!(read(folder.path(), 9).unwrap_err().to_string().contains("a folder"));
        // The same for a path below a file: "Not a directory" would refer to a file that the user did not name.
        for missing in [folder.path().join("none"), path.join("none")] {
            let error = read(&missing, 9).unwrap_err();
            assert_eq!(error.to_string(), "there is no such file; accepted is a regular file");
            assert_eq!(read_if_exists(&missing, 9).unwrap(), None);
        }
        #[cfg(unix)]
        assert!(read(Path::new("/dev/zero"), 9).unwrap_err().to_string().contains("a device"));
        fs::write(&path, [0xff]).unwrap();
        assert!(read_text(&path, 4).unwrap_err().to_string().contains("UTF-8"));
    }
}
