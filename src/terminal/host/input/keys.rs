//! Keys of characters, and modifiers.

use crossterm::event::{Event, KeyCode, KeyEvent, KeyEventKind, KeyModifiers};

/// A press of a key without modifiers.
pub fn key(code: KeyCode) -> Event {
    Event::Key(code.into())
}

/// Adds `modifiers` to a key event.
pub fn with(mut event: Event, modifiers: KeyModifiers) -> Event {
    if let Event::Key(key) = &mut event {
        key.modifiers |= modifiers;
    }
    event
}

/// A key pressed with Alt.
pub fn alt(byte: u8) -> Event {
    with(character(char::from(byte)), KeyModifiers::ALT)
}

/// The key of a character. An upper-case letter implies Shift.
pub fn character(character: char) -> Event {
    let modifiers = if character.is_uppercase() { KeyModifiers::SHIFT } else { KeyModifiers::NONE };
    Event::Key(KeyEvent::new(KeyCode::Char(character), modifiers))
}

/// The key of a control character; `None` if the byte is not one.
pub fn control(byte: u8) -> Option<Event> {
    let with_control =
        |character: u8| Event::Key(KeyEvent::new(KeyCode::Char(char::from(character)), KeyModifiers::CONTROL));
    Some(match byte {
        b'\r' => key(KeyCode::Enter),
        b'\t' => key(KeyCode::Tab),
        0x7f => key(KeyCode::Backspace),
        0x1b => key(KeyCode::Esc),
        0 => with_control(b' '),
        0x01..=0x1a => with_control(byte - 1 + b'a'),
        0x1c..=0x1f => with_control(byte - 0x1c + b'4'),
        _ => return None,
    })
}

/// Decodes the modifiers and the kind of event (press, repeat or release) from the parameter `1 + mask` or `1 + mask:kind`.
pub fn modifiers_and_kind(parameter: Option<&str>) -> Option<(KeyModifiers, KeyEventKind)> {
    let Some(parameter) = parameter.filter(|text| !text.is_empty()) else {
        return Some((KeyModifiers::NONE, KeyEventKind::Press));
    };
    let mut parts = parameter.split(':');
    let mask = parts.next()?.parse::<u8>().ok()?.saturating_sub(1);
    let all = [
        KeyModifiers::SHIFT,
        KeyModifiers::ALT,
        KeyModifiers::CONTROL,
        KeyModifiers::SUPER,
        KeyModifiers::HYPER,
        KeyModifiers::META,
    ];
    let held = all.into_iter().enumerate().filter(|(bit, _)| mask & (1 << bit) != 0);
    let kind = match parts.next() {
        Some("2") => KeyEventKind::Repeat,
        Some("3") => KeyEventKind::Release,
        _ => KeyEventKind::Press,
    };
    Some((held.fold(KeyModifiers::NONE, |sum, (_, one)| sum | one), kind))
}
