//! Operating-system services under the same names on every system: files, signals, the terminal, processes.
//!
//! `unix` is the tested implementation. `windows` compiles; `docs/install.md` lists what is untested there.

pub mod parallel;
mod stop;
#[cfg(unix)]
#[path = "unix/mod.rs"]
mod system;
#[cfg(windows)]
#[path = "windows/mod.rs"]
mod system;

pub use self::{
    parallel::{limit_threads, thread_count},
    stop::{UNFINISHED, ignore_hang_up, stop_on_signal},
    system::{
        CAN_SUSPEND, CLOCK_NAME, Input, NEEDS_TERM, discard_pending_output, exit_by_signal, file_identity, free_space,
        handle_signals, in_own_process_group, lacks_locks, refuse_large_files, suspend, sync_folder, terminal_output,
        thread_time, use_umask_permissions,
    },
};

/// A signal, classified by how the screen reacts to it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Signal {
    /// The terminal was resized.
    Resized,
    /// The program was continued after a stop.
    Continued,
    /// The program must stop until it is continued.
    Stop,
    /// The program must end; the number is the system's signal number.
    End(i32),
}

/// Result of waiting for terminal input.
#[derive(Debug)]
pub enum TerminalInput {
    /// Number of bytes read.
    Bytes(usize),
    /// An event that the system itself decoded.
    Event(crossterm::event::Event),
    /// The timeout expired without input.
    Timeout,
    /// The terminal is gone: there will be no more input.
    Closed,
}
