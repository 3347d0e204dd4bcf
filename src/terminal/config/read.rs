//! Parses the settings file: every correct key is used, every mistake is reported with its line and what would be accepted.

use std::{fmt, io, path::Path};

use crossterm::event::KeyCode;
use toml::{
    Spanned,
    de::{DeTable, DeValue},
};

use crate::{
    storage::in_plain_words,
    terminal::{
        Settings,
        config::entries::{ENTRIES, Entry},
        keymap::{Chord, remap::chord},
    },
};

/// Name of the section with the keys.
pub const KEYS: &str = "keys";

/// Name of the setting whose value may be a file, which may itself contain mistakes.
const TABLE: &str = "table";

/// Number of syntax errors after which the file is given up, since each costs another pass over it.
const MAX_MISTAKES: usize = 50;

/// A mistake in the file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mistake {
    /// The line, counted from 1; `None` if the whole file cannot be read.
    pub line: Option<usize>,
    /// What is wrong, and what would be accepted.
    pub text: String,
}

impl Mistake {
    /// The mistake that the file cannot be read.
    pub fn of_file(error: &io::Error) -> Self {
        Self { line: None, text: format!("it cannot be read: {error}; the defaults are used") }
    }

    /// One sentence for each mistake in the file at `path`.
    pub fn sentences(path: &Path, mistakes: &[Self]) -> Vec<String> {
        mistakes.iter().map(|mistake| format!("{}: {mistake}", path.display())).collect()
    }
}

impl fmt::Display for Mistake {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(line) = self.line {
            write!(formatter, "line {line}: ")?;
        }
        formatter.write_str(&self.text)
    }
}

/// Parses the settings in `text`, with defaults for what is missing or wrong.
pub fn read(text: &str) -> (Settings, Vec<Mistake>) {
    let mut settings = Settings::default();
    let (text, mut mistakes) = without_mistakes(text);
    let text = text.as_str();
    let line = |start: usize| Some(line_at(text, start));
    let table = DeTable::parse_recoverable(text).0;
    for (key, value) in table.get_ref() {
        let mut add = |text| mistakes.push(Mistake { line: line(key.span().start), text });
        let name = key.get_ref().as_ref();
        if name == KEYS {
            match value.get_ref().as_table() {
                Some(keys) => read_keys(&mut settings, keys, |at, text| {
                    mistakes.push(Mistake { line: line(at), text });
                }),
                None => {
                    add("keys is not a section; write [keys] and below it lines like \"x\" = \"Enter\"".to_owned());
                }
            }
        } else if let Some(entry) = ENTRIES.iter().find(|entry| entry.key == name) {
            if (entry.set)(&mut settings, value.get_ref()).is_none() {
                let (given, default) = (shown(text, value), (entry.get)(&Settings::default()));
                add(format!("{name} = {given}; accepted is {}. It is taken as {default}", entry.accepted));
            } else if name == TABLE
                && let Err(sentence) = settings.table()
            {
                settings.table = Settings::default().table;
                add(format!("{sentence}. The table is taken as \"{}\"", settings.table));
            }
        } else {
            let known: Vec<&str> = ENTRIES.iter().map(|entry| entry.key).chain([KEYS]).collect();
            add(format!("there is no setting \"{name}\"; there are {}", known.join(", ")));
        }
    }
    mistakes.sort_by_key(|mistake| mistake.line);
    (settings, mistakes)
}

/// Replaces each line that is not valid TOML by blanks, and lists the mistakes. Otherwise one broken line would make the parser drop all
/// lines after it.
fn without_mistakes(text: &str) -> (String, Vec<Mistake>) {
    let (mut text, mut mistakes) = (text.to_owned(), Vec::new());
    loop {
        let errors = DeTable::parse_recoverable(&text).1;
        let Some(error) = errors.first() else { return (text, mistakes) };
        let place = error.span().map_or(0, |span| span.start).min(text.len());
        let number = line_at(&text, place);
        let start = text.as_bytes()[..place].iter().rposition(|byte| *byte == b'\n').map_or(0, |newline| newline + 1);
        let end = text[start..].find('\n').map_or(text.len(), |length| start + length);
        let written = text[start..end].trim().to_owned();
        let reason = in_plain_words(error.message());
        let text_of = |what: &str| {
            format!("{what} is not taken: {reason}; accepted are lines like name = value, with words in quotes")
        };
        if written.is_empty() || mistakes.len() == MAX_MISTAKES {
            // Something above is not closed, or the file is not a settings file.
            mistakes.push(Mistake { line: Some(number), text: text_of("the file") });
            return (String::new(), mistakes);
        }
        mistakes.push(Mistake { line: Some(number), text: text_of(&written) });
        text.replace_range(start..end, &" ".repeat(end - start));
    }
}

/// Sets `entry` to `value`, given in TOML; `None` if it is invalid or not accepted.
pub fn apply_value(settings: &mut Settings, entry: &Entry, value: &str) -> Option<()> {
    let text = format!("value = {value}");
    let table = DeTable::parse(&text).ok()?;
    let mut values = table.get_ref().values();
    // Exactly one value, without further lines.
    let value = values.next().filter(|_| values.next().is_none())?;
    (entry.set)(settings, value.get_ref())
}

/// Line number of the byte at `place`, counted from 1. The offset may be inside a multi-byte character.
pub fn line_at(text: &str, place: usize) -> usize {
    text.bytes().take(place).filter(|byte| *byte == b'\n').count() + 1
}

