//! The limit that a user or a system may set on the size of files.

use std::{
    io,
    sync::{Arc, atomic::AtomicBool},
};

use signal_hook::{consts::SIGXFSZ, flag};

/// Makes a write beyond the limit on file sizes fail with an error, like a full disk; otherwise a signal ends the process there,
/// without a word and with half a file left.
///
/// # Errors
/// Where the system refuses a handler.
pub fn refuse_large_files() -> io::Result<()> {
    flag::register(SIGXFSZ, Arc::new(AtomicBool::new(false))).map(|_| ())
}
