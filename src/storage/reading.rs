//! Files that anybody may have put there: regular ones of a size that is no trouble. A pipe would keep the program waiting,
//! and a device can be read for ever.

use std::{
    fs::{self, File},
    io::{self, Read},
    path::Path,
};

use super::confinement::may_read;

/// Largest table, settings or other small file, bytes.
pub const SMALL: u64 = 1 << 20;

/// Largest file of practice, bytes: ten thousand sessions are a tenth of it.
pub const PRACTICE: u64 = 1 << 28;

/// Largest file of weights or metrics, bytes: a checkpoint with a full memory is a tenth of it.
pub const LARGE: u64 = 1 << 32;

/// The content of the file at `path`, if it is a regular one of at most `largest` bytes.
///
/// # Errors
/// Where it is not, or whatever the file system reports.
pub fn read(path: &Path, largest: u64) -> io::Result<Vec<u8>> {
    let file = open(path)?;
    let mut bytes = Vec::new();
    // What grows while it is read is no larger either.
    file.take(largest + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > largest {
        return Err(io::Error::new(
            io::ErrorKind::FileTooLarge,
            format!("it has more than {largest} bytes, which is no file of this kind"),
        ));
    }
    Ok(bytes)
}

/// The same for text.
///
/// # Errors
/// As [`read`], and for what is no UTF-8.
pub fn read_text(path: &Path, largest: u64) -> io::Result<String> {
    let no_text = |_| io::Error::new(io::ErrorKind::InvalidData, "it is no text: it has bytes that are no UTF-8");
    String::from_utf8(read(path, largest)?).map_err(no_text)
}

/// As [`read`]; `None` where there is no such file.
///
/// # Errors
/// As [`read`], but for that.
pub fn read_if_there(path: &Path, largest: u64) -> io::Result<Option<Vec<u8>>> {
    match read(path, largest) {
        Err(error) if matches!(error.kind(), io::ErrorKind::NotFound | io::ErrorKind::NotADirectory) => Ok(None),
        bytes => bytes.map(Some),
    }
}

/// Moves a file that cannot be read out of the way of one that is to be written in its place; gives what came of that, as the end of a
/// sentence about the file.
pub fn put_aside(path: &Path) -> String {
    let (mut aside, mut number) = (path.with_extension("unread.json"), 1);
    // What was kept before stays.
    while aside.exists() {
        number += 1;
        aside = path.with_extension(format!("unread-{number}.json"));
    }
    match fs::rename(path, &aside) {
        Ok(()) => format!("it is kept as {}", aside.display()),
        Err(error) => format!("it cannot be kept aside: {error}"),
    }
}

/// The regular file at `path`, to be read.
///
/// # Errors
/// Where it is none, or whatever the file system reports.
pub fn open(path: &Path) -> io::Result<File> {
    may_read(path)?;
    // Before it is opened: that alone waits where a pipe has no writer.
    regular(&fs::metadata(path).map_err(missing)?)?;
    let file = File::open(path)?;
    regular(&file.metadata()?)?;
    Ok(file)
}

/// What is not there is told in words; other reasons are the system's.
fn missing(error: io::Error) -> io::Error {
    match error.kind() {
        kind @ (io::ErrorKind::NotFound | io::ErrorKind::NotADirectory) => {
            io::Error::new(kind, "there is no such file; accepted is a regular file")
        }
        _ => error,
    }
}

/// Refuses what is there and is no regular file.
///
/// # Errors
/// Where that is so.
pub fn regular(found: &fs::Metadata) -> io::Result<()> {
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
    fn only_regular_files_of_the_size_that_is_accepted_are_read() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("file");
        fs::write(&path, "four").unwrap();
        assert_eq!(read_text(&path, 4).unwrap(), "four");
        assert!(read(&path, 3).unwrap_err().to_string().contains("more than 3 bytes"));
        assert!(read(folder.path(), 9).unwrap_err().to_string().contains("a folder"));
        // In the place of a folder, too: "Not a directory" would be told of a file that nobody has named.
        for missing in [folder.path().join("none"), path.join("none")] {
            let error = read(&missing, 9).unwrap_err();
            assert_eq!(error.to_string(), "there is no such file; accepted is a regular file");
            assert_eq!(read_if_there(&missing, 9).unwrap(), None);
        }
        #[cfg(unix)]
        assert!(read(Path::new("/dev/zero"), 9).unwrap_err().to_string().contains("a device"));
        fs::write(&path, [0xff]).unwrap();
        assert!(read_text(&path, 4).unwrap_err().to_string().contains("UTF-8"));
    }
}
