//! Lines of untrusted input: each is read up to a maximum length, and longer ones are skipped.

use std::io::{self, BufRead, Read};

/// Longest accepted line, bytes; a typical request has a few hundred.
pub const MAX_LINE_BYTES: u64 = 1 << 20;

/// Largest number of bytes skipped in a line that is too long: a device without line ends must not be read forever.
const MAX_SKIPPED_BYTES: u64 = 1 << 28;

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
    let read = reader.by_ref().take(MAX_LINE_BYTES + 1).read_until(b'\n', line)? as u64;
    if read <= MAX_LINE_BYTES || line.ends_with(b"\n") {
        return Ok(if read > 0 { NextLine::Line } else { NextLine::End });
    }
    line.clear();
    let mut rest = reader.by_ref().take(MAX_SKIPPED_BYTES);
    if rest.skip_until(b'\n')? as u64 == MAX_SKIPPED_BYTES {
        let sentence = format!("a line has more than {MAX_SKIPPED_BYTES} bytes; accepted are up to {MAX_LINE_BYTES}");
        return Err(io::Error::new(io::ErrorKind::InvalidData, sentence));
    }
    Ok(NextLine::TooLong)
}
