//! A single-line text field: for search words, names and values.

use crossterm::event::{
    KeyCode::{Backspace, Char, Delete, End, Home, Left, Right},
    KeyEvent, KeyModifiers,
};
use ratatui::{layout::Rect, style::Modifier};
use unicode_segmentation::UnicodeSegmentation;

use crate::terminal::ui::{Ui, columns, suffix_within};

/// Input to a text field: a key press, or text from the clipboard.
#[derive(Clone, Copy, Debug)]
pub enum Typed<'a> {
    /// A key that was pressed.
    Key(&'a KeyEvent),
    /// Text that was pasted.
    Paste(&'a str),
}

/// Edit operation of a key.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Edit {
    Insert(char),
    Move(Movement),
    Delete(Movement),
}

/// Cursor movement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Movement {
    Left,
    Right,
    WordLeft,
    WordRight,
    Start,
    End,
}

/// A line of text with a cursor. Its keys are those of most terminal programs; it ignores Up, Down, Tab, Enter and Esc.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TextField {
    text: String,
    /// Byte offset at which the next character is inserted.
    cursor: usize,
    /// Longest text, bytes.
    limit: usize,
    /// Whether the text is a suggestion: the first typed character replaces it, any other key keeps it.
    is_offered: bool,
}

impl TextField {
    /// Creates an empty field for at most `limit` bytes.
    pub const fn new(limit: usize) -> Self {
        Self { text: String::new(), cursor: 0, limit, is_offered: false }
    }

    /// Inserts `text`, as far as it fits, with the cursor after it.
    #[must_use]
    pub fn with(mut self, text: &str) -> Self {
        self.insert(text);
        self
    }

    /// Inserts `text` as a suggestion, which the user can accept, edit or replace by typing.
    #[must_use]
    pub fn with_suggestion(self, text: &str) -> Self {
        Self { is_offered: true, ..self.with(text) }
    }

    /// The text of the field.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Handles input; returns `false` if the field does not use the key.
    pub fn handle(&mut self, typed: Typed) -> bool {
        let is_text = match typed {
            Typed::Paste(text) => !text.is_empty(),
            Typed::Key(key) => matches!(Edit::of(key), Some(Edit::Insert(_))),
        };
        if std::mem::take(&mut self.is_offered) && is_text {
            self.text.clear();
            self.cursor = 0;
        }
        match typed {
            Typed::Paste(text) => self.insert(text.trim_end_matches(['\n', '\r'])),
            Typed::Key(key) => match Edit::of(key) {
                None => return false,
                Some(Edit::Insert(letter)) => self.insert(letter.encode_utf8(&mut [0; 4])),
                Some(Edit::Move(movement)) => self.cursor = self.at(movement),
                Some(Edit::Delete(movement)) => {
                    let end = self.at(movement);
                    let removed = self.cursor.min(end)..self.cursor.max(end);
                    self.cursor = removed.start;
                    self.text.drain(removed);
                }
            },
        }
        true
    }

    /// Inserts `text` at the cursor, as far as there is room. Line breaks and tabs become blanks; other control characters are dropped.
    fn insert(&mut self, text: &str) {
        for letter in text.chars() {
            let letter = if matches!(letter, '\n' | '\r' | '\t') { ' ' } else { letter };
            if !letter.is_control() && self.text.len() + letter.len_utf8() <= self.limit {
                self.text.insert(self.cursor, letter);
                self.cursor += letter.len_utf8();
            }
        }
    }

    /// The cursor position after the movement, a byte offset.
    fn at(&self, movement: Movement) -> usize {
        let (before, after) = self.text.split_at(self.cursor);
        let (word, gap) = (char::is_alphanumeric, |letter: char| !letter.is_alphanumeric());
        match movement {
            Movement::Left => before.grapheme_indices(true).next_back().map_or(0, |(start, _)| start),
            Movement::Right => self.cursor + after.graphemes(true).next().map_or(0, str::len),
            Movement::WordLeft => before.trim_end_matches(gap).trim_end_matches(word).len(),
            Movement::WordRight => self.text.len() - after.trim_start_matches(gap).trim_start_matches(word).len(),
            Movement::Start => 0,
            Movement::End => self.text.len(),
        }
    }

