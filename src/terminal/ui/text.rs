//! Text measured in terminal columns: measured, wrapped, cut or right-aligned.
//!
//! A column is not a character: Hangul and emoji take two columns, a combining mark none. Grapheme clusters are never split.

use ratatui::{
    buffer::{Buffer, CellWidth},
    style::Style,
};
use unicode_segmentation::UnicodeSegmentation;

use crate::{printing, terminal::Capabilities};

/// Columns that `text` takes on the screen.
pub fn columns(text: &str) -> usize {
    text.graphemes(true).map(grapheme_columns).sum()
}

/// Columns of one grapheme cluster; control characters are not drawn and take none.
pub fn grapheme_columns(grapheme: &str) -> usize {
    if grapheme.contains(char::is_control) { 0 } else { usize::from(grapheme.cell_width()) }
}

/// The longest start of `text` that fits into `room` columns.
pub fn prefix_within(text: &str, room: usize) -> &str {
    let mut fits = filling(room);
    let end = text.grapheme_indices(true).find(|(_, grapheme)| !fits(grapheme));
    &text[..end.map_or(text.len(), |(end, _)| end)]
}

/// The longest end of `text` that fits into `room` columns.
pub fn suffix_within(text: &str, room: usize) -> &str {
    let mut fits = filling(room);
    let last_hidden = text.grapheme_indices(true).rev().find(|(_, grapheme)| !fits(grapheme));
    &text[last_hidden.map_or(0, |(start, grapheme)| start + grapheme.len())..]
}

/// Returns a counter that tells, grapheme by grapheme, whether the text so far still fits into `room` columns.
fn filling(room: usize) -> impl FnMut(&str) -> bool {
    let mut taken = 0;
    move |grapheme| {
        taken += grapheme_columns(grapheme);
        taken <= room
    }
}

/// Keeps the first `rows` lines; if lines were dropped, the last one ends with an ellipsis.
pub fn truncate_lines(mut lines: Vec<String>, rows: usize, width: usize, caps: Capabilities) -> Vec<String> {
    if lines.len() <= rows {
        return lines;
    }
    lines.truncate(rows);
    let more = prefix_within(caps.pick("…", "..."), width);
    if let Some(last) = lines.last_mut() {
        *last = prefix_within(last, width.saturating_sub(columns(more))).trim_end().to_owned() + more;
    }
    lines
}

/// Shortens `text` to one line of at most `room` columns, with an ellipsis if words were dropped.
pub fn shorten(text: &str, room: usize, caps: Capabilities) -> String {
    truncate_lines(wrap(&to_displayable(text, caps), room), 1, room, caps).swap_remove(0)
}

/// Wraps the words of `text` into lines of at most `width` columns. A longer word starts a new line and is broken, after a `/` of a path if
/// there is one. A character wider than `width` gets its own line.
pub fn wrap(text: &str, width: usize) -> Vec<String> {
    wrap_by(text, |_| width)
}

/// Wraps text into lines whose width is a function of the line number.
pub fn wrap_by(text: &str, width: impl Fn(usize) -> usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    let mut taken = 0;
    for word in unbreakable(text) {
        let wide = columns(&word);
        let last = lines.len() - 1;
        if lines[last].is_empty() || taken + 1 + wide <= width(last) {
            if !lines[last].is_empty() {
                lines[last].push(' ');
                taken += 1;
            }
        } else {
            lines.push(String::new());
            taken = 0;
        }
        let is_long = wide > width(lines.len() - 1);
        for part in word.split_inclusive('/') {
            let wide = columns(part);
            let room = width(lines.len() - 1);
            if is_long && taken > 0 && taken + wide > room && wide <= room {
                lines.push(String::new());
                taken = 0;
            }
            for grapheme in part.graphemes(true) {
                let wide = grapheme_columns(grapheme);
                if taken + wide > width(lines.len() - 1) && taken > 0 {
                    lines.push(String::new());
                    taken = 0;
                }
                let last = lines.len() - 1;
                lines[last].push_str(grapheme);
                taken += wide;
            }
        }
    }
    lines
}

/// Splits text into the parts between which lines may break: words, but a number and its percent sign together.
fn unbreakable(text: &str) -> Vec<String> {
    let mut parts: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match parts.last_mut() {
            Some(number) if word.starts_with('%') => number.extend([" ", word]),
            _ => parts.push(word.to_owned()),
        }
    }
    parts
}

/// Replaces characters that the terminal does not have.
pub fn to_displayable(text: &str, caps: Capabilities) -> String {
    if caps.unicode {
        return text.to_owned();
    }
    printing::to_ascii(text).replace('\u{e9}', "e")
}

