//! One process at a time in a folder.

use std::{
    fs::{File, OpenOptions, TryLockError},
    io,
    path::Path,
    time::Duration,
};

/// Attempts to take the lock, and the pause between them: [`Lock::is_held`] holds it for an instant.
const ATTEMPTS: u32 = 20;
const PAUSE: Duration = Duration::from_millis(10);

/// How often [`Lock::wait`] tries to take it, a fifth of a second each.
const WAITS: u32 = 50;

/// The right to write into a folder, until it is dropped.
#[derive(Debug)]
pub struct Lock {
    /// The system lets go of the lock when the file is closed.
    _file: File,
}

impl Lock {
    /// The file that is locked. It stays when the lock is gone: what counts is the system's lock on it, which ends with the
    /// process that holds it, however that ends.
    pub const FILE: &str = "lock";

    /// Takes the lock of a folder; `None` if another process has it.
    ///
    /// # Errors
    /// Whatever the file system reports. One that knows no locks is taken at its word: then nothing is locked.
    pub fn take(folder: &Path) -> io::Result<Option<Self>> {
        let path = folder.join(Self::FILE);
        if let Ok(found) = path.metadata() {
            super::reading::regular(&found)?;
        }
        let file = OpenOptions::new().create(true).truncate(false).write(true).open(path)?;
        for attempt in 0..ATTEMPTS {
            if attempt > 0 {
                std::thread::sleep(PAUSE);
            }
            match file.try_lock() {
                Ok(()) => return Ok(Some(Self { _file: file })),
                Err(TryLockError::WouldBlock) => {}
                Err(TryLockError::Error(error)) if error.kind() == io::ErrorKind::Unsupported => {
                    return Ok(Some(Self { _file: file }));
                }
                Err(TryLockError::Error(error)) => return Err(error),
            }
        }
        Ok(None)
    }

    /// The same, but waits for another process; the folder is made where it is not there.
    ///
    /// # Errors
    /// Where the other keeps it for long, or whatever the file system reports.
    pub fn wait(folder: &Path) -> io::Result<Self> {
        std::fs::create_dir_all(folder)?;
        for _ in 0..WAITS {
            if let Some(lock) = Self::take(folder)? {
                return Ok(lock);
            }
        }
        Err(io::Error::new(io::ErrorKind::WouldBlock, "another program is changing what is kept; try again"))
    }

    /// Whether a process has the lock of a folder; `None` where that cannot be known: there is no lock, or the file system
    /// knows none.
    pub fn is_held(folder: &Path) -> Option<bool> {
        match super::open(&folder.join(Self::FILE)).ok()?.try_lock_shared() {
            Ok(()) => Some(false),
            Err(TryLockError::WouldBlock) => Some(true),
            Err(TryLockError::Error(_)) => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_is_locked_until_the_lock_is_dropped() {
        let folder = tempfile::tempdir().unwrap();
        assert_eq!(Lock::is_held(folder.path()), None);
        let lock = Lock::take(folder.path()).unwrap();
        assert!(lock.is_some() && Lock::is_held(folder.path()) == Some(true));
        assert!(Lock::take(folder.path()).unwrap().is_none());
        drop(lock);
        assert!(Lock::is_held(folder.path()) == Some(false) && Lock::take(folder.path()).unwrap().is_some());
    }
}
