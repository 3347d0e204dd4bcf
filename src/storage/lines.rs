//! Lines of untrusted input: each is read up to a maximum length, and longer ones are skipped.

use std::io::{self, BufRead, Read};

/// Longest accepted line, bytes; a typical request has a few hundred.
pub const LONGEST_LINE: u64 = 1 << 20;

/// Largest number of bytes skipped in a line that is too long: a device without line ends must not be read forever.
const MOST_SKIPPED: u64 = 1 << 28;

/// Result of reading a line.
#[derive(Debug)]
pub enum NextLine {
    /// A line, including its end if it has one.
    Line,
    /// A line that was too long and was skipped.
    TooLong,
    /// End of the input.
    End,
}

/// Reads the next line into `line`.
///
/// # Errors
/// Returns any error of reading, or an error for a line longer than 2²⁸ bytes.
pub fn next_line(reader: &mut impl BufRead, line: &mut Vec<u8>) -> io::Result<NextLine> {
    line.clear();
    let read = reader.by_ref().take(LONGEST_LINE + 1).read_until(b'\n', line)? as u64;
    if read <= LONGEST_LINE || line.ends_with(b"\n") {
        return Ok(if read > 0 { NextLine::Line } else { NextLine::End });
    }
    line.clear();
    let mut rest = reader.by_ref().take(MOST_SKIPPED);
    if rest.skip_until(b'\n')? as u64 == MOST_SKIPPED {
        let sentence = format!("a line has more than {MOST_SKIPPED} bytes; accepted are up to {LONGEST_LINE}");
        return Err(io::Error::new(io::ErrorKind::InvalidData, sentence));
    }
    Ok(NextLine::TooLong)
}
