//! Lines of an input that nobody vouches for: each is read up to a length, and one that is longer is passed over.

use std::io::{self, BufRead, Read};

/// Longest line, bytes; a question has some hundred.
pub const LONGEST_LINE: u64 = 1 << 20;

/// Most bytes of a line that is too long that are passed over: a device that has no lines at all comes to an end.
const MOST_PASSED_OVER: u64 = 1 << 28;

/// What comes next of the input.
#[derive(Debug)]
pub enum NextLine {
    /// A line, with its end if it has one.
    Line,
    /// One that is too long, passed over.
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
    let mut rest = reader.by_ref().take(MOST_PASSED_OVER);
    if rest.skip_until(b'\n')? as u64 == MOST_PASSED_OVER {
        let sentence = format!("a line has more than {MOST_PASSED_OVER} bytes, and accepted are up to {LONGEST_LINE}");
        return Err(io::Error::new(io::ErrorKind::InvalidData, sentence));
    }
    Ok(NextLine::TooLong)
}
