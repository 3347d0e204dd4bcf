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
    /// What the last session left, which stays there until this one ends; what cannot be read is nothing.
    pub fn read(path: &Path) -> Option<Self> {
        serde_json::from_slice(&storage::read(path, storage::SMALL).ok()?).ok()
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
