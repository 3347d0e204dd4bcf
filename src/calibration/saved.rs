//! The file of a calibrated table.

use std::{
    io,
    path::{Path, PathBuf},
};

use crate::{
    storage::{self, target_of, write_atomic},
    table::Table,
};

/// Why a table is not written.
#[derive(Debug, thiserror::Error)]
pub enum SaveError {
    /// Something else is there.
    #[error("{0} is there already and is no table, so it stays as it is; give another name")]
    Other(PathBuf),
    /// It cannot be written.
    #[error("{0} cannot be written: {1}")]
    Unwritten(PathBuf, io::Error),
}

/// Whether a table may be written there: over another table at most.
///
/// # Errors
/// Where something else is there.
pub fn may_save_table(path: &Path) -> Result<(), SaveError> {
    let is_table = |text: String| Table::from_toml(&text).is_ok();
    if path.exists() && !storage::read_text(path, storage::SMALL).is_ok_and(is_table) {
        return Err(SaveError::Other(path.to_owned()));
    }
    Ok(())
}

/// Writes the table, over another table at most.
///
/// # Errors
/// As [`may_save_table`], and where the file cannot be written.
pub fn save_table(path: &Path, table: &Table) -> Result<(), SaveError> {
    may_save_table(path)?;
    let unwritten = |error| SaveError::Unwritten(path.to_owned(), error);
    let text = toml::to_string(table).map_err(|error| unwritten(io::Error::other(error)))?;
    let text = format!(
        "# Written by carom calibrate. carom recommend --table plays on it, with the path of this file.\n{text}"
    );
    write_atomic(&target_of(path), text.as_bytes()).map_err(unwritten)
}
