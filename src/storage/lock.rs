//! A lock that gives one process at a time access to a folder.

use std::{
    fs::{File, OpenOptions, TryLockError},
    io,
    path::Path,
    time::Duration,
};

use crate::platform;

/// Attempts to take the lock, and the pause between them: [`Lock::is_held`] takes it for an instant.
const ATTEMPTS: u32 = 20;
const PAUSE: Duration = Duration::from_millis(10);

/// Number of attempts of [`Lock::acquire`], a fifth of a second each.
const WAITS: u32 = 50;

/// The exclusive right to write into a folder, until this is dropped.
#[derive(Debug)]
pub struct Lock {
    /// Closing the file releases the lock.
    _file: File,
}

impl Lock {
    /// Name of the locked file. It remains after the lock is released. Only the system's lock on the file counts, and that ends with its
    /// process, even after a crash.
    pub const FILE: &str = "lock";

    /// Takes the lock of a folder; `None` if another process has it.
    ///
    /// # Errors
    /// Returns any error of the file system. A file system without locks counts as success, but nothing is locked then.
    pub fn try_acquire(folder: &Path) -> io::Result<Option<Self>> {
        let path = folder.join(Self::FILE);
        if let Ok(found) = path.metadata() {
            super::reading::check_regular(&found)?;
        }
        let file = OpenOptions::new().create(true).truncate(false).write(true).open(path)?;
        for attempt in 0..ATTEMPTS {
            if attempt > 0 {
                std::thread::sleep(PAUSE);
            }
            match file.try_lock() {
                Ok(()) => return Ok(Some(Self { _file: file })),
                Err(TryLockError::WouldBlock) => {}
                Err(TryLockError::Error(error)) if platform::lacks_locks(&error) => {
                    return Ok(Some(Self { _file: file }));
                }
                Err(TryLockError::Error(error)) => return Err(error),
            }
        }
        Ok(None)
    }

    /// Like [`Lock::try_acquire`], but waits for another process to release the lock. Creates the folder if it is missing.
    ///
    /// # Errors
    /// Fails if the other process does not release the lock in time, or with any error of the file system.
    pub fn acquire(folder: &Path) -> io::Result<Self> {
        std::fs::create_dir_all(folder)?;
        for _ in 0..WAITS {
            if let Some(lock) = Self::try_acquire(folder)? {
                return Ok(lock);
            }
        }
        Err(io::Error::new(io::ErrorKind::WouldBlock, "another program is changing the stored data; try again"))
    }

    /// Whether a process holds the lock of a folder; `None` if that is unknown because there is no lock file or the file system has no
    /// locks.
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
        let lock = Lock::try_acquire(folder.path()).unwrap();
        assert!(lock.is_some() && Lock::is_held(folder.path()) == Some(true));
        assert!(Lock::try_acquire(folder.path()).unwrap().is_none());
        drop(lock);
        assert!(Lock::is_held(folder.path()) == Some(false) && Lock::try_acquire(folder.path()).unwrap().is_some());
    }
}
