//! Text output for people and for other programs: the standard output, the standard error and the log.
//!
//! Names in files, arguments and system messages are untrusted. A terminal obeys some characters instead of showing them: escape sequences
//! change its title or its clipboard, and bidirectional marks reverse text. Therefore all output goes through [`stdout`] and [`stderr`],
//! which escape such characters; clippy forbids other ways (`clippy.toml`). If the locale has no UTF-8, both also transliterate text to
//! ASCII, except JSON and text meant for a file.

mod ascii;
mod calendar;
mod escaping_writer;
mod json;
mod number;
mod progress;
mod shell;
mod similar;
mod version;
mod visible;
mod wrapping;

pub use self::{
    ascii::{is_unicode, is_windows_terminal, to_ascii},
    calendar::{format_timestamp, format_utc, local_time, now, timestamp, unix_seconds},
    escaping_writer::{EscapingWriter, clear_line, is_stderr_terminal, redraw_line, stderr, stdout},
    json::{json_line, json_text},
    number::{fixed, number, parse_number},
    progress::ProgressLine,
    shell::shell_word,
    similar::{did_you_mean, most_similar},
    version::{COMMIT, FULL_VERSION, TARGET, VERSION},
    visible::{OneLine, is_hidden},
};
