//! The standard output and the standard error, with control characters escaped.

use std::{
    fmt::Display,
    io::{self, IsTerminal, StderrLock, StdoutLock, Write},
};

use crossterm::terminal::size;

use super::{
    ascii::{needs_ascii, to_ascii},
    visible::{is_hidden, split_at_hidden},
    wrapping::Wrapping,
};

/// A writer that passes text on with all control characters escaped. New lines and tabs pass; bytes that are not UTF-8 become U+FFFD.
#[derive(Debug)]
pub struct EscapingWriter<W: Write> {
    inner: W,
    /// The first bytes of a character whose remaining bytes have not been written yet.
    incomplete: Vec<u8>,
    /// Whether text is transliterated to ASCII.
    is_transliterated: bool,
    /// Line wrapping between words; `None` if lines are not wrapped.
    wrapping: Option<Wrapping>,
}

/// Returns the standard output.
#[expect(clippy::disallowed_methods, reason = "this is the door that the lint leads to")]
pub fn stdout() -> EscapingWriter<StdoutLock<'static>> {
    EscapingWriter::at_terminal(io::stdout().lock())
}

/// Returns the standard error.
#[expect(clippy::disallowed_methods, reason = "this is the door that the lint leads to")]
pub fn stderr() -> EscapingWriter<StderrLock<'static>> {
    EscapingWriter::at_terminal(io::stderr().lock())
}

/// Whether the standard error is a terminal.
#[expect(clippy::disallowed_methods, reason = "nothing is written")]
pub fn is_stderr_terminal() -> bool {
    io::stderr().is_terminal()
}

/// Writes `text` over the current terminal line of the standard error.
///
/// # Errors
/// Returns the error of the output.
pub fn redraw_line(text: impl Display) -> io::Result<()> {
    clear_line()?;
    write!(stderr(), "{text}")
}

/// Clears the current terminal line of the standard error.
///
/// # Errors
/// Returns the error of the output.
pub fn clear_line() -> io::Result<()> {
    stderr().inner.write_all(b"\r\x1b[K")
}

impl<W: Write + IsTerminal> EscapingWriter<W> {
    /// Transliterates if the locale requires it; wraps lines at the width of the terminal if `inner` is one.
    fn at_terminal(inner: W) -> Self {
        let size = inner.is_terminal().then(size).and_then(Result::ok);
        let wrapping = size.filter(|(columns, _)| *columns > 0).map(|(columns, _)| Wrapping::new(usize::from(columns)));
        Self { inner, incomplete: Vec::new(), is_transliterated: needs_ascii(), wrapping }
    }
}

impl<W: Write> EscapingWriter<W> {
    /// Wraps `inner`, without transliteration and without line wrapping.
    pub const fn new(inner: W) -> Self {
        Self { inner, incomplete: Vec::new(), is_transliterated: false, wrapping: None }
    }

    /// Turns transliteration and line wrapping off if `is_exact`: for JSON, and for text meant for a file.
    #[must_use]
    pub fn exact(mut self, is_exact: bool) -> Self {
        if is_exact {
            (self.is_transliterated, self.wrapping) = (false, None);
        }
        self
    }

    fn write_wrapped(&mut self, text: &str) -> io::Result<()> {
        match &mut self.wrapping {
            Some(wrapping) => self.inner.write_all(wrapping.push(text).as_bytes()),
            None => self.inner.write_all(text.as_bytes()),
        }
    }

    fn write_pending(&mut self) -> io::Result<()> {
        let rest = self.wrapping.as_mut().map(Wrapping::rest).unwrap_or_default();
        self.inner.write_all(rest.as_bytes())
    }

    fn write_escaped(&mut self, text: &str) -> io::Result<()> {
        let is_obeyed = |character: char| is_hidden(character) && !matches!(character, '\n' | '\t');
        let spelling = if self.is_transliterated { to_ascii(text) } else { text.into() };
        for (plain, hidden) in split_at_hidden(&spelling, is_obeyed) {
            self.write_wrapped(plain)?;
            if let Some(hidden) = hidden {
                self.write_wrapped(&hidden.escape_default().to_string())?;
            }
        }
        Ok(())
    }
}

impl<W: Write> Write for EscapingWriter<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let joined;
        let bytes_now = if self.incomplete.is_empty() {
            bytes
        } else {
            joined = [self.incomplete.as_slice(), bytes].concat();
            self.incomplete.clear();
            &joined
        };
        let mut left = bytes_now;
        loop {
            match std::str::from_utf8(left) {
                Ok(text) => {
                    self.write_escaped(text)?;
                    return Ok(bytes.len());
                }
                Err(error) => {
                    let (good, bad) = left.split_at(error.valid_up_to());
                    self.write_escaped(std::str::from_utf8(good).unwrap_or_default())?;
                    let Some(length) = error.error_len() else {
                        self.incomplete.extend_from_slice(bad);
                        return Ok(bytes.len());
                    };
                    self.write_escaped("\u{fffd}")?;
                    left = &bad[length..];
                }
            }
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        self.write_pending()?;
        self.inner.flush()
    }
}

impl<W: Write> Drop for EscapingWriter<W> {
    fn drop(&mut self) {
        // Errors cannot be reported from here.
        let _ = if self.incomplete.is_empty() { Ok(()) } else { self.write_wrapped("\u{fffd}") };
        let _ = self.write_pending();
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn shown(parts: &[&[u8]]) -> String {
        let mut bytes = Vec::new();
        let mut out = EscapingWriter::new(&mut bytes);
        for part in parts {
            out.write_all(part).unwrap();
        }
        drop(out);
        String::from_utf8(bytes).unwrap()
    }

    #[test]
    fn exact_output_is_neither_transliterated_nor_wrapped() {
        let said = |is_exact| {
            let mut bytes = Vec::new();
            let mut out = EscapingWriter {
                inner: &mut bytes,
                incomplete: Vec::new(),
                is_transliterated: true,
                wrapping: Some(Wrapping::new(9)),
            }
            .exact(is_exact);
            write!(out, "3\u{b0} \u{b1} 1").unwrap();
            drop(out);
            String::from_utf8(bytes).unwrap()
        };
        assert_eq!([said(false), said(true)], ["3 degrees\n+- 1", "3\u{b0} \u{b1} 1"]);
    }

    #[test]
    fn escape_sequences_are_escaped_across_split_writes() {
        assert_eq!(shown(&[b"a\x1b[2J", b"b\r\n"]), "a\\u{1b}[2Jb\\r\n");
        assert_eq!(shown(&[b"\xc2", b"\x9b31m"]), "\\u{9b}31m", "C1 in two writes");
        assert_eq!(shown(&[b"\xc3\xa9\t\xff\xe2\x80"]), "\u{e9}\t\u{fffd}\u{fffd}");
    }

    proptest! {
        #[test]
        fn no_control_characters_are_written(parts in prop::collection::vec(prop::collection::vec(any::<u8>(), 0..40), 0..6)) {
            let parts: Vec<&[u8]> = parts.iter().map(Vec::as_slice).collect();
            prop_assert!(!shown(&parts).chars().any(|character| is_hidden(character) && !matches!(character, '\n' | '\t')));
        }

        #[test]
        fn text_without_control_characters_is_unchanged(text in "[ -~äöü°±─█\n\t]{0,60}", cut in 0_usize..60) {
            let (first, second) = text.as_bytes().split_at(cut.min(text.len()));
            prop_assert_eq!(shown(&[first, second]), text);
        }
    }
}
