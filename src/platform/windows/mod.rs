//! Windows: crossterm's own events, no signals except Ctrl-C, and inherited permissions.

use std::{
    fs::{File, Metadata},
    io::{self, IsTerminal},
    os::windows::{io::AsHandle, process::CommandExt},
    path::Path,
    process::{self, Command},
    sync::LazyLock,
    thread,
    time::{Duration, Instant},
};

use crate::platform::{Signal, TerminalInput};

/// Name of the clock, for reports.
pub const CLOCK_NAME: &str = "wall time";

/// Whether the shell can suspend the program and continue it.
pub const CAN_SUSPEND: bool = false;

/// Whether a terminal identifies itself in the variable `TERM`.
pub const NEEDS_TERM: bool = false;

/// `CREATE_NEW_PROCESS_GROUP` of the Windows API: Ctrl-C does not reach the child process.
const NEW_GROUP: u32 = 0x0000_0200;

/// Returns wall time: the thread's CPU time is not available here without unsafe code.
pub fn thread_time() -> Duration {
    static START: LazyLock<Instant> = LazyLock::new(Instant::now);
    START.elapsed()
}

/// Does nothing: new files inherit the permissions of their folder.
pub const fn use_umask_permissions(_: &mut tempfile::Builder<'_, '_>) {}

/// Returns zero: the metadata contains no file number here, so callers depend on its time and length.
pub const fn file_identity(_: &Metadata) -> u64 {
    0
}

/// Whether a request for a lock failed because the file system has none.
pub fn lacks_locks(error: &io::Error) -> bool {
    error.kind() == io::ErrorKind::Unsupported
}

/// Does nothing: folders cannot be opened and synced here, and the file system is responsible for names.
///
/// # Errors
/// Never fails.
pub const fn sync_folder(_: &Path) -> io::Result<()> {
    Ok(())
}

/// Returns `None`: the free space is not available without unsafe code.
pub const fn free_space(_: &Path) -> Option<u64> {
    None
}

/// Does nothing: there is no file size limit that is reported by a signal.
///
/// # Errors
/// Never fails.
pub const fn refuse_large_files() -> io::Result<()> {
    Ok(())
}

/// Starts the process in its own process group, so that Ctrl-C does not reach it.
pub fn in_own_process_group(command: &mut Command) -> &mut Command {
    command.creation_flags(NEW_GROUP)
}

/// Console input as events.
#[derive(Debug)]
pub struct Input;

impl Input {
    /// Returns the console.
    pub const fn open() -> Self {
        Self
    }

    /// Waits for an event, at most `timeout` if it is given.
    ///
    /// # Errors
    /// Returns the error of the console.
    pub fn next(&mut self, _: &mut [u8], timeout: Option<Duration>) -> io::Result<TerminalInput> {
        if !io::stdin().is_terminal() {
            return Ok(TerminalInput::Closed);
        }
        match timeout {
            Some(time) if !crossterm::event::poll(time)? => Ok(TerminalInput::Timeout),
            _ => crossterm::event::read().map(TerminalInput::Event),
        }
    }
}

/// Returns the console for drawing the screen, without any buffer.
///
/// # Errors
/// Fails if the process cannot open another file.
#[expect(clippy::disallowed_methods, reason = "a screen is control characters; text goes through the ANSI backend")]
pub fn terminal_output() -> io::Result<File> {
    Ok(File::from(io::stdout().as_handle().try_clone_to_owned()?))
}

/// Sleeps forever: console output never blocks, so there is nothing to discard.
pub fn discard_pending_output() -> ! {
    loop {
        thread::park();
    }
}

/// Does nothing: in raw mode Ctrl-C is a key and a resize is an event, so there are no signals to handle.
///
/// # Errors
/// Never fails.
pub fn handle_signals(_: impl FnMut(Signal) -> bool + Send + 'static) -> io::Result<()> {
    Ok(())
}

/// A console cannot suspend a program.
///
/// # Errors
/// Always fails.
pub fn suspend() -> io::Result<()> {
    Err(io::Error::from(io::ErrorKind::Unsupported))
}

/// Ends the process with the exit code that shells report for a program ended by this signal.
pub fn exit_by_signal(signal: i32) -> ! {
    process::exit(128 + signal)
}
