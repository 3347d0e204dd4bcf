//! A one-time notice for users who saved data with an older version.

use std::{fs, path::Path};

use serde::{Deserialize, de::IgnoredAny};

use super::{DataPaths, MAX_PRACTICE_FILE, MAX_SMALL_FILE, read, read_text, write_atomic};

/// Shown to users who saved data while "match" meant another table.
const MATCH_NOTICE: &str = "\"match\" is now a table with constants from filmed shots, and what you saved for \"match\" is played on it; the former one is \"textbook\"";

/// The line in the record of notices which states that [`MATCH_NOTICE`] was shown.
const MATCH_NOTICE_ID: &str = "match";

/// Returns the notice if this user has saved data with an older version, and `None` on later calls. If that cannot be recorded, the notice
/// is repeated. A settings file alone does not count: changing a setting may be a new user's first step.
pub fn notice(paths: &DataPaths) -> Option<&'static str> {
    let shown = read_text(&paths.notices, MAX_SMALL_FILE).unwrap_or_default();
    if shown.lines().any(|line| line == MATCH_NOTICE_ID) {
        return None;
    }
    let DataPaths { sessions, positions, last_session, .. } = paths;
    // Any later version that wrote the last session's state also wrote this record of notices.
    let has_saved = contains_older_files(sessions) || contains_older_files(positions) || last_session.exists();
    let folder = paths.notices.parent();
    folder.map(fs::create_dir_all);
    // If writing fails, the notice is repeated next time.
    if write_atomic(&paths.notices, format!("{shown}{MATCH_NOTICE_ID}\n").as_bytes()).is_err() {
        folder.map(fs::remove_dir);
    }
    has_saved.then_some(MATCH_NOTICE)
}

/// Whether the folder contains a practice file from before "match" changed its meaning: later files record the version of carom that wrote
/// them.
fn contains_older_files(folder: &Path) -> bool {
    #[derive(Deserialize)]
    struct Header {
        carom: Option<IgnoredAny>,
    }
    let is_older = |path: &Path| {
        let bytes = read(path, MAX_PRACTICE_FILE).unwrap_or_default();
        // Unreadable files are reported elsewhere.
        serde_json::from_slice::<Header>(&bytes).is_ok_and(|header| header.carom.is_none())
    };
    let mut files = fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    files.any(|path| path.extension().is_some_and(|extension| extension == "json") && is_older(&path))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_users_with_older_data_get_one_notice() {
        let folder = tempfile::tempdir().unwrap();
        let files = [
            ("new", "", false),
            ("old", r#"{"format":"carom-session","version":1}"#, true),
            ("present", r#"{"format":"carom-session","version":1,"carom":"0.1.0"}"#, false),
        ];
        for (who, file, is_told) in files {
            let paths = DataPaths::under(&folder.path().join(who));
            if !file.is_empty() {
                fs::create_dir_all(&paths.sessions).unwrap();
                assert!(!paths.notices.exists());
                fs::write(paths.sessions.join("one.json"), file).unwrap();
                fs::write(paths.sessions.join("lock"), "").unwrap();
            }
            assert_eq!(notice(&paths).is_some(), is_told, "{who}");
            assert_eq!(notice(&paths), None);
        }
    }
}
