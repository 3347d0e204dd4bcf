//! What happened, for later: a file in the user's state directory.

use std::{
    fs::{self, File, OpenOptions},
    io,
    path::Path,
    sync::Mutex,
};

use tracing::Level;

use crate::printing::Shown;

/// Bytes from which on the file is laid aside at the next start, so that at most two of this size are kept.
const LARGEST: u64 = 1 << 20;

/// The level that is written down, unless `CAROM_LOG` says otherwise.
const LEVEL: Level = Level::INFO;

/// Starts writing to the file at `path`, with `level` as in `CAROM_LOG`: error, warn, info, debug or trace.
///
/// # Errors
/// A file that cannot be opened. The program does without, then.
pub fn start(path: &Path, level: Option<&str>) -> io::Result<()> {
    let file = Mutex::new(Shown::new(open(path)?));
    let level = level.and_then(|name| name.parse().ok()).unwrap_or(LEVEL);
    let subscriber =
        tracing_subscriber::fmt().with_writer(file).with_ansi(false).with_target(false).with_max_level(level);
    // A second start in the same process, as in tests, changes nothing.
    let _ = subscriber.try_init();
    Ok(())
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
    use std::io::Write;

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
