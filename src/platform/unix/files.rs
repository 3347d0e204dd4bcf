//! Files: rights, identity, what outlives a power cut, and room on the disk.

use std::{
    fs::{File, Metadata},
    io,
    os::unix::fs::{MetadataExt, PermissionsExt},
    path::Path,
    sync::{Arc, atomic::AtomicBool},
};

use rustix::io::Errno;
use signal_hook::{consts::SIGXFSZ, flag};

/// Gives new files the rights that the user's umask gives any other; a temporary file's own are the owner's alone.
pub fn for_all_to_read(builder: &mut tempfile::Builder<'_, '_>) {
    builder.permissions(PermissionsExt::from_mode(0o666));
}

/// A number that a file keeps when it is written to, and loses when another takes its place.
pub fn file_identity(data: &Metadata) -> u64 {
    data.ino()
}

/// Has the names in a folder outlive a power cut, where the file system can be asked for that: some, over a network or of other
/// systems, keep names in their own way and refuse.
///
/// # Errors
/// Whatever else the file system reports.
pub fn sync_folder(folder: &Path) -> io::Result<()> {
    unless_unsupported(File::open(folder)?.sync_all())
}

/// The `answer`, where a file system that does not know the request counts as success.
fn unless_unsupported(answer: io::Result<()>) -> io::Result<()> {
    let is_unknown = |errno| [Errno::INVAL, Errno::NOTSUP, Errno::OPNOTSUPP, Errno::NOSYS].contains(&errno);
    match answer {
        Err(error) if Errno::from_io_error(&error).is_some_and(is_unknown) => Ok(()),
        answer => answer,
    }
}

/// Bytes that this user may still write where `path` is; none where the system does not tell.
///
/// # Errors
/// Whatever the file system reports.
pub fn free_space(path: &Path) -> io::Result<Option<u64>> {
    let found = rustix::fs::statvfs(path)?;
    Ok(Some(found.f_bavail.saturating_mul(found.f_frsize)))
}

/// Makes a write beyond the limit on file sizes fail with an error, like a full disk; otherwise a signal ends the process there,
/// without a word and with half a file left.
///
/// # Errors
/// Where the system refuses a handler.
pub fn refuse_large_files() -> io::Result<()> {
    flag::register(SIGXFSZ, Arc::new(AtomicBool::new(false))).map(|_| ())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_system_that_syncs_no_folders_has_not_failed() {
        for errno in [Errno::INVAL, Errno::NOTSUP, Errno::NOSYS] {
            unless_unsupported(Err(errno.into())).unwrap();
        }
        assert!(
            unless_unsupported(Err(Errno::IO.into())).is_err() && unless_unsupported(Err(Errno::NOSPC.into())).is_err()
        );
        sync_folder(tempfile::tempdir().unwrap().path()).unwrap();
    }
}
