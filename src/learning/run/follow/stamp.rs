//! Whether a file has changed, found without reading it.

use std::{
    fs::Metadata,
    path::Path,
    time::{Duration, SystemTime},
};

use crate::platform;

/// What tells one state of a file from the next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stamp {
    modified: Option<SystemTime>,
    /// Bytes of the file.
    pub length: u64,
    identity: u64,
}

impl Stamp {
    /// That of the file at `path`; none where there is no file.
    pub fn of(path: &Path) -> Option<Self> {
        std::fs::metadata(path).ok().map(|data| Self::from(&data))
    }

    /// How long ago the file was written last; nothing where the system does not tell.
    pub fn age(&self) -> Duration {
        self.modified.and_then(|modified| SystemTime::now().duration_since(modified).ok()).unwrap_or_default()
    }
}

impl From<&Metadata> for Stamp {
    fn from(data: &Metadata) -> Self {
        Self { modified: data.modified().ok(), length: data.len(), identity: platform::file_identity(data) }
    }
}