    /// Draws the field into the row `area`: all of the text if there is room, otherwise the part around the cursor. The cursor is in
    /// reverse video.
    pub fn draw(&self, area: Rect, ui: &mut Ui) {
        let width = usize::from(area.width);
        let (before, after) = self.text.split_at(self.cursor);
        // Keep some of the text after the cursor visible.
        let ahead = columns(after).max(1).min(width / 3 + 1);
        let shown = suffix_within(before, width.saturating_sub(ahead));
        let hidden = before.len() - shown.len();
        let style = if self.is_offered { ui.theme.faint() } else { ui.theme.text() };
        ui.buffer.set_stringn(area.x, area.y, &self.text[hidden..], width, style);
        let letter = after.graphemes(true).next().map_or(1, |letter| columns(letter).max(1));
        let cursor = Rect { x: area.x + columns(shown) as u16, width: letter as u16, height: 1, ..area };
        ui.buffer.set_style(cursor.intersection(area), ui.theme.text().add_modifier(Modifier::REVERSED));
    }
}

impl Edit {
    fn of(key: &KeyEvent) -> Option<Self> {
        let by_word = key.modifiers == KeyModifiers::CONTROL || key.modifiers == KeyModifiers::ALT;
        Some(match key.code {
            Char(letter) if (key.modifiers - KeyModifiers::SHIFT).is_empty() => Self::Insert(letter),
            Char('w') if key.modifiers == KeyModifiers::CONTROL => Self::Delete(Movement::WordLeft),
            Char('u') if key.modifiers == KeyModifiers::CONTROL => Self::Delete(Movement::Start),
            // Many terminals send this for Alt with an arrow key.
            Char('b') if key.modifiers == KeyModifiers::ALT => Self::Move(Movement::WordLeft),
            Char('f') if key.modifiers == KeyModifiers::ALT => Self::Move(Movement::WordRight),
            Left if by_word => Self::Move(Movement::WordLeft),
            Right if by_word => Self::Move(Movement::WordRight),
            Backspace if by_word => Self::Delete(Movement::WordLeft),
            Delete if by_word => Self::Delete(Movement::WordRight),
            _ if !key.modifiers.is_empty() => return None,
            Left => Self::Move(Movement::Left),
            Right => Self::Move(Movement::Right),
            Home => Self::Move(Movement::Start),
            End => Self::Move(Movement::End),
            Backspace => Self::Delete(Movement::Left),
            Delete => Self::Delete(Movement::Right),
            _ => return None,
        })
    }
}

impl Typed<'_> {
    /// The typed characters; empty for keys that type none.
    pub fn letters(&self) -> String {
        match self {
            Self::Paste(text) => (*text).to_owned(),
            Self::Key(key) => match Edit::of(key) {
                Some(Edit::Insert(letter)) => letter.to_string(),
                _ => String::new(),
            },
        }
    }
}

/// Whether a text field uses the key.
pub fn is_typed(key: &KeyEvent) -> bool {
    Edit::of(key).is_some()
}

#[cfg(test)]
mod tests {
    use crossterm::event::KeyCode::{self, Enter, Esc, F, Tab, Up};
    use proptest::prelude::*;

    use super::*;
    use crate::terminal::Capabilities;

    /// The text with a bar at the cursor, after these keys.
    fn after(text: &str, keys: &[(KeyModifiers, KeyCode)]) -> String {
        let mut field = TextField::new(100).with(text);
        for (modifiers, code) in keys {
            assert!(field.handle(Typed::Key(&KeyEvent::new(*code, *modifiers))), "{code}");
        }
        let (before, after) = field.text.split_at(field.cursor);
        format!("{before}|{after}")
    }

    /// The visible text of a field of `width` columns, and the columns in reverse video.
    fn drawn(field: &TextField, width: u16) -> (String, Vec<u16>) {
        let area = Rect::new(0, 0, width, 1);
        let buffer = crate::terminal::ui::drawn(area, Capabilities::NO_COLOUR, |ui| field.draw(area, ui));
        let text = buffer.content().iter().map(|cell| cell.symbol().to_owned()).collect::<String>();
        let is_reversed = |x: &u16| buffer[(*x, 0)].modifier.contains(Modifier::REVERSED);
        (text, (0..width).filter(is_reversed).collect())
    }

    const NONE: KeyModifiers = KeyModifiers::NONE;
    const CONTROL: KeyModifiers = KeyModifiers::CONTROL;
    const ALT: KeyModifiers = KeyModifiers::ALT;

    #[test]
    fn letters_go_where_the_cursor_is() {
        assert_eq!(after("ac", &[(NONE, Left), (NONE, Char('b'))]), "ab|c");
        assert_eq!(after("bc", &[(NONE, Home), (KeyModifiers::SHIFT, Char('A')), (NONE, End)]), "Abc|");
        assert_eq!(after("abc", &[(NONE, Left), (NONE, Backspace), (NONE, Delete), (NONE, Delete)]), "a|");
        assert_eq!(after("", &[(NONE, Left), (NONE, Right), (NONE, Backspace), (NONE, Delete)]), "|");
    }

