//! Text output for people and for other programs: the standard output, the standard error and the log.
//!
//! Names in files, arguments and system messages are untrusted. A terminal obeys some characters instead of showing them: escape sequences
//! change its title or its clipboard, and bidirectional marks reverse text. Therefore all output goes through [`stdout`] and [`stderr`],
//! which escape such characters; clippy forbids other ways (`clippy.toml`). If the locale has no UTF-8, both also transliterate text to
//! ASCII, except JSON and text meant for a file.

mod calendar;
mod json;
mod number;
mod progress;
mod shell;
mod shown;
mod spelling;
mod version;
mod visible;
mod wrapping;

pub use self::{
    calendar::{moment, now, timestamp, timestamp_of},
    json::{json_line, json_text},
    number::{fixed, number, typed_number},
    progress::ProgressLine,
    shell::shell_word,
    shown::{Shown, clear_line, is_watched, redraw_line, stderr, stdout},
    spelling::{is_unicode, is_windows_terminal, spelt},
    version::{FULL_VERSION, SOURCE, TARGET, VERSION},
    visible::{OneLine, is_hidden},
};
