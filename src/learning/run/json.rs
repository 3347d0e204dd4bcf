//! JSON files in a run's folder.

use std::{io, path::Path};

use serde::{Serialize, de::DeserializeOwned};

use super::error::{RunError, file};
use crate::storage::{self, write_atomic};

/// Reads the file at `path`, which may have at most `largest` bytes.
pub fn read<T: DeserializeOwned>(path: &Path, largest: u64) -> io::Result<T> {
    let bytes = storage::read(path, largest)?;
    serde_json::from_slice(&bytes)
        .map_err(|error| io::Error::new(io::ErrorKind::InvalidData, storage::describe_json_error(&error)))
}

/// Replaces the file at `path`; the text is indented, because people read it, too.
pub fn write(path: &Path, content: &impl Serialize) -> Result<(), RunError> {
    let write = || write_atomic(path, (serde_json::to_string_pretty(content)? + "\n").as_bytes());
    write().map_err(file(path))
}