    #[test]
    fn word_keys_move_and_delete_whole_words() {
        let text = "draw to the #corner";
        assert_eq!(after(text, &[(CONTROL, Left)]), "draw to the #|corner");
        assert_eq!(after(text, &[(ALT, Left), (ALT, Char('b'))]), "draw to |the #corner");
        assert_eq!(after(text, &[(NONE, Home), (CONTROL, Right), (ALT, Char('f'))]), "draw to| the #corner");
        assert_eq!(after(text, &[(CONTROL, Char('w'))]), "draw to the #|");
        assert_eq!(after(text, &[(CONTROL, Left), (CONTROL, Char('u'))]), "|corner");
        assert_eq!(after(text, &[(NONE, Home), (CONTROL, Delete)]), "| to the #corner");
    }

    #[test]
    fn a_letter_with_combining_accents_is_one_character() {
        assert_eq!(after("e\u{301}당", &[(NONE, Left), (NONE, Left)]), "|e\u{301}당");
        assert_eq!(after("ae\u{301}", &[(NONE, Backspace)]), "a|");
    }

    #[test]
    fn the_first_letter_replaces_the_suggestion_and_other_keys_keep_it() {
        let typed = |keys: &[KeyCode]| {
            let mut field = TextField::new(12).with_suggestion("own");
            for code in keys {
                field.handle(Typed::Key(&KeyEvent::new(*code, NONE)));
            }
            field.text().to_owned()
        };
        assert_eq!(typed(&[]), "own");
        assert_eq!(typed(&[Char('c'), Char('d')]), "cd");
        assert_eq!(typed(&[End, Char('c')]), "ownc");
        assert_eq!(typed(&[Backspace, Char('c')]), "owc");
    }

    #[test]
    fn pasted_text_becomes_one_clean_line_within_the_limit() {
        let mut field = TextField::new(12);
        field.handle(Typed::Paste("a\r\nb\u{1b}\u{7}\tc"));
        assert_eq!(field.text(), "a  b c");
        field.handle(Typed::Paste(&"당".repeat(9)));
        assert_eq!(field.text(), "a  b c당당");
    }

    #[test]
    fn text_field_ignores_keys_of_the_page() {
        let page =
            [(NONE, Up), (NONE, Enter), (NONE, Esc), (NONE, Tab), (NONE, F(1)), (CONTROL, Char('c')), (CONTROL, Up)];
        for (modifiers, code) in page {
            let key = KeyEvent::new(code, modifiers);
            assert!(!TextField::new(9).handle(Typed::Key(&key)) && !is_typed(&key), "{code}");
        }
    }

    #[test]
    fn the_cursor_is_visible_for_any_text_length() {
        let field = TextField::new(100).with("ab");
        assert_eq!(drawn(&field, 6), ("ab    ".to_owned(), vec![2]));
        let mut field = TextField::new(100).with("0123456789abcdef");
        assert_eq!(drawn(&field, 6), ("bcdef ".to_owned(), vec![5]));
        field.handle(Typed::Key(&KeyEvent::from(Home)));
        assert_eq!(drawn(&field, 6), ("012345".to_owned(), vec![0]));
        let mut hangul = TextField::new(100).with("당구당구");
        hangul.handle(Typed::Key(&KeyEvent::from(Left)));
        assert_eq!(drawn(&hangul, 8).1, [6, 7], "both columns of a wide letter");
    }

    proptest! {
        #[test]
        fn any_key_sequence_keeps_the_text_valid_and_the_cursor_visible(
            text in "\\PC{0,20}", keys in prop::collection::vec(0..14_usize, 0..20), width in 2..12_u16,
        ) {
            let all = [
                (NONE, Left), (NONE, Right), (CONTROL, Left), (CONTROL, Right), (NONE, Home), (NONE, End), (NONE, Backspace),
                (NONE, Delete), (CONTROL, Char('w')), (CONTROL, Char('u')), (NONE, Char('\u{301}')), (NONE, Char('구')),
                (NONE, Char('x')), (CONTROL, Delete),
            ];
            let mut field = TextField::new(40).with(&text);
            for key in keys {
                let (modifiers, code) = all[key];
                field.handle(Typed::Key(&KeyEvent::new(code, modifiers)));
                prop_assert!(field.text.len() <= 40 && field.text.is_char_boundary(field.cursor));
                prop_assert!(!drawn(&field, width).1.is_empty());
            }
        }
    }
}
