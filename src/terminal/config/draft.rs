//! A stroke of a calibration that was typed in part when the program ended, kept for the next start.

use std::{fs, io, path::Path};

use serde::{Deserialize, Serialize};

use crate::{
    calibration::Entry,
    storage::{self, replace},
};

/// What was typed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StrokeDraft {
    /// The name of the test.
    pub test: String,
    /// What is typed of each mark, in the order of the form.
    pub typed: Vec<String>,
    /// The place of the mark that was typed last.
    pub field: usize,
    /// Whether the stroke was played from the far end.
    pub far_end: bool,
    /// The stroke that is changed, with its place among all entries.
    pub amends: Option<(usize, Entry)>,
    /// Whether it is one of a check of the day.
    pub is_daily: bool,
}

impl StrokeDraft {
    /// Takes what the last session left, which is then the screen's to keep; what cannot be read is nothing.
    pub fn take(path: &Path) -> Option<Self> {
        let draft = serde_json::from_slice(&storage::read(path, storage::SMALL).ok()?).ok()?;
        // Where it cannot be removed it comes once more, and is seen then.
        let _ = fs::remove_file(path);
        Some(draft)
    }

    /// Writes it down.
    ///
    /// # Errors
    /// Whatever the file system reports.
    pub fn save(&self, path: &Path) -> io::Result<()> {
        if let Some(folder) = path.parent() {
            fs::create_dir_all(folder)?;
        }
        replace(path, &serde_json::to_vec(self).map_err(io::Error::from)?)
    }
}
