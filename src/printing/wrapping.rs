//! Line wrapping between words, at the width of the terminal.

use ratatui::text::Span;

/// Accepts text in parts and returns it with lines no longer than the terminal width. Spaces are kept, except at a line break. A word
/// longer than a line is left for the terminal to break.
#[derive(Debug)]
pub(super) struct Wrapping {
    width: usize,
    /// Number of columns of the current line that were already returned.
    column: usize,
    /// Pending spaces, followed by the pending word, which is incomplete.
    blanks: String,
    word: String,
}

impl Wrapping {
    /// Creates a wrapper for lines of `width` columns.
    pub const fn new(width: usize) -> Self {
        Self { width, column: 0, blanks: String::new(), word: String::new() }
    }

    /// Accepts `text` and returns what can be written now.
    pub fn push(&mut self, text: &str) -> String {
        let mut out = String::with_capacity(text.len() + 1);
        for character in text.chars() {
            match character {
                '\n' => {
                    out += &self.rest();
                    out.push('\n');
                }
                ' ' => {
                    self.end_word(&mut out);
                    self.blanks.push(' ');
                }
                _ => self.word.push(character),
            }
        }
        out
    }

    /// Returns the pending text. The next text starts a new line: after a prompt, the user's input ended the line.
    pub fn rest(&mut self) -> String {
        let mut out = String::new();
        self.end_word(&mut out);
        self.column = 0;
        out + &std::mem::take(&mut self.blanks)
    }

    fn end_word(&mut self, out: &mut String) {
        if self.word.is_empty() {
            return;
        }
        let columns = Span::raw(&*self.word).width();
        if self.column > 0 && self.column + self.blanks.len() + columns > self.width {
            out.push('\n');
            self.column = 0;
        } else {
            *out += &self.blanks;
            self.column += self.blanks.len();
        }
        *out += &self.word;
        self.column += columns;
        self.blanks.clear();
        self.word.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wrapped(width: usize, parts: &[&str]) -> String {
        let mut wrapping = Wrapping::new(width);
        let out: String = parts.iter().map(|part| wrapping.push(part)).collect();
        out + &wrapping.rest()
    }

    #[test]
    fn lines_break_between_words_across_split_input() {
        assert_eq!(wrapped(10, &["one two three four\n", "five\n"]), "one two\nthree four\nfive\n");
        assert_eq!(wrapped(10, &["one t", "wo thr", "ee four\nfi", "ve"]), "one two\nthree four\nfive");
        assert_eq!(wrapped(7, &["日本 日本 日本\n"]), "日本\n日本\n日本\n", "each letter is two columns wide");
    }

    #[test]
    fn other_spaces_and_long_words_stay_unchanged() {
        assert_eq!(wrapped(12, &["  a    b\n\n> "]), "  a    b\n\n> ");
        assert_eq!(wrapped(6, &["see https://long.example/page now\n"]), "see\nhttps://long.example/page\nnow\n");
    }

    #[test]
    fn text_after_a_prompt_starts_a_new_line() {
        let mut wrapping = Wrapping::new(8);
        let prompt = wrapping.push("> ") + &wrapping.rest();
        assert_eq!(prompt + &wrapping.push("one two\n"), "> one two\n");
    }
}
