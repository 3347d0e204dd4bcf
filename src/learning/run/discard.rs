//! Giving a run up.

use std::{io::ErrorKind, path::Path};

use super::{FILES, RunError, error::file, holds_checkpoints, lock};

/// Ends a run that shall not be kept: removes what it has written into its folder, and the folder if nothing else is in
/// it.
///
/// # Errors
/// [`RunError::Missing`], [`RunError::Busy`], or whatever the file system reports.
pub fn discard(folder: &Path) -> Result<(), RunError> {
    if !holds_checkpoints(folder) {
        return Err(RunError::Missing(folder.display().to_string()));
    }
    let _lock = lock(folder)?;
    for name in FILES {
        match std::fs::remove_file(folder.join(name)) {
            Err(error) if error.kind() != ErrorKind::NotFound => return Err(file(&folder.join(name))(error)),
            _ => {}
        }
    }
    // Somebody may have put something else there, which is not ours to remove.
    let _ = std::fs::remove_dir(folder);
    Ok(())
}
