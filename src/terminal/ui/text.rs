//! Text in columns: wrapped, cut, or set to the right.

use ratatui::{buffer::Buffer, style::Style, text::Span};

use crate::terminal::capabilities::Capabilities;

/// The first `rows` lines; the last of them says by its end if there are more.
pub fn cut(mut lines: Vec<String>, rows: usize, width: usize, caps: Capabilities) -> Vec<String> {
    if lines.len() <= rows {
        return lines;
    }
    lines.truncate(rows);
    let more = caps.pick("…", "...");
    if let Some(last) = lines.last_mut() {
        let room = width.saturating_sub(more.chars().count());
        *last = last.chars().take(room).collect::<String>().trim_end().to_owned() + more;
    }
    lines
}

/// The words of `text` in lines of at most `width` characters; a longer word begins a line and is broken.
pub fn wrap(text: &str, width: usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split_whitespace() {
        let last = lines.len() - 1;
        let line = &mut lines[last];
        if !line.is_empty() && line.chars().count() + 1 + word.chars().count() <= width {
            line.push(' ');
            line.push_str(word);
            continue;
        }
        let letters: Vec<char> = word.chars().collect();
        let mut pieces = letters.chunks(width.max(1)).map(String::from_iter);
        if line.is_empty() {
            line.extend(pieces.next());
        }
        lines.extend(pieces);
    }
    lines
}

/// The end of `text`, as much as fits into `room` columns: the ends of names differ where their beginnings do not.
pub fn end_of(text: &str, room: usize, caps: Capabilities) -> String {
    let count = text.chars().count();
    if count <= room {
        return text.to_owned();
    }
    let more = caps.pick("…", "...");
    let kept = room.saturating_sub(more.chars().count());
    format!("{more}{}", text.chars().skip(count - kept).collect::<String>()).chars().take(room).collect()
}

/// Writes `text` so that it ends before column `end`, but never left of `start`.
pub fn write_right(buffer: &mut Buffer, start: u16, end: u16, row: u16, text: &str, style: Style) {
    let width = Span::raw(text).width() as u16;
    let x = end.saturating_sub(width).max(start);
    buffer.set_stringn(x, row, text, usize::from(end.saturating_sub(x)), style);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::terminal::capabilities::{Depth, Glyphs};

    #[test]
    fn long_sentences_are_broken_between_words() {
        assert_eq!(wrap("", 5), [""]);
        assert_eq!(wrap("one two three", 7), ["one two", "three"]);
        assert_eq!(wrap("unbreakable a b", 4), ["unbr", "eaka", "ble", "a b"]);
    }

    #[test]
    fn what_is_cut_says_so() {
        let unicode = Capabilities { depth: Depth::Mono, glyphs: Glyphs::Letters, unicode: true };
        let lines = wrap("one two three four", 7);
        assert_eq!(cut(lines.clone(), 2, 7, unicode), ["one two", "three\u{2026}"]);
        assert_eq!(cut(lines.clone(), 1, 7, Capabilities { unicode: false, ..unicode }), ["one..."]);
        assert_eq!(cut(lines.clone(), 3, 7, unicode), lines);
    }
}
