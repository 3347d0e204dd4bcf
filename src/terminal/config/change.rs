//! Changing one thing in the text of the file: comments, order, and all that is not understood stay as they are.

use toml_edit::{DocumentMut, Item, Table, TomlError, Value};

use crate::terminal::{
    config::read::{KEYS, line_at},
    keymap::{
        Chord,
        remap::{chord, name},
    },
};

/// What a file begins with that the program has made.
const FIRST_LINE: &str = "# The settings of carom; \"carom config\" prints all that may stand here.\n";

/// Something that is to stand in the file otherwise.
#[derive(Clone, Debug, PartialEq)]
pub enum Change {
    /// A setting gets this value, as TOML writes it.
    Value(&'static str, String),
    /// A setting goes back to its default, which is this value; where the file does not have it, nothing happens.
    Default(&'static str, String),
    /// These keys do no other's work any more; then, where there is a pair, its first does the work of its second.
    Keys(Vec<Chord>, Option<(Chord, Chord)>),
}

/// Why the text is not changed.
#[derive(Debug, thiserror::Error, PartialEq)]
pub enum Unchanged {
    /// The text is no TOML.
    #[error("line {line}: {text}")]
    Damaged {
        /// The first line that is wrong, counted from 1.
        line: usize,
        /// What is wrong.
        text: String,
    },
    /// Something else stands where the value or the table should.
    #[error("\"{0}\" is something else there; carom config --check says more")]
    Misplaced(String),
}

/// `text` with the change; `None` stands for a file that is not there yet.
///
/// # Errors
/// [`Unchanged`]: the text stays as it is.
pub fn changed(text: Option<&str>, change: &Change) -> Result<String, Unchanged> {
    let text = text.unwrap_or(FIRST_LINE);
    let document: DocumentMut = text.parse().map_err(|error| damaged(text, &error))?;
    let new = if document.is_empty() && !text.is_empty() {
        // Comments alone stay at the head of the file.
        let end = if text.ends_with('\n') { "" } else { "\n" };
        format!("{text}{end}{}", edited(DocumentMut::new(), text, change)?)
    } else {
        edited(document, text, change)?
    };
    let new = new.replace("\r\n", "\n");
    // A file whose lines end as on Windows stays one; the library writes them all alike.
    let is_windows = text.contains('\n') && text.matches("\r\n").count() == text.matches('\n').count();
    Ok(if is_windows { new.replace('\n', "\r\n") } else { new })
}

/// Whether the program can change this text.
pub fn is_changeable(text: &str) -> bool {
    text.parse::<DocumentMut>().is_ok()
}

/// The text of `document`, which was read from `text`, with the change.
fn edited(mut document: DocumentMut, text: &str, change: &Change) -> Result<String, Unchanged> {
    match change {
        Change::Default(key, _) if !document.contains_key(key) => {}
        Change::Value(key, value) | Change::Default(key, value) => put(document.as_table_mut(), key, value, text)?,
        Change::Keys(gone, added) => {
            let is_gone = |written: &str| chord(written).is_some_and(|known| gone.contains(&known));
            if added.is_none() && !document.contains_key(KEYS) {
                return Ok(document.to_string());
            }
            let keys = document.as_table_mut().entry(KEYS).or_insert_with(|| Item::Table(Table::new()));
            let keys = keys.as_table_like_mut().ok_or_else(|| Unchanged::Misplaced(KEYS.to_owned()))?;
            let written: Vec<String> = keys.iter().map(|(key, _)| key.to_owned()).filter(|key| is_gone(key)).collect();
            for key in &written {
                keys.remove(key);
            }
            if let Some((pressed, meant)) = added {
                keys.insert(&name(*pressed), Item::Value(name(*meant).into()));
            }
        }
    }
    Ok(document.to_string())
}

/// Puts the value of `key` in place of the one that is there, with the comment behind it, or after all others.
fn put(table: &mut Table, key: &str, value: &str, text: &str) -> Result<(), Unchanged> {
    let mut value: Value = value.parse().map_err(|error| damaged(text, &error))?;
    match table.get_mut(key) {
        None => {
            table.insert(key, Item::Value(value));
        }
        Some(Item::Value(known)) => {
            value.decor_mut().clone_from(known.decor());
            *known = value;
        }
        Some(_) => return Err(Unchanged::Misplaced(key.to_owned())),
    }
    Ok(())
}

fn damaged(text: &str, error: &TomlError) -> Unchanged {
    let line = error.span().map_or(1, |span| line_at(text, span.start));
    Unchanged::Damaged { line, text: error.message().to_owned() }
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
    fn a_new_value_stands_before_the_tables_and_is_read_back() {
        let new = changed(Some(FILE), &Change::Value("speed", "2.0".to_owned())).unwrap();
        assert_eq!(read(&new).0.speed, 2.0, "{new}");
        assert_eq!(new.replace("speed = 2.0\n", ""), FILE);
        let first = changed(None, &Change::Value("mouse", "false".to_owned())).unwrap();
        assert!(first.starts_with(FIRST_LINE) && !read(&first).0.mouse, "{first}");
        let commented = changed(Some("# only this\n[keys]\nx = \"u\"\n"), &Change::Value("plan", "false".to_owned()));
        let (settings, complaints) = read(&commented.unwrap());
        assert!(!settings.plan && settings.keys.meant_by(key("x")) == Some(key("u")) && complaints.is_empty());
    }

    #[test]
    fn keys_come_and_go_however_they_are_written() {
        let change = Change::Keys(vec![key("X")], Some((key("Ctrl-a"), key("\""))));
        let new = changed(Some(FILE), &change).unwrap();
        let keys = read(&new).0.keys;
        assert_eq!((keys.meant_by(key("X")), keys.meant_by(key("Ctrl-a"))), (None, Some(key("\""))), "{new}");
        assert!(new.contains("[else]\ny = 1") && new.contains("# for the terrace"), "{new}");
        let gone = changed(Some(&new), &Change::Keys(vec![key("Ctrl-a")], None)).unwrap();
        assert_eq!(read(&gone).0.keys, super::super::Keys::default(), "{gone}");
        assert_eq!(changed(Some("a = 1\n"), &Change::Keys(vec![key("x")], None)).unwrap(), "a = 1\n");
    }

    #[test]
    fn what_is_damaged_or_something_else_is_named_and_not_changed() {
        let theme = Change::Value("theme", "\"dark\"".to_owned());
        let damaged = changed(Some("\u{20ac} = 1\n"), &theme).unwrap_err();
        assert!(matches!(damaged, Unchanged::Damaged { line: 1, .. }), "{damaged:?}");
        let twice = changed(Some("plan = true\nplan = true\n"), &theme).unwrap_err();
        assert!(matches!(twice, Unchanged::Damaged { line: 2, .. }), "{twice:?}");
        assert_eq!(changed(Some("[theme]\na = 1\n"), &theme), Err(Unchanged::Misplaced("theme".to_owned())));
        let keys = Change::Keys(Vec::new(), Some((key("x"), key("u"))));
        assert_eq!(changed(Some("keys = 3\n"), &keys), Err(Unchanged::Misplaced(KEYS.to_owned())));
    }
}
