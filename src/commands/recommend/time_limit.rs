//! Time limit for optional explanations of a shot: on a very stiff table they could take too long.

use std::{sync::mpsc, thread, time::Duration};

use crate::commands::{Failure, output::print_note};

/// Time limit of one explanation. On a real table it takes a tenth of this.
const TIME_LIMIT: Duration = Duration::from_secs(3);

/// Returns the result of `find` if it is ready in time; otherwise reports on the standard error that `what` is left out.
pub fn with_time_limit<T: Send + 'static, E: std::fmt::Display + Send + 'static>(
    what: &str,
    find: impl FnOnce() -> Result<T, E> + Send + 'static,
) -> Result<Option<T>, Failure> {
    let (sender, found) = mpsc::channel();
    // A late result is ignored; the thread ends with the program.
    thread::spawn(move || drop(sender.send(find())));
    match found.recv_timeout(TIME_LIMIT) {
        Ok(found) => return found.map(Some).map_err(Failure::wrong_input),
        Err(mpsc::RecvTimeoutError::Timeout) => print_note(format_args!(
            "note: {what} take more than {} s on this table and are left out",
            TIME_LIMIT.as_secs()
        )),
        // The failure itself has been reported by the thread.
        Err(mpsc::RecvTimeoutError::Disconnected) => print_note(format_args!("note: {what} are left out")),
    }
    Ok(None)
}
