//! The log file in the user's state directory.

use std::{
    fs::{self, File, OpenOptions},
    io::{self, Write},
    path::{Path, PathBuf},
    sync::Mutex,
};

use tracing::Level;

use crate::printing::EscapingWriter;

/// Size from which the file is rotated, bytes; at most two files of this size are kept.
const MAX_BYTES: u64 = 1 << 20;

/// Default log level, unless `CAROM_LOG` sets another.
const LEVEL: Level = Level::INFO;

/// Starts logging to the file at `path`, with a `level` as in `CAROM_LOG`: error, warn, info, debug or trace.
///
/// # Errors
/// Fails if the file cannot be opened; the program then runs without a log.
pub fn start(path: &Path, level: Option<&str>) -> io::Result<()> {
    let file = Mutex::new(EscapingWriter::new(LogFile::open(path)?));
    let level = level.and_then(|name| name.parse().ok()).unwrap_or(LEVEL);
    // Write errors, as on a full disk, are not printed on standard error: that is the screen. If it is closed, printing would panic, the
    // panic would be logged, and so on.
    let subscriber = tracing_subscriber::fmt()
        .with_writer(file)
        .with_ansi(false)
        .with_target(false)
        .with_max_level(level)
        .log_internal_errors(false);
    // A second start in the same process, as in tests, has no effect.
    let _ = subscriber.try_init();
    Ok(())
}

/// The open log file.
struct LogFile {
    path: PathBuf,
    file: File,
    size: u64,
}

impl LogFile {
    fn open(path: &Path) -> io::Result<Self> {
        let file = open(path)?;
        let size = file.metadata()?.len();
        Ok(Self { path: path.to_owned(), file, size })
    }
}

impl Write for LogFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if self.size >= MAX_BYTES {
            *self = Self::open(&self.path)?;
        }
        let written = self.file.write(bytes)?;
        self.size += written as u64;
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

/// Opens the file for appending; a large one is renamed first.
fn open(path: &Path) -> io::Result<File> {
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder)?;
    }
    if fs::metadata(path).is_ok_and(|known| known.len() >= MAX_BYTES) {
        fs::rename(path, path.with_extension("log.old"))?;
    }
    OpenOptions::new().create(true).append(true).open(path)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_log_that_grows_large_is_rotated() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("carom.log");
        let mut log = LogFile::open(&path).unwrap();
        for _ in 0..5 * MAX_BYTES / 4096 {
            log.write_all(&[b'a'; 4096]).unwrap();
        }
        let sizes = fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().metadata().unwrap().len());
        assert!(sizes.sum::<u64>() <= 2 * MAX_BYTES);
    }

    #[test]
    fn a_large_log_is_rotated_and_a_small_one_continued() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("deep/carom.log");
        open(&path).unwrap().write_all(b"one\n").unwrap();
        open(&path).unwrap().write_all(b"two\n").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"one\ntwo\n");
        open(&path).unwrap().set_len(MAX_BYTES).unwrap();
        open(&path).unwrap().write_all(b"three\n").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"three\n");
        assert_eq!(fs::metadata(path.with_extension("log.old")).unwrap().len(), MAX_BYTES);
    }
}
