//! Clean stop of long commands: on the first signal they finish the current step; a second signal can end them at once.

use std::{
    io,
    sync::{Arc, atomic::AtomicBool},
};

use signal_hook::{
    consts::{SIGINT, SIGTERM},
    flag,
};

/// Exit code of a command that was stopped and can be resumed by the same command; schedulers know it (`EX_TEMPFAIL` of sysexits.h).
pub const UNFINISHED: u8 = 75;

/// Returns a flag that SIGINT (Ctrl-C) and SIGTERM set. With `at_once`, a second signal ends the process immediately with that exit code.
///
/// # Errors
/// Fails if the system refuses a signal handler.
pub fn stop_on_signal(at_once: Option<u8>) -> io::Result<Arc<AtomicBool>> {
    let stop = Arc::new(AtomicBool::new(false));
    for signal in [SIGINT, SIGTERM] {
        if let Some(code) = at_once {
            flag::register_conditional_shutdown(signal, code.into(), Arc::clone(&stop))?;
        }
        flag::register(signal, Arc::clone(&stop))?;
    }
    Ok(stop)
}

/// Lets the process survive SIGHUP, the signal of a closed terminal, such as a broken ssh connection.
///
/// # Errors
/// Fails if the system refuses a signal handler.
#[cfg_attr(windows, allow(clippy::unnecessary_wraps, reason = "other systems can fail"))]
pub fn ignore_hang_up() -> io::Result<()> {
    #[cfg(unix)]
    flag::register(signal_hook::consts::SIGHUP, Arc::new(AtomicBool::new(false)))?;
    Ok(())
}