/// The end of `text` that fits into `room` columns, after an ellipsis: names often differ only at their ends.
pub fn shorten_start(text: &str, room: usize, caps: Capabilities) -> String {
    if columns(text) <= room {
        return text.to_owned();
    }
    let more = prefix_within(caps.pick("…", "..."), room);
    format!("{more}{}", suffix_within(text, room - columns(more)))
}

/// Writes `text` right-aligned before column `end`, but never left of `start`.
pub fn write_right(buffer: &mut Buffer, start: u16, end: u16, row: u16, text: &str, style: Style) {
    let x = end.saturating_sub(columns(text) as u16).max(start);
    buffer.set_stringn(x, row, text, usize::from(end.saturating_sub(x)), style);
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn a_number_and_its_percent_sign_stay_on_one_line() {
        assert_eq!(wrap("yellow and red kiss in 8 %.", 24), ["yellow and red kiss in", "8 %."]);
        assert_eq!(wrap("% of 8", 4), ["% of", "8"]);
    }

    #[test]
    fn long_sentences_are_broken_between_words() {
        assert_eq!(wrap("", 5), [""]);
        assert_eq!(wrap("one two three", 7), ["one two", "three"]);
        assert_eq!(wrap("unbreakable a b", 4), ["unbr", "eaka", "ble", "a b"]);
        assert_eq!(wrap("in /home/me/state/last.json: no", 14), ["in", "/home/me/", "state/", "last.json: no"]);
        assert_eq!(wrap("a/unbreakable", 6), ["a/unbr", "eakabl", "e"]);
    }

    #[test]
    fn truncated_text_ends_with_an_ellipsis() {
        let lines = wrap("one two three four", 7);
        assert_eq!(truncate_lines(lines.clone(), 2, 7, Capabilities::NO_COLOUR), ["one two", "three\u{2026}"]);
        assert_eq!(truncate_lines(lines.clone(), 1, 7, Capabilities::ASCII), ["one..."]);
        assert_eq!(truncate_lines(lines.clone(), 3, 7, Capabilities::NO_COLOUR), lines);
        assert_eq!(shorten("one two three four", 7, Capabilities::ASCII), "one...");
    }

    #[test]
    fn hangul_takes_two_columns_an_emoji_too_and_a_combining_mark_none() {
        let family = "\u{1f468}\u{200d}\u{1f469}\u{200d}\u{1f467}";
        for (text, wide) in [("당구", 4), ("a\u{301}b", 2), (family, 2), ("\u{1f3b1}", 2), ("", 0), ("tab\u{7}", 3)] {
            assert_eq!(columns(text), wide, "{text}");
        }
        assert_eq!(wrap("당구 연습 쿠션", 9), ["당구 연습", "쿠션"]);
        assert_eq!(wrap("당구연습", 5), ["당구", "연습"], "half of a syllable cannot be drawn");
        assert_eq!(truncate_lines(wrap("당구 연습 쿠션", 9), 1, 9, Capabilities::NO_COLOUR), ["당구 연…"]);
        assert_eq!(shorten_start("runs/당구연습", 6, Capabilities::NO_COLOUR), "…연습");
        assert_eq!(shorten_start("당구연습", 8, Capabilities::NO_COLOUR), "당구연습");
        assert_eq!(shorten_start("runs", 2, Capabilities::ASCII), "..");
        assert_eq!(prefix_within("e\u{301}e\u{301}", 1), "e\u{301}", "a letter keeps its accent");
        assert_eq!(wrap(&family.repeat(2), 3), [family, family]);
    }

    proptest! {
        #[test]
        fn wrapped_lines_fit_the_width_and_lose_only_blanks(
            text in "([a-z ]|[가-힣]|[\u{1f3b1}\u{301}\u{200d}\u{fe0f}\u{ff9e}]|\\PC){0,60}", width in 2..30_usize,
        ) {
            let lines = wrap(&text, width);
            // A few scripts have characters wider than two columns, which cannot be split.
            let widest = text.graphemes(true).map(grapheme_columns).max().unwrap_or(0).max(width);
            for line in &lines {
                prop_assert!(columns(line) <= widest, "{line:?} is {} wide", columns(line));
            }
            let letters = |text: &str| text.split_whitespace().collect::<String>();
            prop_assert_eq!(letters(&lines.concat()), letters(&text));
            prop_assert!(columns(&shorten_start(&text, width, Capabilities::NO_COLOUR)) <= width);
            prop_assert!(columns(prefix_within(&text, width)) <= width && columns(suffix_within(&text, width)) <= width);
            prop_assert!(columns(&shorten(&text, width, Capabilities::NO_COLOUR)) <= widest);
        }
    }
}
