//! Keys and reports sent as control sequences (ECMA-48 5.4; key lists of xterm and kitty).

use crossterm::event::{Event, KeyCode, KeyEvent, KeyEventKind, KeyModifiers};

use crate::terminal::host::input::{
    keys::{key, modifiers_and_kind, with},
    mouse,
};

/// Decodes `ESC [ parameters last`; `None` if it is unknown, or an answer to a query of another program.
pub fn event(parameters: &[u8], last: u8) -> Option<Event> {
    let text = std::str::from_utf8(parameters).ok()?;
    if let Some(report) = text.strip_prefix('<') {
        return mouse::sgr(report, last);
    }
    let mut numbers = text.split(';');
    let first = numbers.next().unwrap_or_default();
    match last {
        b'~' => numbered(first, numbers),
        b'u' => unicode(first, numbers.next()),
        b'I' if text.is_empty() => Some(Event::FocusGained),
        b'O' if text.is_empty() => Some(Event::FocusLost),
        b'Z' => modified(KeyCode::BackTab, numbers.next()).map(|event| with(event, KeyModifiers::SHIFT)),
        // A report of the cursor position has the same final byte, but its first number is a row.
        b'R' if !matches!(first, "" | "1") => None,
        _ => letter(last).filter(|_| matches!(first, "" | "1")).and_then(|code| modified(code, numbers.next())),
    }
}

/// Decodes `ESC O last`.
pub fn ss3(last: u8) -> Option<Event> {
    letter(last).map(key)
}

/// Keys identified by a letter.
const fn letter(last: u8) -> Option<KeyCode> {
    Some(match last {
        b'A' => KeyCode::Up,
        b'B' => KeyCode::Down,
        b'C' => KeyCode::Right,
        b'D' => KeyCode::Left,
        b'F' => KeyCode::End,
        b'H' => KeyCode::Home,
        b'P'..=b'S' => KeyCode::F(last - b'P' + 1),
        _ => return None,
    })
}

/// Keys identified by a number, and xterm's `27 ; modifiers ; character`.
fn numbered<'a>(first: &str, mut rest: impl Iterator<Item = &'a str>) -> Option<Event> {
    let code = match first.parse::<u8>().ok()? {
        1 | 7 => KeyCode::Home,
        2 => KeyCode::Insert,
        3 => KeyCode::Delete,
        4 | 8 => KeyCode::End,
        5 => KeyCode::PageUp,
        6 => KeyCode::PageDown,
        number @ 11..=15 => KeyCode::F(number - 10),
        number @ 17..=21 => KeyCode::F(number - 11),
        number @ 23..=26 => KeyCode::F(number - 12),
        number @ 28..=29 => KeyCode::F(number - 15),
        number @ 31..=34 => KeyCode::F(number - 17),
        27 => {
            let modifiers = rest.next();
            return unicode(rest.next()?, modifiers);
        }
        _ => return None,
    };
    modified(code, rest.next())
}

/// A key identified by the code point of its character, as in kitty's protocol.
fn unicode(first: &str, second: Option<&str>) -> Option<Event> {
    let mut numbers = first.split(':').map(|number| number.parse().ok().and_then(char::from_u32));
    let character = numbers.next()??;
    let (mut modifiers, kind) = modifiers_and_kind(second)?;
    let code = match character {
        '\u{1b}' => KeyCode::Esc,
        '\r' | '\u{e046}' => KeyCode::Enter,
        '\t' if modifiers.contains(KeyModifiers::SHIFT) => KeyCode::BackTab,
        '\t' => KeyCode::Tab,
        '\u{7f}' | '\u{8}' => KeyCode::Backspace,
        // Keys without a character have code points from the private use area.
        character if character.is_control() || ('\u{e000}'..='\u{f8ff}').contains(&character) => return None,
        character => {
            let shifted = numbers.next().flatten().filter(|_| modifiers.contains(KeyModifiers::SHIFT));
            if shifted.is_some() {
                modifiers.remove(KeyModifiers::SHIFT);
            }
            KeyCode::Char(shifted.unwrap_or(character))
        }
    };
    Some(Event::Key(KeyEvent::new_with_kind(code, modifiers, kind)))
}

fn modified(code: KeyCode, parameter: Option<&str>) -> Option<Event> {
    let (modifiers, kind): (_, KeyEventKind) = modifiers_and_kind(parameter)?;
    Some(Event::Key(KeyEvent::new_with_kind(code, modifiers, kind)))
}
