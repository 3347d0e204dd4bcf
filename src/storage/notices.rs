//! A notice that is shown once to users who have saved things with an older version.

use std::{fs, path::Path};

use super::{Places, SMALL, read_text, write_atomic};

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
    let holds_any = |folder: &Path| fs::read_dir(folder).is_ok_and(|mut entries| entries.next().is_some());
    let has_saved = holds_any(sessions) || holds_any(positions) || last.exists();
    let folder = places.notices.parent();
    folder.map(fs::create_dir_all);
    // Where it fails, the sentence comes again: better twice than never.
    if write_atomic(&places.notices, format!("{told}{MATCH_TOLD}\n").as_bytes()).is_err() {
        folder.map(fs::remove_dir);
    }
    has_saved.then_some(MATCH)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn who_has_saved_something_is_told_once_and_a_newcomer_never() {
        let folder = tempfile::tempdir().unwrap();
        for is_newcomer in [true, false] {
            let places = Places::under(&folder.path().join(if is_newcomer { "new" } else { "old" }));
            if !is_newcomer {
                fs::create_dir_all(&places.sessions).unwrap();
                assert!(!places.notices.exists());
                fs::write(places.sessions.join("one.json"), "{}").unwrap();
            }
            assert_eq!(notice(&places).is_some(), !is_newcomer);
            assert_eq!(notice(&places), None);
        }
    }
}
