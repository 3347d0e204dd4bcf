//! What is said of a shot besides its inputs must not keep anybody waiting: a table may be stiff beyond any use.

use std::{sync::mpsc, thread, time::Duration};

use crate::commands::{Failure, output::tell};

/// Longest time that one of these may take. On a table that exists they take a tenth.
const LONGEST: Duration = Duration::from_secs(3);

/// What `find` gives, where it does so in time; otherwise that `what` is left out is told on the standard error.
pub fn in_time<T: Send + 'static, E: std::fmt::Display + Send + 'static>(
    what: &str,
    find: impl FnOnce() -> Result<T, E> + Send + 'static,
) -> Result<Option<T>, Failure> {
    let (sender, found) = mpsc::channel();
    // Nobody waits for one that takes longer; it ends with the program.
    thread::spawn(move || drop(sender.send(find())));
    if let Ok(found) = found.recv_timeout(LONGEST) {
        return found.map(Some).map_err(Failure::wrong_input);
    }
    tell(format_args!("note: {what} take more than {} s on this table and are left out", LONGEST.as_secs()));
    Ok(None)
}
