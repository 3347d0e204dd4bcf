//! Changes one entry in the text of the settings file; comments, order and unknown keys stay as they are.

use toml_edit::{DocumentMut, Item, Table, TomlError, Value};

use crate::terminal::{
    config::read::{KEYS, line_at},
    keymap::{
        Chord,
        remap::{chord, name},
    },
};

/// First line of a file that the program creates.
const FIRST_LINE: &str = "# The settings of carom; \"carom config\" prints all of them.\n";

/// A change of the settings file.
#[derive(Clone, Debug, PartialEq)]
pub enum Change {
    /// Sets a setting to this value, in TOML.
    Value(&'static str, String),
    /// Resets a setting to its default, which is this value; does nothing if the file does not contain it.
    Default(&'static str, String),
    /// Removes the bindings of these keys; then, if there is a pair, lets its first key act as its second.
    Keys(Vec<Chord>, Option<(Chord, Chord)>),
}

/// Why the text was not changed.
#[derive(Debug, thiserror::Error, PartialEq)]
pub enum ChangeError {
    /// The text is not valid TOML.
    #[error("line {line}: {text}")]
    Damaged {
        /// The first wrong line, counted from 1.
        line: usize,
        /// Description of the error.
        text: String,
    },
    /// The entry has another kind than the value or table expected there.
    #[error("\"{0}\" has the wrong type in the file; carom config --check says more")]
    Misplaced(String),
}

/// Applies the change to `text`; `None` stands for a file that does not exist yet.
///
/// # Errors
/// [`ChangeError`]: the text stays as it is.
pub fn changed(text: Option<&str>, change: &Change) -> Result<String, ChangeError> {
    let text = text.unwrap_or(FIRST_LINE);
    let document: DocumentMut = text.parse().map_err(|error| damaged(text, &error))?;
    let new = if document.is_empty() && !text.is_empty() {
        // A file with comments only keeps them at its start.
        let end = if text.ends_with('\n') { "" } else { "\n" };
        format!("{text}{end}{}", edited(DocumentMut::new(), text, change)?)
    } else {
        edited(document, text, change)?
    };
    let new = new.replace("\r\n", "\n");
    // Keep Windows line endings; the library writes all line endings alike.
    let is_windows = text.contains('\n') && text.matches("\r\n").count() == text.matches('\n').count();
    Ok(if is_windows { new.replace('\n', "\r\n") } else { new })
}

/// Whether the program can change this text.
pub fn is_changeable(text: &str) -> bool {
    text.parse::<DocumentMut>().is_ok()
}

/// Applies the change to `document`, which was parsed from `text`.
fn edited(mut document: DocumentMut, text: &str, change: &Change) -> Result<String, ChangeError> {
    match change {
        Change::Default(key, _) if !document.contains_key(key) => {}
        Change::Value(key, value) | Change::Default(key, value) => put(document.as_table_mut(), key, value, text)?,
        Change::Keys(gone, added) => {
            let is_gone = |written: &str| chord(written).is_some_and(|known| gone.contains(&known));
            if added.is_none() && !document.contains_key(KEYS) {
                return Ok(document.to_string());
            }
            let keys = document.as_table_mut().entry(KEYS).or_insert_with(|| Item::Table(Table::new()));
            let keys = keys.as_table_like_mut().ok_or_else(|| ChangeError::Misplaced(KEYS.to_owned()))?;
            let written: Vec<String> = keys.iter().map(|(key, _)| key.to_owned()).filter(|key| is_gone(key)).collect();
            for key in &written {
                keys.remove(key);
            }
            if let Some((pressed, target)) = added {
                keys.insert(&name(*pressed), Item::Value(name(*target).into()));
            }
        }
    }
    Ok(document.to_string())
}

/// Replaces the value of `key`, keeping the comment after it, or appends a new one.
fn put(table: &mut Table, key: &str, value: &str, text: &str) -> Result<(), ChangeError> {
    let mut value: Value = value.parse().map_err(|error| damaged(text, &error))?;
    match table.get_mut(key) {
        None => {
            table.insert(key, Item::Value(value));
        }
        Some(Item::Value(known)) => {
            value.decor_mut().clone_from(known.decor());
            *known = value;
        }
        Some(_) => return Err(ChangeError::Misplaced(key.to_owned())),
    }
    Ok(())
}

fn damaged(text: &str, error: &TomlError) -> ChangeError {
    let line = error.span().map_or(1, |span| line_at(text, span.start));
    ChangeError::Damaged { line, text: error.message().to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::terminal::config::read::read;

    const FILE: &str = "# mine\n\ntheme = 'light'   # for the terrace\n# thinking\nthink_ms = 250\nodd = { a = 1 }\n\n[keys]\n# left hand\nshift-x = \"Enter\" # x\n\n[else]\ny = 1\n";

    fn key(text: &str) -> Chord {
        chord(text).unwrap()
    }

    #[test]
    fn one_value_changes_and_nothing_else() {
        let dark = changed(Some(FILE), &Change::Value("theme", "\"dark\"".to_owned())).unwrap();
        assert_eq!(dark, FILE.replace("'light'", "\"dark\""));
        let windows = |text: &str| text.replace('\n', "\r\n");
        let changed_there = changed(Some(&windows(FILE)), &Change::Value("theme", "\"dark\"".to_owned())).unwrap();
        assert_eq!(changed_there, windows(&dark));
        let default = changed(Some(FILE), &Change::Default("think_ms", "1000".to_owned())).unwrap();
        assert_eq!(default, FILE.replace("250", "1000"));
        assert_eq!(changed(Some(FILE), &Change::Default("speed", "1.0".to_owned())).unwrap(), FILE);
    }

    #[test]
    fn a_new_value_is_written_before_the_tables_and_read_back() {
        let new = changed(Some(FILE), &Change::Value("speed", "2.0".to_owned())).unwrap();
        assert_eq!(read(&new).0.speed, 2.0, "{new}");
        assert_eq!(new.replace("speed = 2.0\n", ""), FILE);
        let first = changed(None, &Change::Value("mouse", "false".to_owned())).unwrap();
        assert!(first.starts_with(FIRST_LINE) && !read(&first).0.mouse, "{first}");
        let commented = changed(Some("# only this\n[keys]\nx = \"u\"\n"), &Change::Value("plan", "false".to_owned()));
        let (settings, mistakes) = read(&commented.unwrap());
        assert!(!settings.plan && settings.keys.target_of(key("x")) == Some(key("u")) && mistakes.is_empty());
    }

    #[test]
    fn key_bindings_are_added_and_removed_in_any_spelling() {
        let change = Change::Keys(vec![key("X")], Some((key("Ctrl-a"), key("\""))));
        let new = changed(Some(FILE), &change).unwrap();
        let keys = read(&new).0.keys;
        assert_eq!((keys.target_of(key("X")), keys.target_of(key("Ctrl-a"))), (None, Some(key("\""))), "{new}");
        assert!(new.contains("[else]\ny = 1") && new.contains("# for the terrace"), "{new}");
        let gone = changed(Some(&new), &Change::Keys(vec![key("Ctrl-a")], None)).unwrap();
        assert_eq!(read(&gone).0.keys, super::super::Keys::default(), "{gone}");
        assert_eq!(changed(Some("a = 1\n"), &Change::Keys(vec![key("x")], None)).unwrap(), "a = 1\n");
    }

    #[test]
    fn damaged_or_misplaced_settings_are_reported_and_not_changed() {
        let theme = Change::Value("theme", "\"dark\"".to_owned());
        let damaged = changed(Some("\u{20ac} = 1\n"), &theme).unwrap_err();
        assert!(matches!(damaged, ChangeError::Damaged { line: 1, .. }), "{damaged:?}");
        let twice = changed(Some("plan = true\nplan = true\n"), &theme).unwrap_err();
        assert!(matches!(twice, ChangeError::Damaged { line: 2, .. }), "{twice:?}");
        assert_eq!(changed(Some("[theme]\na = 1\n"), &theme), Err(ChangeError::Misplaced("theme".to_owned())));
        let keys = Change::Keys(Vec::new(), Some((key("x"), key("u"))));
        assert_eq!(changed(Some("keys = 3\n"), &keys), Err(ChangeError::Misplaced(KEYS.to_owned())));
    }
}
