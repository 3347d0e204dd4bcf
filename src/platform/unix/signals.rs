//! Signals while the program has the terminal: whatever can be caught gives it back first.
//!
//! KILL and STOP cannot be caught. Those that tell a fault of the program itself (SEGV, BUS, ILL, FPE) can, but a handler
//! would return into the fault. A real-time signal and those below end a program that does not catch them.

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

/// Those that a shell, a user or the system sends in the ordinary course of things. XFSZ is the whole program's: see
/// [`super::refuse_large_files`].
const KNOWN: [i32; 19] = [
    SIGABRT, SIGALRM, SIGCONT, SIGHUP, SIGINT, SIGIO, SIGPROF, SIGQUIT, SIGSYS, SIGTERM, SIGTRAP, SIGTSTP, SIGTTIN,
    SIGTTOU, SIGUSR1, SIGUSR2, SIGVTALRM, SIGWINCH, SIGXCPU,
];

/// The real-time signals, by signal(7).
#[cfg(target_os = "linux")]
const REAL_TIME: std::ops::RangeInclusive<i32> = 34..=64;

/// Catches every signal that can be, and tells `hear` of each on a thread of its own, until that wants no more.
///
/// # Errors
/// Where the system refuses a thread, or a handler for a signal that every system knows.
pub fn listen(mut hear: impl FnMut(Signal) -> bool + Send + 'static) -> io::Result<()> {
    let mut signals = catch()?;
    let listener = move || {
        for signal in signals.forever() {
            // The system says so that another process has the terminal now.
            if matches!(signal, SIGTTIN | SIGTTOU) && !has_the_terminal() {
                let _ = suspend();
                continue;
            }
            if !hear(meaning(signal)) {
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
        // Some C libraries keep a few to themselves.
        let _ = signals.add_signal(signal);
    }
    Ok(signals)
}

const fn meaning(signal: i32) -> Signal {
    match signal {
        SIGWINCH => Signal::Resized,
        SIGCONT => Signal::Continued,
        SIGTSTP | SIGTTIN | SIGTTOU => Signal::Stop,
        other => Signal::End(other),
    }
}

/// Whether the program has the terminal to itself. In the background it may not touch it, not even to give it back.
fn has_the_terminal() -> bool {
    tcgetpgrp(io::stdin()).is_ok_and(|group| group == getpgrp())
}

/// Stops until the shell continues the program.
///
/// # Errors
/// What the system answers.
pub fn suspend() -> io::Result<()> {
    emulate_default_handler(SIGTSTP)
}

/// Ends as this signal ends a program that does not catch it, for the parent to see.
pub fn die(signal: i32) -> ! {
    // It comes back for those that it does not know.
    let _ = emulate_default_handler(signal);
    process::exit(128 + signal)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_signal_but_those_of_a_terminal_ends_the_program() {
        let others = KNOWN.into_iter().filter(|signal| meaning(*signal) != Signal::End(*signal));
        assert!(others.eq([SIGCONT, SIGTSTP, SIGTTIN, SIGTTOU, SIGWINCH]));
        assert_eq!([SIGUSR1, SIGXCPU, 64].map(meaning), [SIGUSR1, SIGXCPU, 64].map(Signal::End));
    }
}
