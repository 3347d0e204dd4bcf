//! Detects whether a file has changed, without reading it.

use std::{
    fs::Metadata,
    path::Path,
    time::{Duration, SystemTime},
};

use crate::platform;

/// Metadata that differ between two states of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stamp {
    modified: Option<SystemTime>,
    /// Bytes of the file.
    pub length: u64,
    identity: u64,
}

impl Stamp {
    /// Returns the stamp of the file at `path`; `None` if there is no file.
    pub fn of(path: &Path) -> Option<Self> {
        std::fs::metadata(path).ok().map(|data| Self::from(&data))
    }

    /// Returns the time since the file was last written; zero if the system does not provide it.
    pub fn age(&self) -> Duration {
        self.modified.and_then(|modified| SystemTime::now().duration_since(modified).ok()).unwrap_or_default()
    }
}

impl From<&Metadata> for Stamp {
    fn from(data: &Metadata) -> Self {
        Self { modified: data.modified().ok(), length: data.len(), identity: platform::file_identity(data) }
    }
}
