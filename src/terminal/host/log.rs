//! What happened, for later: a file in the user's state directory.

use std::{
    fs::{self, File, OpenOptions},
    io::{self, Write},
    path::{Path, PathBuf},
    sync::Mutex,
};

use tracing::Level;

use crate::printing::Shown;

/// Bytes from which on the file is laid aside, so that at most two of this size are kept.
const LARGEST: u64 = 1 << 20;

/// The level that is written down, unless `CAROM_LOG` says otherwise.
const LEVEL: Level = Level::INFO;

/// Starts writing to the file at `path`, with `level` as in `CAROM_LOG`: error, warn, info, debug or trace.
///
/// # Errors
/// A file that cannot be opened. The program does without, then.
pub fn start(path: &Path, level: Option<&str>) -> io::Result<()> {
    let file = Mutex::new(Shown::new(LogFile::open(path)?));
    let level = level.and_then(|name| name.parse().ok()).unwrap_or(LEVEL);
    // What cannot be written, as on a full disk, is not told on the standard error: that is the screen, and where it is gone
    // the complaint itself would be a panic, which is written down in its turn, and so on.
    let subscriber = tracing_subscriber::fmt()
        .with_writer(file)
        .with_ansi(false)
        .with_target(false)
        .with_max_level(level)
        .log_internal_errors(false);
    // A second start in the same process, as in tests, changes nothing.
    let _ = subscriber.try_init();
    Ok(())
}

/// The file while the program runs.
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
        if self.size >= LARGEST {
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

/// The file, to be written on at its end; one that has grown large is laid aside.
fn open(path: &Path) -> io::Result<File> {
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder)?;
    }
    if fs::metadata(path).is_ok_and(|known| known.len() >= LARGEST) {
        fs::rename(path, path.with_extension("log.old"))?;
    }
    OpenOptions::new().create(true).append(true).open(path)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_that_grows_large_meanwhile_is_laid_aside_too() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("carom.log");
        let mut log = LogFile::open(&path).unwrap();
        for _ in 0..5 * LARGEST / 4096 {
            log.write_all(&[b'a'; 4096]).unwrap();
        }
        let sizes = fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().metadata().unwrap().len());
        assert!(sizes.sum::<u64>() <= 2 * LARGEST);
    }

    #[test]
    fn a_large_file_is_laid_aside_and_a_small_one_goes_on() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("deep/carom.log");
        open(&path).unwrap().write_all(b"one\n").unwrap();
        open(&path).unwrap().write_all(b"two\n").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"one\ntwo\n");
        open(&path).unwrap().set_len(LARGEST).unwrap();
        open(&path).unwrap().write_all(b"three\n").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"three\n");
        assert_eq!(fs::metadata(path.with_extension("log.old")).unwrap().len(), LARGEST);
    }
}
