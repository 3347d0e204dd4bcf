//! Lines that break between words, where a terminal would break them at its last column.

use ratatui::text::Span;

/// Takes text in, and gives it on with lines that are no longer than a terminal is wide. Blanks stay, but where a line breaks; a word
/// that is longer than a line is the terminal's to break.
#[derive(Debug)]
pub(super) struct Wrapping {
    width: usize,
    /// Columns of the line that have gone out.
    column: usize,
    /// The blanks and the word after them that wait for the word's end.
    blanks: String,
    word: String,
}

impl Wrapping {
    /// For lines of so many columns.
    pub const fn new(width: usize) -> Self {
        Self { width, column: 0, blanks: String::new(), word: String::new() }
    }

    /// What can go out when `text` has come in.
    pub fn take(&mut self, text: &str) -> String {
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

    /// What has waited. What comes next begins a line: after a prompt the user has ended it.
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
        let out: String = parts.iter().map(|part| wrapping.take(part)).collect();
        out + &wrapping.rest()
    }

    #[test]
    fn a_line_breaks_between_words_however_it_comes_in() {
        assert_eq!(wrapped(10, &["one two three four\n", "five\n"]), "one two\nthree four\nfive\n");
        assert_eq!(wrapped(10, &["one t", "wo thr", "ee four\nfi", "ve"]), "one two\nthree four\nfive");
        assert_eq!(wrapped(7, &["日本 日本 日本\n"]), "日本\n日本\n日本\n", "each letter is two columns wide");
    }

    #[test]
    fn blanks_stay_where_no_line_breaks_and_a_long_word_is_left_alone() {
        assert_eq!(wrapped(12, &["  a    b\n\n> "]), "  a    b\n\n> ");
        assert_eq!(wrapped(6, &["see https://long.example/page now\n"]), "see\nhttps://long.example/page\nnow\n");
    }

    #[test]
    fn an_answer_begins_a_line_whatever_the_prompt_before_it() {
        let mut wrapping = Wrapping::new(8);
        let prompt = wrapping.take("> ") + &wrapping.rest();
        assert_eq!(prompt + &wrapping.take("one two\n"), "> one two\n");
    }
}
