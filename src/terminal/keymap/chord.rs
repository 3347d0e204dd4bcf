//! Keys with modifiers, and their names on the screen.

use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};

use crate::terminal::Capabilities;

/// A key with its modifiers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Chord {
    code: KeyCode,
    modifiers: KeyModifiers,
}

impl Chord {
    /// A key without modifiers.
    pub const fn plain(code: KeyCode) -> Self {
        Self { code, modifiers: KeyModifiers::NONE }
    }

    /// The key that types `letter`, including Shift if needed.
    pub const fn char(letter: char) -> Self {
        Self::plain(KeyCode::Char(letter))
    }

    /// A key with Shift.
    pub const fn shift(code: KeyCode) -> Self {
        Self { code, modifiers: KeyModifiers::SHIFT }
    }

    /// A key with Ctrl.
    pub const fn ctrl(code: KeyCode) -> Self {
        Self { code, modifiers: KeyModifiers::CONTROL }
    }

    /// The key of an event.
    pub fn of(event: &KeyEvent) -> Self {
        let shift_is_in_the_code = matches!(event.code, KeyCode::Char(_) | KeyCode::BackTab);
        let ignored = if shift_is_in_the_code { KeyModifiers::SHIFT } else { KeyModifiers::NONE };
        Self { code: event.code, modifiers: event.modifiers - ignored }
    }

    /// A press event of this key.
    pub const fn event(self) -> KeyEvent {
        KeyEvent::new(self.code, self.modifiers)
    }

    /// Whether `event` is this key. Terminals differ in whether they report Shift for a letter that includes it.
    pub fn matches(self, event: &KeyEvent) -> bool {
        self == Self::of(event)
    }

    /// The modifiers as written before the key.
    pub(super) const fn prefix(self) -> &'static str {
        if self.modifiers.contains(KeyModifiers::CONTROL) {
            "Ctrl-"
        } else if self.modifiers.contains(KeyModifiers::SHIFT) {
            "Shift-"
        } else {
            ""
        }
    }

    fn name(self, caps: Capabilities) -> String {
        match self.code {
            KeyCode::Char(' ') => "Space".into(),
            KeyCode::Char(letter) => letter.into(),
            KeyCode::Left => caps.pick("←", "Left").into(),
            KeyCode::Right => caps.pick("→", "Right").into(),
            KeyCode::Up => caps.pick("↑", "Up").into(),
            KeyCode::Down => caps.pick("↓", "Down").into(),
            KeyCode::PageDown => "PgDn".into(),
            KeyCode::PageUp => "PgUp".into(),
            KeyCode::BackTab => "Shift-Tab".into(),
            other => other.to_string(),
        }
    }

    /// Group of keys that are written together without a blank.
    const fn family(self) -> Option<bool> {
        match self.code {
            KeyCode::Left | KeyCode::Right | KeyCode::Up | KeyCode::Down => Some(true),
            KeyCode::Char('h' | 'j' | 'k' | 'l' | 'H' | 'J' | 'K' | 'L') => Some(false),
            _ => None,
        }
    }
}

/// The keys as displayed, like `Shift-←↓↑→ HJKL`.
pub fn keys_text(chords: impl IntoIterator<Item = Chord>, caps: Capabilities) -> String {
    let mut text = String::new();
    let mut before: Option<Chord> = None;
    for chord in chords {
        let together = before.is_some_and(|last| {
            last.modifiers == chord.modifiers && last.family() == chord.family() && chord.family().is_some()
        });
        if together {
            text.push_str(if caps.unicode || chord.family() == Some(false) { "" } else { "/" });
        } else {
            text.push_str(if before.is_some() { " " } else { "" });
            text.push_str(chord.prefix());
        }
        text.push_str(&chord.name(caps));
        before = Some(chord);
    }
    text.replace("Left/Down/Up/Right", "arrows")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_written_as_on_the_keyboard() {
        let chords = [KeyCode::Left, KeyCode::Down, KeyCode::Up, KeyCode::Right].map(Chord::shift);
        let caps = Capabilities::TRUE_COLOUR;
        assert_eq!(keys_text(chords.into_iter().chain([Chord::char('H'), Chord::char('J')]), caps), "Shift-←↓↑→ HJ");
        let plain = Capabilities { unicode: false, ..caps };
        assert_eq!(keys_text(chords, plain), "Shift-arrows");
        assert_eq!(keys_text([Chord::char(' '), Chord::plain(KeyCode::F(1))], caps), "Space F1");
    }

    #[test]
    fn a_capital_letter_matches_with_and_without_reported_shift() {
        for modifiers in [KeyModifiers::NONE, KeyModifiers::SHIFT] {
            assert!(Chord::char('U').matches(&KeyEvent::new(KeyCode::Char('U'), modifiers)));
        }
        assert!(!Chord::char('c').matches(&KeyEvent::new(KeyCode::Char('c'), KeyModifiers::CONTROL)));
        assert!(!Chord::plain(KeyCode::Left).matches(&KeyEvent::new(KeyCode::Left, KeyModifiers::SHIFT)));
    }
}
