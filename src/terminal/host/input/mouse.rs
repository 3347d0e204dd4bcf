//! Mouse reports, in the SGR form that the program requests and in the oldest form, for terminals without SGR.

use crossterm::event::{Event, KeyModifiers, MouseButton, MouseEvent, MouseEventKind};

/// Decodes the SGR form: `button ; column ; row`, and a final letter that marks a release.
pub fn sgr(parameters: &str, last: u8) -> Option<Event> {
    let [button, column, row] = numbers(parameters)?;
    let (kind, modifiers) = button_of(u8::try_from(button).ok()?)?;
    let kind = match (kind, last) {
        (MouseEventKind::Down(button), b'm') => MouseEventKind::Up(button),
        (kind, b'M' | b'm') => kind,
        _ => return None,
    };
    event(kind, modifiers, column, row)
}

/// Decodes the oldest form: three bytes, each offset by 32.
pub fn old(button: u8, column: u8, row: u8) -> Option<Event> {
    let (kind, modifiers) = button_of(button.checked_sub(32)?)?;
    event(kind, modifiers, u16::from(column.checked_sub(32)?), u16::from(row.checked_sub(32)?))
}

fn numbers(parameters: &str) -> Option<[u16; 3]> {
    let mut numbers = parameters.trim_end_matches(';').split(';').map(str::parse);
    let three = [numbers.next()?.ok()?, numbers.next()?.ok()?, numbers.next()?.ok()?];
    numbers.next().is_none().then_some(three)
}

/// Builds the event; terminals count from 1.
fn event(kind: MouseEventKind, modifiers: KeyModifiers, column: u16, row: u16) -> Option<Event> {
    let (column, row) = (column.checked_sub(1)?, row.checked_sub(1)?);
    Some(Event::Mouse(MouseEvent { kind, column, row, modifiers }))
}

/// Bits 0, 1, 6 and 7 are the button, bits 2 to 4 the modifiers, and bit 5 marks a motion.
fn button_of(bits: u8) -> Option<(MouseEventKind, KeyModifiers)> {
    let button = (bits & 0b11) | ((bits & 0b1100_0000) >> 4);
    let moves = bits & 0b10_0000 != 0;
    let named = [MouseButton::Left, MouseButton::Middle, MouseButton::Right];
    let kind = match (button, moves) {
        (0..=2, false) => MouseEventKind::Down(named[usize::from(button)]),
        (0..=2, true) => MouseEventKind::Drag(named[usize::from(button)]),
        (3, false) => MouseEventKind::Up(MouseButton::Left),
        (3..=5, true) => MouseEventKind::Moved,
        (4, false) => MouseEventKind::ScrollUp,
        (5, false) => MouseEventKind::ScrollDown,
        (6, false) => MouseEventKind::ScrollLeft,
        (7, false) => MouseEventKind::ScrollRight,
        _ => return None,
    };
    let held = [(4, KeyModifiers::SHIFT), (8, KeyModifiers::ALT), (16, KeyModifiers::CONTROL)];
    let held = held.into_iter().filter(|(bit, _)| bits & bit != 0);
    Some((kind, held.fold(KeyModifiers::NONE, |sum, (_, one)| sum | one)))
}
