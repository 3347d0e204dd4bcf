//! A notice that is shown once to users who have saved things with an older version.

use std::{fs, path::Path};

use serde::{Deserialize, de::IgnoredAny};

use super::{PRACTICE, Places, SMALL, read, read_text, write_atomic};

/// Said where something was saved while "match" meant another table.
const MATCH: &str = "\"match\" is now a table as filmed balls show it, and what you saved for \"match\" is played on it; the former one is \"textbook\"";

/// How the file remembers that [`MATCH`] was said.
const MATCH_TOLD: &str = "match";

/// The notice to this user, if they have saved anything with an older version; from then on `None`. Where
/// that cannot be written down, it is said again. Settings alone tell nothing: they may be a newcomer's first step.
pub fn notice(places: &Places) -> Option<&'static str> {
    let told = read_text(&places.notices, SMALL).unwrap_or_default();
    if told.lines().any(|line| line == MATCH_TOLD) {
        return None;
    }
    let Places { sessions, positions, last, .. } = places;
    // What the last session left is beside this notice: no version since has written one without the other.
    let has_saved = holds_older(sessions) || holds_older(positions) || last.exists();
    let folder = places.notices.parent();
    folder.map(fs::create_dir_all);
    // Where it fails, the sentence comes again: better twice than never.
    if write_atomic(&places.notices, format!("{told}{MATCH_TOLD}\n").as_bytes()).is_err() {
        folder.map(fs::remove_dir);
    }
    has_saved.then_some(MATCH)
}

/// Whether a file of practice in the folder was written before "match" meant its present table: since then files say by which
/// version of carom they were written.
fn holds_older(folder: &Path) -> bool {
    #[derive(Deserialize)]
    struct Header {
        carom: Option<IgnoredAny>,
    }
    let is_older = |path: &Path| {
        let bytes = read(path, PRACTICE).unwrap_or_default();
        // What cannot be read is told elsewhere.
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
