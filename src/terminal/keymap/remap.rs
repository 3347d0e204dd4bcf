//! User-defined keys: each acts as another key.

use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};

use crate::terminal::keymap::Chord;

/// The section on keys in the documented settings file.
pub const ABOUT: &str = "
# Keys of your own: on the left the key that you press, on the right the key that it acts as. All other keys keep their
# defaults. Accepted: a letter or sign, Enter, Esc, Space, Tab, Backspace, Delete, Home, End, PageUp, PageDown, Left,
# Right, Up, Down, F1 to F12, also with Ctrl- or Shift- before it.
[keys]
# \"x\" = \"Enter\"
";

/// User-defined key bindings.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Keys {
    /// The pressed key, and the key that it acts as.
    pairs: Vec<(Chord, Chord)>,
}

impl Keys {
    /// Binds `pressed` to act as `target`.
    pub fn add(&mut self, pressed: Chord, target: Chord) {
        self.remove(pressed);
        self.pairs.push((pressed, target));
        // Sorted by name, like the keys of a file that is read again.
        self.pairs.sort_by_key(|(pressed, _)| name(*pressed));
    }

    /// Returns the key that a pressed key acts as.
    pub fn translate(&self, event: &KeyEvent) -> KeyEvent {
        let target = self.pairs.iter().find(|(pressed, _)| pressed.matches(event)).map(|(_, target)| *target);
        target.map_or(*event, |target| KeyEvent { kind: event.kind, ..target.event() })
    }

    /// Restores the default of `pressed`.
    pub fn remove(&mut self, pressed: Chord) {
        self.pairs.retain(|(known, _)| *known != pressed);
    }

    /// The key that `pressed` acts as, or `None` if it has its default.
    pub fn target_of(&self, pressed: Chord) -> Option<Chord> {
        self.pairs.iter().find(|(known, _)| *known == pressed).map(|(_, target)| *target)
    }

    /// The rebound keys that concern `chords`: those that act as one of them, and those among them that act as another key.
    pub fn about(&self, chords: &[Chord]) -> Vec<Chord> {
        let is_about = |(pressed, target): &&(Chord, Chord)| chords.contains(pressed) || chords.contains(target);
        self.pairs.iter().filter(is_about).map(|(pressed, _)| *pressed).collect()
    }

    /// The keys that act as `target`, user-defined ones first.
    pub fn keys_for(&self, target: Chord) -> impl Iterator<Item = Chord> {
        let own = self.pairs.iter().filter(move |(_, acts_as)| *acts_as == target).map(|(pressed, _)| *pressed);
        let kept = self.pairs.iter().all(|(pressed, _)| *pressed != target).then_some(target);
        own.chain(kept)
    }

    /// The bindings as lines of the settings file.
    pub fn document(&self) -> String {
        let quoted = |chord: &Chord| toml::Value::String(name(*chord)).to_string();
        let line = |(pressed, target): &(Chord, Chord)| format!("{} = {}\n", quoted(pressed), quoted(target));
        self.pairs.iter().map(line).collect::<Vec<_>>().concat()
    }
}

/// Keys with names.
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

/// Parses the name of a key, ignoring the case of key names.
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

/// The capital of a letter, if it is a single letter; what Shift does to a sign depends on the keyboard.
fn capital(letter: char) -> char {
    let mut capitals = letter.to_uppercase();
    match (capitals.next(), capitals.next()) {
        (Some(capital), None) => capital,
        _ => letter,
    }
}

/// The name of a key in the settings file.
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
    fn key_names_parse_back() {
        for text in ["x", "X", "-", "Ctrl-r", "Ctrl--", "Shift-Left", "Shift-Tab", "F12", "Space", "PageUp", "ä"] {
            assert_eq!(name(chord(text).unwrap()), text);
        }
        // A letter whose capital is not a single letter stays as it is.
        for (written, letter) in [("shift-x", "X"), ("shift-\u{e4}", "\u{c4}"), ("shift-\u{df}", "\u{df}")] {
            assert_eq!(chord(written), chord(letter));
        }
        for text in ["", "F13", "F0", "Hyper-x", "Ctrl-", "xy"] {
            assert_eq!(chord(text), None, "{text}");
        }
    }

    #[test]
    fn a_rebound_key_acts_as_another_and_loses_its_own_action() {
        let mut keys = Keys::default();
        let [x, enter] = ["x", "Enter"].map(|text| chord(text).unwrap());
        keys.add(x, enter);
        assert!(enter.matches(&keys.translate(&x.event())));
        assert!(enter.matches(&keys.translate(&enter.event())));
        assert_eq!(keys.keys_for(enter).collect::<Vec<_>>(), [x, enter]);
        assert_eq!(keys.keys_for(x).count(), 0);
    }
}
