//! What operating systems do each in its own way, under the same names on all of them: files, signals, the terminal, processes.
//!
//! `unix` is what everything is tested on. `windows` builds; what of it could not be tried is said in `docs/install.md`.

pub mod parallel;
mod stop;
#[cfg(unix)]
#[path = "unix/mod.rs"]
mod system;
#[cfg(windows)]
#[path = "windows/mod.rs"]
mod system;
mod threads;

pub use self::{
    stop::{UNFINISHED, outlive_hang_up, stop_when_told},
    system::{
        CAN_SUSPEND, CLOCK, Input, NEEDS_TERM, die, file_identity, for_all_to_read, free_space, free_the_screen,
        listen, own_group, refuse_large_files, suspend, sync_folder, terminal_output, thread_time,
    },
    threads::{limit_threads, threads},
};

/// A signal, by what the screen does about it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Signal {
    /// The terminal has another size.
    Resized,
    /// The program goes on after it was stopped.
    Continued,
    /// The program shall stop until it is continued.
    Stop,
    /// The program ends; the number is the system's.
    End(i32),
}

/// What comes of waiting for the terminal's input.
#[derive(Debug)]
pub enum Came {
    /// So many bytes.
    Bytes(usize),
    /// What the system itself has made of the input.
    Event(crossterm::event::Event),
    /// Nothing came in time.
    Silence,
    /// There will be no more: the terminal is gone.
    Gone,
}
