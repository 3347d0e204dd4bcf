//! Lines of untrusted input: each is read up to a length, and one that is longer is skipped.

use std::io::{self, BufRead, Read};

/// Longest line, bytes; a question has some hundred.
pub const LONGEST_LINE: u64 = 1 << 20;

/// Most bytes that are skipped of a line that is too long: so a device without any ends of lines comes to an end.
const MOST_SKIPPED: u64 = 1 << 28;

/// What comes next of the input.
#[derive(Debug)]
pub enum NextLine {
    /// A line, with its end if it has one.
    Line,
    /// One that was too long, and was skipped.
    TooLong,
    /// Nothing.
    End,
}

/// Reads the next line into `line`.
///
/// # Errors
/// Whatever reading reports; and a line that goes on for 2²⁸ bytes.
pub fn next_line(reader: &mut impl BufRead, line: &mut Vec<u8>) -> io::Result<NextLine> {
    line.clear();
    let read = reader.by_ref().take(LONGEST_LINE + 1).read_until(b'\n', line)? as u64;
    if read <= LONGEST_LINE || line.ends_with(b"\n") {
        return Ok(if read > 0 { NextLine::Line } else { NextLine::End });
    }
    line.clear();
    let mut rest = reader.by_ref().take(MOST_SKIPPED);
    if rest.skip_until(b'\n')? as u64 == MOST_SKIPPED {
        let sentence = format!("a line has more than {MOST_SKIPPED} bytes, and accepted are up to {LONGEST_LINE}");
        return Err(io::Error::new(io::ErrorKind::InvalidData, sentence));
    }
    Ok(NextLine::TooLong)
}
