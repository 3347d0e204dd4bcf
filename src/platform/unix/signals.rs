//! Signals while the program controls the terminal: each signal that can be caught first restores the terminal.
//!
//! SIGKILL and SIGSTOP cannot be caught. Signals of a fault in the program itself (SEGV, BUS, ILL, FPE) can, but the handler would return
//! into the fault. A real-time signal or one of those listed below ends a program that does not catch it.

use std::{io, process};

use rustix::{
    process::{Signal as Known, getpgrp},
    termios::tcgetpgrp,
};
use signal_hook::{
    consts::{
        SIGABRT, SIGALRM, SIGCONT, SIGHUP, SIGINT, SIGIO, SIGPROF, SIGQUIT, SIGSYS, SIGTERM, SIGTRAP, SIGTSTP, SIGTTIN,
        SIGTTOU, SIGUSR1, SIGUSR2, SIGVTALRM, SIGWINCH, SIGXCPU,
    },
    iterator::Signals,
    low_level::emulate_default_handler,
};

use crate::platform::Signal;

/// Signals that a shell, a user or the system sends in normal operation. XFSZ is handled for the whole program: see
/// [`super::refuse_large_files`].
const KNOWN: [i32; 19] = [
    SIGABRT, SIGALRM, SIGCONT, SIGHUP, SIGINT, SIGIO, SIGPROF, SIGQUIT, SIGSYS, SIGTERM, SIGTRAP, SIGTSTP, SIGTTIN,
    SIGTTOU, SIGUSR1, SIGUSR2, SIGVTALRM, SIGWINCH, SIGXCPU,
];

/// The real-time signals, according to signal(7).
#[cfg(target_os = "linux")]
const REAL_TIME: std::ops::RangeInclusive<i32> = 34..=64;

/// Catches every signal that can be caught and passes each to `on_signal` on a separate thread, until `on_signal` returns false.
///
/// # Errors
/// Fails if the system refuses the thread, or a handler for a signal that every system knows.
pub fn handle_signals(mut on_signal: impl FnMut(Signal) -> bool + Send + 'static) -> io::Result<()> {
    let mut signals = catch()?;
    let listener = move || {
        for signal in signals.forever() {
            // The system sends these when another process controls the terminal.
            if matches!(signal, SIGTTIN | SIGTTOU) && !has_the_terminal() {
                let _ = suspend();
                continue;
            }
            if !on_signal(classify(signal)) {
                break;
            }
        }
    };
    std::thread::Builder::new().name("signals".into()).spawn(listener).map(|_| ())
}

fn catch() -> io::Result<Signals> {
    let signals = Signals::new(KNOWN)?;
    #[cfg(target_os = "linux")]
    for signal in REAL_TIME.chain([Known::POWER.as_raw(), Known::STKFLT.as_raw()]) {
        // Some C libraries reserve a few signals for themselves.
        let _ = signals.add_signal(signal);
    }
    Ok(signals)
}

const fn classify(signal: i32) -> Signal {
    match signal {
        SIGWINCH => Signal::Resized,
        SIGCONT => Signal::Continued,
        SIGTSTP | SIGTTIN | SIGTTOU => Signal::Stop,
        other => Signal::End(other),
    }
}

/// Whether the program is in the foreground. In the background it must not touch the terminal, not even to restore it.
fn has_the_terminal() -> bool {
    tcgetpgrp(io::stdin()).is_ok_and(|group| group == getpgrp())
}

/// Suspends the program until the shell continues it.
///
/// # Errors
/// Returns the error of the system.
pub fn suspend() -> io::Result<()> {
    emulate_default_handler(SIGTSTP)
}

/// Ends the process as the uncaught signal would, so that the parent process sees the signal.
pub fn exit_by_signal(signal: i32) -> ! {
    // The call returns for signals that it does not know.
    let _ = emulate_default_handler(signal);
    process::exit(128 + signal)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_signals_except_terminal_signals_end_the_program() {
        let others = KNOWN.into_iter().filter(|signal| classify(*signal) != Signal::End(*signal));
        assert!(others.eq([SIGCONT, SIGTSTP, SIGTTIN, SIGTTOU, SIGWINCH]));
        assert_eq!([SIGUSR1, SIGXCPU, 64].map(classify), [SIGUSR1, SIGXCPU, 64].map(Signal::End));
    }
}
