//! Keys by the names used in tests.

use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};

/// Returns the key called `word`: a letter, or a name like `Left` or `Enter`; `S-` and `C-` before it mean Shift and Ctrl.
pub fn key(word: &str) -> KeyEvent {
    let (modifiers, name) = match word.split_once('-') {
        Some(("S", name)) => (KeyModifiers::SHIFT, name),
        Some(("C", name)) => (KeyModifiers::CONTROL, name),
        _ => (KeyModifiers::NONE, word),
    };
    let code = match name {
        "Left" => KeyCode::Left,
        "Right" => KeyCode::Right,
        "Up" => KeyCode::Up,
        "Down" => KeyCode::Down,
        "Enter" => KeyCode::Enter,
        "Esc" => KeyCode::Esc,
        "Tab" => KeyCode::Tab,
        "End" => KeyCode::End,
        "Backspace" => KeyCode::Backspace,
        "BackTab" => KeyCode::BackTab,
        "Delete" => KeyCode::Delete,
        "Home" => KeyCode::Home,
        "PageDown" => KeyCode::PageDown,
        "PageUp" => KeyCode::PageUp,
        "Space" => KeyCode::Char(' '),
        function if function.len() > 1 && function.starts_with('F') => KeyCode::F(function[1..].parse().unwrap()),
        letter => {
            let mut letters = letter.chars();
            let first = letters.next().unwrap();
            assert_eq!(letters.next(), None, "no key is called {letter}");
            KeyCode::Char(first)
        }
    };
    KeyEvent::new(code, modifiers)
}