/// Reads the section of keys; `add` receives the byte offset of each mistake.
fn read_keys(settings: &mut Settings, keys: &DeTable, mut add: impl FnMut(usize, String)) {
    for (key, value) in keys {
        let place = key.span().start;
        let written = key.get_ref().as_ref();
        let Some(pressed) = chord(written) else {
            add(place, refused(written));
            continue;
        };
        if pressed == Chord::ctrl(KeyCode::Char('c')) {
            add(place, format!("\"{written}\" always quits; give another key its meaning"));
            continue;
        }
        match value.get_ref().as_str() {
            Some(text) => match chord(text) {
                Some(meant) => settings.keys.add(pressed, meant),
                None => add(place, refused(text)),
            },
            None => add(place, format!("\"{written}\" needs the name of another key in quotes, like \"Enter\"")),
        }
    }
}

fn refused(text: &str) -> String {
    format!(
        "\"{text}\" is not a key; use a letter or sign, Enter, Esc, Space, Tab, Left, F1, ... also with Ctrl- or Shift-"
    )
}

/// The value as written in the file.
fn shown(text: &str, value: &Spanned<DeValue>) -> String {
    text.get(value.span()).unwrap_or_default().lines().next().unwrap_or_default().to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{coach::Skill, game::Rule, table::Table, terminal::ThemeName};

    #[test]
    fn the_documentation_parses_as_settings_and_changes_nothing() {
        let mut settings = Settings { theme: ThemeName::Light, rule: Rule::ThreeCushion, ..Settings::default() };
        settings.skill = "a=0.7,b=0.7,theta=0.2,phi=0.2,V=0.1".parse().unwrap();
        settings.keys.add(chord("x").unwrap(), chord("Ctrl-r").unwrap());
        assert_eq!(read(&settings.document()), (settings, Vec::new()));
        let defaults = Settings::default();
        assert_eq!(read(&defaults.document()), (defaults.clone(), Vec::new()));
        assert_eq!(read(""), (defaults, Vec::new()));
    }

    #[test]
    fn every_wrong_line_is_reported_and_the_others_apply() {
        let text = "theme = \"light\"\nspeed = 9.5\nskill = 3\n\ntempo = 1\nthink_ms = 0.5\n[keys]\n\"Hyper-x\" = \"Enter\"\n\"x\" = \"Enter\"\n";
        let (settings, mistakes) = read(text);
        assert_eq!((settings.theme, settings.speed, settings.skill), (ThemeName::Light, 1.0, Skill::EXPERT));
        assert_ne!(settings.keys, Settings::default().keys);
        let said: Vec<String> = mistakes.iter().map(ToString::to_string).collect();
        assert_eq!(mistakes.iter().map(|mistake| mistake.line).collect::<Vec<_>>(), [2, 3, 5, 6, 8].map(Some));
        assert!(said[0].contains("speed = 9.5") && said[0].contains("4 or 8"), "{said:?}");
        assert!(said[2].contains("tempo") && said[2].contains("think_ms"), "{said:?}");
        assert!(said[4].contains("Hyper-x"), "{said:?}");
    }

    #[test]
    fn line_numbers_are_right_after_multibyte_letters() {
        for text in ["#\u{20ac}\ntheme = \u{201c}dark\u{201d}\n", "rule = \"\u{fc}\"\n\u{fc} = 1\n", "x = '\u{1f3b1}\n"]
        {
            assert!(!read(text).1.is_empty(), "{text}");
        }
        let euro = "\n\u{20ac}\n";
        assert_eq!([1, 2, 3, 4, 5, 99].map(|place| line_at(euro, place)), [2, 2, 2, 2, 3, 3]);
    }

    #[test]
    fn a_wrong_table_file_is_reported_and_the_default_table_used() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("mine.toml");
        let text = toml::to_string(&Table::default()).unwrap().replacen("mu_s = ", "mu_s = -", 1);
        std::fs::write(&path, text).unwrap();
        let (settings, mistakes) = read(&format!("plan = false\ntable = '{}'\n", path.display()));
        assert_eq!((settings.table.as_str(), settings.plan, mistakes.len()), ("match", false, 1));
        let said = mistakes[0].to_string();
        assert!(said.starts_with("line 2") && said.contains("mine.toml") && said.contains("mu_s = -"), "{said}");
    }

    #[test]
    fn a_file_without_settings_is_given_up_soon() {
        let (settings, mistakes) = read(&"no settings at all\n".repeat(50_000));
        assert_eq!((settings, mistakes.len()), (Settings::default(), MAX_MISTAKES + 1));
    }

    #[test]
    fn a_syntax_mistake_costs_only_its_line() {
        for wrong in ["theme = dark light", "theme", "theme: \"light\"", "theme = light", "= 3", "\u{20ac}", "[theme"] {
            let (settings, mistakes) = read(&format!("speed = 2.0\n{wrong}\nrule = \"one-cushion\"\njumps = false\n"));
            assert_eq!((settings.speed, settings.rule, settings.jumps), (2.0, Rule::OneCushion, false), "{wrong}");
            assert_eq!(settings.theme, Settings::default().theme, "{wrong}");
            let [mistake] = &mistakes[..] else { panic!("{wrong}: {mistakes:?}") };
            assert!(mistake.line == Some(2) && mistake.text.contains(wrong), "{mistakes:?}");
        }
    }
}
