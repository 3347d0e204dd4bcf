//! A partly typed stroke of a calibration, saved when the program ends and restored at the next start.

use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::{calibration::Entry, storage};

/// The saved form.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StrokeDraft {
    /// Name of the test.
    pub test: String,
    /// Typed text of each mark, in the order of the form.
    pub typed: Vec<String>,
    /// Index of the mark that was typed last.
    pub field: usize,
    /// Whether the stroke was played from the far end.
    pub far_end: bool,
    /// The entry that the stroke replaces, with its index among all entries.
    pub amends: Option<(usize, Entry)>,
    /// Whether the stroke belongs to a daily check.
    pub is_daily: bool,
    /// Whether the program has already announced this draft at a start.
    #[serde(default, rename = "is_told")]
    pub is_announced: bool,
}

impl StrokeDraft {
    /// Reads the draft of the last session, if any; the file stays until this session ends.
    ///
    /// # Errors
    /// The message about a file that cannot be read, which is set aside.
    pub fn load_or_rename_unreadable(path: &Path) -> Result<Option<Self>, String> {
        let read = storage::read_if_exists(path, storage::MAX_SMALL_FILE).map_err(|error| error.to_string());
        let draft = read.and_then(|bytes| {
            let draft = bytes.map(|bytes| serde_json::from_slice(&bytes)).transpose();
            draft.map_err(|error| format!("it is damaged: {error}"))
        });
        draft.map_err(|error| {
            let kept = storage::rename_unreadable(path);
            format!("{}: {error}; the stroke that was typed in part cannot be restored, and {kept}", path.display())
        })
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn a_damaged_draft_is_renamed_and_reported_once() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("draft.json");
        assert_eq!(StrokeDraft::load_or_rename_unreadable(&path), Ok(None));
        fs::write(&path, "{").unwrap();
        let said = StrokeDraft::load_or_rename_unreadable(&path).unwrap_err();
        assert!(said.contains("draft.json: it is damaged") && said.contains("draft.unread.json"), "{said}");
        assert_eq!(fs::read(path.with_extension("unread.json")).unwrap(), b"{");
        assert_eq!(StrokeDraft::load_or_rename_unreadable(&path), Ok(None));
        fs::write(&path, "[").unwrap();
        let said = StrokeDraft::load_or_rename_unreadable(&path).unwrap_err();
        assert!(said.contains("draft.unread-2.json"), "{said}");
        assert_eq!(fs::read(path.with_extension("unread.json")).unwrap(), b"{", "the first is still kept");
    }
}
