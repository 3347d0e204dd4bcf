//! Keys of the user's own: each does what another key does.

use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};

use crate::terminal::keymap::Chord;

/// What the documentation says of the keys.
pub const ABOUT: &str = "
# Keys of your own: on the left the key that you press, on the right the one whose work it does. Keys that are not named
# keep their work. Accepted: a letter or sign, Enter, Esc, Space, Tab, Backspace, Delete, Home, End, PageUp, PageDown, Left,
# Right, Up, Down, F1 to F12, also with Ctrl- or Shift- before it.
[keys]
# \"x\" = \"Enter\"
";

/// The keys that were given other work.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Keys {
    /// The key that is pressed, and the one whose work it does.
    pairs: Vec<(Chord, Chord)>,
}

impl Keys {
    /// Lets `pressed` do what `meant` does.
    pub fn add(&mut self, pressed: Chord, meant: Chord) {
        self.remove(pressed);
        self.pairs.push((pressed, meant));
        // In whatever order they were given: a file that is read again gives them by name.
        self.pairs.sort_by_key(|(pressed, _)| name(*pressed));
    }

    /// What is meant by a key that was pressed.
    pub fn translate(&self, event: &KeyEvent) -> KeyEvent {
        let meant = self.pairs.iter().find(|(pressed, _)| pressed.matches(event)).map(|(_, meant)| *meant);
        meant.map_or(*event, |meant| KeyEvent { kind: event.kind, ..meant.event() })
    }

    /// Gives `pressed` back the work that it has by default.
    pub fn remove(&mut self, pressed: Chord) {
        self.pairs.retain(|(known, _)| *known != pressed);
    }

    /// The key that was given to `pressed` to do its work, if one was.
    pub fn meant_by(&self, pressed: Chord) -> Option<Chord> {
        self.pairs.iter().find(|(known, _)| *known == pressed).map(|(_, meant)| *meant)
    }

    /// Those that do not do what they do by default and have to do with `chords`: they do the work of one of these, or are
    /// one of these and do other work.
    pub fn about(&self, chords: &[Chord]) -> Vec<Chord> {
        let is_about = |(pressed, meant): &&(Chord, Chord)| chords.contains(pressed) || chords.contains(meant);
        self.pairs.iter().filter(is_about).map(|(pressed, _)| *pressed).collect()
    }

    /// The keys that do the work of `meant`, the user's own first.
    pub fn keys_for(&self, meant: Chord) -> impl Iterator<Item = Chord> {
        let own = self.pairs.iter().filter(move |(_, work)| *work == meant).map(|(pressed, _)| *pressed);
        let kept = self.pairs.iter().all(|(pressed, _)| *pressed != meant).then_some(meant);
        own.chain(kept)
    }

    /// The lines of the file.
    pub fn document(&self) -> String {
        let quoted = |chord: &Chord| toml::Value::String(name(*chord)).to_string();
        let line = |(pressed, meant): &(Chord, Chord)| format!("{} = {}\n", quoted(pressed), quoted(meant));
        self.pairs.iter().map(line).collect::<Vec<_>>().concat()
    }
}

/// The keys with names.
const NAMES: [(&str, KeyCode); 14] = [
    ("Space", KeyCode::Char(' ')),
    ("Enter", KeyCode::Enter),
    ("Esc", KeyCode::Esc),
    ("Tab", KeyCode::Tab),
    ("Backspace", KeyCode::Backspace),
    ("Delete", KeyCode::Delete),
    ("Home", KeyCode::Home),
    ("End", KeyCode::End),
    ("PageUp", KeyCode::PageUp),
    ("PageDown", KeyCode::PageDown),
    ("Left", KeyCode::Left),
    ("Right", KeyCode::Right),
    ("Up", KeyCode::Up),
    ("Down", KeyCode::Down),
];

/// The key that is written so; capitals of names do not matter.
pub fn chord(text: &str) -> Option<Chord> {
    let (modifiers, rest) = match text.split_once('-') {
        Some((prefix, rest)) if prefix.eq_ignore_ascii_case("ctrl") && !rest.is_empty() => {
            (KeyModifiers::CONTROL, rest)
        }
        Some((prefix, rest)) if prefix.eq_ignore_ascii_case("shift") && !rest.is_empty() => (KeyModifiers::SHIFT, rest),
        _ => (KeyModifiers::NONE, text),
    };
    let mut letters = rest.chars();
    let code = match (letters.next(), letters.as_str()) {
        (Some(letter), "") => KeyCode::Char(letter),
        (Some('f' | 'F'), number) if number.parse::<u8>().is_ok_and(|n| (1..=12).contains(&n)) => {
            KeyCode::F(number.parse().ok()?)
        }
        _ => NAMES.iter().find(|(name, _)| name.eq_ignore_ascii_case(rest)).map(|(_, code)| *code)?,
    };
    Some(match (code, modifiers) {
        (KeyCode::Tab, KeyModifiers::SHIFT) => Chord::plain(KeyCode::BackTab),
        (KeyCode::Char(letter), KeyModifiers::SHIFT) => Chord::char(capital(letter)),
        (code, KeyModifiers::SHIFT) => Chord::shift(code),
        (code, KeyModifiers::CONTROL) => Chord::ctrl(code),
        (code, _) => Chord::plain(code),
    })
}

/// What Shift makes of a letter, where its capital is one letter; what it makes of a sign depends on the keyboard.
fn capital(letter: char) -> char {
    let mut capitals = letter.to_uppercase();
    match (capitals.next(), capitals.next()) {
        (Some(capital), None) => capital,
        _ => letter,
    }
}

/// How a key is written in the file.
pub fn name(chord: Chord) -> String {
    let code = match chord.event().code {
        KeyCode::BackTab => return "Shift-Tab".to_owned(),
        code => match NAMES.iter().find(|(_, known)| *known == code) {
            Some((name, _)) => (*name).to_owned(),
            None => code.to_string(),
        },
    };
    format!("{}{code}", chord.prefix())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_read_as_they_are_written() {
        for text in ["x", "X", "-", "Ctrl-r", "Ctrl--", "Shift-Left", "Shift-Tab", "F12", "Space", "PageUp", "ä"] {
            assert_eq!(name(chord(text).unwrap()), text);
        }
        // Of a letter without a capital of one letter it makes nothing that is known here.
        for (written, letter) in [("shift-x", "X"), ("shift-\u{e4}", "\u{c4}"), ("shift-\u{df}", "\u{df}")] {
            assert_eq!(chord(written), chord(letter));
        }
        for text in ["", "F13", "F0", "Hyper-x", "Ctrl-", "xy"] {
            assert_eq!(chord(text), None, "{text}");
        }
    }

    #[test]
    fn a_key_does_anothers_work_and_gives_up_its_own() {
        let mut keys = Keys::default();
        let [x, enter] = ["x", "Enter"].map(|text| chord(text).unwrap());
        keys.add(x, enter);
        assert!(enter.matches(&keys.translate(&x.event())));
        assert!(enter.matches(&keys.translate(&enter.event())));
        assert_eq!(keys.keys_for(enter).collect::<Vec<_>>(), [x, enter]);
        assert_eq!(keys.keys_for(x).count(), 0);
    }
}
