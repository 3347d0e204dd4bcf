//! Long commands that are told to stop: they finish what they are at, and a second word ends them at once.

use std::{
    io,
    sync::{Arc, atomic::AtomicBool},
};

use signal_hook::{
    consts::{SIGINT, SIGTERM},
    flag,
};

/// The exit code of a command whose work can go on by the same command, as schedulers know it (`EX_TEMPFAIL` of sysexits.h).
pub const UNFINISHED: u8 = 75;

/// A flag that Ctrl-C and TERM set. With a code, a second one ends the process at once, with that.
///
/// # Errors
/// Where the system refuses a handler.
pub fn stop_when_told(at_once: Option<u8>) -> io::Result<Arc<AtomicBool>> {
    let stop = Arc::new(AtomicBool::new(false));
    for signal in [SIGINT, SIGTERM] {
        if let Some(code) = at_once {
            flag::register_conditional_shutdown(signal, code.into(), Arc::clone(&stop))?;
        }
        flag::register(signal, Arc::clone(&stop))?;
    }
    Ok(stop)
}

/// Goes on where the terminal is hung up, as when an ssh connection breaks.
///
/// # Errors
/// Where the system refuses a handler.
#[cfg_attr(windows, allow(clippy::unnecessary_wraps, reason = "other systems can fail"))]
pub fn outlive_hang_up() -> io::Result<()> {
    #[cfg(unix)]
    flag::register(signal_hook::consts::SIGHUP, Arc::new(AtomicBool::new(false)))?;
    Ok(())
}
