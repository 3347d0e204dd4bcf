//! Files: permissions, identity, durability and free disk space.

use std::{
    fs::{File, Metadata},
    io,
    os::unix::fs::{MetadataExt, PermissionsExt},
    path::Path,
    sync::{Arc, atomic::AtomicBool},
};

use rustix::io::Errno;
use signal_hook::{consts::SIGXFSZ, flag};

/// Gives a temporary file the permissions that the umask grants to any new file, instead of access for the owner alone.
pub fn use_umask_permissions(builder: &mut tempfile::Builder<'_, '_>) {
    builder.permissions(PermissionsExt::from_mode(0o666));
}

/// Returns the inode number: a file keeps it when it is written to, and a replacement has another.
pub fn file_identity(data: &Metadata) -> u64 {
    data.ino()
}

/// Makes the names in a folder survive a power cut, if the file system supports the request. Some network and foreign file systems store
/// names in their own way and refuse it.
///
/// # Errors
/// Returns any other error of the file system.
pub fn sync_folder(folder: &Path) -> io::Result<()> {
    unless_unsupported(File::open(folder)?.sync_all())
}

/// Returns `answer`, but counts the error of a file system that does not know the request as success.
fn unless_unsupported(answer: io::Result<()>) -> io::Result<()> {
    let is_unknown = |errno| [Errno::INVAL, Errno::NOTSUP, Errno::OPNOTSUPP, Errno::NOSYS].contains(&errno);
    match answer {
        Err(error) if Errno::from_io_error(&error).is_some_and(is_unknown) => Ok(()),
        answer => answer,
    }
}

/// Whether a request for a lock failed because the file system has none: over NFS, if no lock service runs.
pub fn lacks_locks(error: &io::Error) -> bool {
    error.kind() == io::ErrorKind::Unsupported || Errno::from_io_error(error) == Some(Errno::NOLCK)
}

/// Returns the number of bytes that this user can still write at `path`; `None` if the system does not report it.
pub fn free_space(path: &Path) -> Option<u64> {
    rustix::fs::statvfs(path).ok().map(|found| found.f_bavail.saturating_mul(found.f_frsize))
}

/// Makes a write beyond the file size limit fail with an error, as on a full disk. By default a signal would end the process there, without
/// a message and with half a file left.
///
/// # Errors
/// Fails if the system refuses a signal handler.
pub fn refuse_large_files() -> io::Result<()> {
    flag::register(SIGXFSZ, Arc::new(AtomicBool::new(false))).map(|_| ())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_system_without_locks_is_recognized() {
        assert!(lacks_locks(&Errno::NOLCK.into()) && lacks_locks(&Errno::NOTSUP.into()));
        assert!(!lacks_locks(&Errno::IO.into()));
    }

    #[test]
    fn unsupported_folder_sync_counts_as_success() {
        for errno in [Errno::INVAL, Errno::NOTSUP, Errno::NOSYS] {
            unless_unsupported(Err(errno.into())).unwrap();
        }
        assert!(
            unless_unsupported(Err(Errno::IO.into())).is_err() && unless_unsupported(Err(Errno::NOSPC.into())).is_err()
        );
        sync_folder(tempfile::tempdir().unwrap().path()).unwrap();
    }
}
