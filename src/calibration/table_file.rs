//! The file of a calibrated table.

use std::{
    io,
    path::{Path, PathBuf},
};

use crate::{
    storage::{self, create_atomic, resolve_symlinks, write_atomic},
    table::Table,
};

/// A table cannot be saved.
#[derive(Debug, thiserror::Error)]
pub enum SaveError {
    /// The file exists and is not a table.
    #[error("{0} already exists and is no table, so it is not overwritten; give another name")]
    NotATable(PathBuf),
    /// The file cannot be written.
    #[error("{0} cannot be written: {1}")]
    Unwritable(PathBuf, io::Error),
}

/// Checks whether a table may be saved at `path`. It may replace another table, but no other file.
///
/// # Errors
/// Fails if the file exists and is not a table.
pub fn may_save_table(path: &Path) -> Result<(), SaveError> {
    let is_table = |text: String| Table::from_toml(&text).is_ok();
    if path.exists() && !storage::read_text(path, storage::MAX_SMALL_FILE).is_ok_and(is_table) {
        return Err(SaveError::NotATable(path.to_owned()));
    }
    Ok(())
}

/// Writes the table. With `may_replace` it may replace another table, but no other file.
///
/// # Errors
/// The same as [`may_save_table`], and if the file cannot be written, or exists without `may_replace`.
pub fn save_table(path: &Path, table: &Table, may_replace: bool) -> Result<(), SaveError> {
    may_save_table(path)?;
    let unwritten = |error| SaveError::Unwritable(path.to_owned(), error);
    let text = toml::to_string(table).map_err(|error| unwritten(io::Error::other(error)))?;
    let text = format!(
        "# Written by carom calibrate. To use this table, give the path of this file to carom recommend --table.\n{text}"
    );
    let write = if may_replace { write_atomic } else { create_atomic };
    write(&resolve_symlinks(path), text.as_bytes()).map_err(unwritten)
}
