//! A one-time notice for users who saved data with an older version.

use std::{fs, path::Path};

use serde::{Deserialize, de::IgnoredAny};

use super::{PRACTICE, Places, SMALL, read, read_text, write_atomic};

/// Shown to users who saved data while "match" meant another table.
const MATCH: &str = "\"match\" is now a table with constants from filmed shots, and what you saved for \"match\" is played on it; the former one is \"textbook\"";

/// The line in the record of notices which states that [`MATCH`] was shown.
const MATCH_SHOWN: &str = "match";

/// Returns the notice if this user has saved data with an older version, and `None` on later calls. If that cannot be recorded, the notice
/// is repeated. A settings file alone does not count: changing a setting may be a new user's first step.
pub fn notice(places: &Places) -> Option<&'static str> {
    let shown = read_text(&places.notices, SMALL).unwrap_or_default();
    if shown.lines().any(|line| line == MATCH_SHOWN) {
        return None;
    }
    let Places { sessions, positions, last, .. } = places;
    // Any later version that wrote the last session's state also wrote this record of notices.
    let has_saved = holds_older(sessions) || holds_older(positions) || last.exists();
    let folder = places.notices.parent();
    folder.map(fs::create_dir_all);
    // If writing fails, the notice is repeated next time.
    if write_atomic(&places.notices, format!("{shown}{MATCH_SHOWN}\n").as_bytes()).is_err() {
        folder.map(fs::remove_dir);
    }
    has_saved.then_some(MATCH)
}

/// Whether the folder contains a practice file from before "match" changed its meaning: later files record the version of carom that wrote
/// them.
fn holds_older(folder: &Path) -> bool {
    #[derive(Deserialize)]
    struct Header {
        carom: Option<IgnoredAny>,
    }
    let is_older = |path: &Path| {
        let bytes = read(path, PRACTICE).unwrap_or_default();
        // Unreadable files are reported elsewhere.
        serde_json::from_slice::<Header>(&bytes).is_ok_and(|header| header.carom.is_none())
    };
    let mut paths = fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    paths.any(|path| path.extension().is_some_and(|extension| extension == "json") && is_older(&path))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn who_has_saved_something_with_an_older_version_is_told_once_and_others_never() {
        let folder = tempfile::tempdir().unwrap();
        let files = [
            ("new", "", false),
            ("old", r#"{"format":"carom-session","version":1}"#, true),
            ("present", r#"{"format":"carom-session","version":1,"carom":"0.1.0"}"#, false),
        ];
        for (who, file, is_told) in files {
            let places = Places::under(&folder.path().join(who));
            if !file.is_empty() {
                fs::create_dir_all(&places.sessions).unwrap();
                assert!(!places.notices.exists());
                fs::write(places.sessions.join("one.json"), file).unwrap();
                fs::write(places.sessions.join("lock"), "").unwrap();
            }
            assert_eq!(notice(&places).is_some(), is_told, "{who}");
            assert_eq!(notice(&places), None);
        }
    }
}
