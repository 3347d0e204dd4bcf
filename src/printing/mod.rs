//! What goes out to people and to other programs: every word on the standard output, the standard error and in the log.
//!
//! Names in files, arguments and answers of the system are written by anybody. A terminal obeys some characters instead of
//! showing them (escape sequences change its title or its clipboard, and bidirectional marks turn text around), so none of
//! those goes out: [`stdout`] and [`stderr`] are the only doors, clippy refuses the others (`clippy.toml`), and both show
//! such a character as what it is. Where the locale has no UTF-8 they spell what they are given, but for JSON and what is meant for a file.

mod calendar;
mod json;
mod number;
mod progress;
mod shell;
mod shown;
mod spelling;
mod version;
mod visible;

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
