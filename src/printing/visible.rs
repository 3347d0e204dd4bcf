//! Control and invisible characters, and escaping them.

use std::fmt::{self, Display, Write};

/// Whether a terminal obeys or hides `character` instead of showing it: control characters (C0, DEL, C1), bidirectional and invisible
/// marks, line and paragraph separators, and tags. New lines and tabs count, too; the caller knows if they belong to the text. Joiners of
/// letters and emoji do not count.
pub fn is_hidden(character: char) -> bool {
    character.is_control()
        || matches!(
            character,
            '\u{61c}'
                | '\u{180e}'
                | '\u{200b}' | '\u{200e}'..='\u{200f}'
                | '\u{2028}'..='\u{202e}'
                | '\u{2060}'..='\u{206f}'
                | '\u{feff}'
                | '\u{fff9}'..='\u{fffb}'
                | '\u{e0000}'..='\u{e007f}'
        )
}

/// Splits `text` after each character for which `is_obeyed` is true: yields the plain text before it and the character, which the last part
/// may lack.
pub(super) fn split_at_hidden(
    text: &str,
    is_obeyed: impl Fn(char) -> bool + Copy,
) -> impl Iterator<Item = (&str, Option<char>)> {
    text.split_inclusive(is_obeyed).map(move |part| match part.chars().next_back().filter(|last| is_obeyed(*last)) {
        Some(last) => (&part[..part.len() - last.len_utf8()], Some(last)),
        None => (part, None),
    })
}

/// Text on one line: all control characters, including new lines, are escaped. For names that others chose.
#[derive(Clone, Copy, Debug)]
pub struct OneLine<T>(pub T);

impl<T: Display> Display for OneLine<T> {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(Escaping(out), "{}", self.0)
    }
}

struct Escaping<'a, 'b>(&'a mut fmt::Formatter<'b>);

impl Write for Escaping<'_, '_> {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        for (plain, hidden) in split_at_hidden(text, is_hidden) {
            self.0.write_str(plain)?;
            if let Some(hidden) = hidden {
                write!(self.0, "{}", hidden.escape_default())?;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn control_characters_are_escaped_and_other_text_stays() {
        let title = OneLine("\u{1b}]0;pwn\u{7}\u{9b}31m\u{202e}x\n\ty\u{7f}").to_string();
        assert_eq!(title, "\\u{1b}]0;pwn\\u{7}\\u{9b}31m\\u{202e}x\\n\\ty\\u{7f}");
        let plain = "Größe ° ± é 台 ●▀ \"quoted\" \\";
        assert_eq!(OneLine(plain).to_string(), plain);
    }
}
