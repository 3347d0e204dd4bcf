//! Windows: crossterm's own events, no signals but Ctrl-C, and rights as folders hand them down.

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

use crate::platform::{Came, Signal};

/// What the clock shows, for reports.
pub const CLOCK: &str = "wall time";

/// Whether the shell can stop the program and let it go on.
pub const CAN_SUSPEND: bool = false;

/// Whether a terminal says in `TERM` that it is one.
pub const NEEDS_TERM: bool = false;

/// `CREATE_NEW_PROCESS_GROUP` of the Windows API: Ctrl-C does not reach the process.
const NEW_GROUP: u32 = 0x0000_0200;

/// Time on the wall's clock, where the thread's own is not to be had without unsafe code.
pub fn thread_time() -> Duration {
    static START: LazyLock<Instant> = LazyLock::new(Instant::now);
    START.elapsed()
}

/// New files have the rights that their folder hands down: nothing is to be done.
pub const fn for_all_to_read(_: &mut tempfile::Builder<'_, '_>) {}

/// A file's number is not to be had from what is known of it; its time and length have to do.
pub const fn file_identity(_: &Metadata) -> u64 {
    0
}

/// A folder cannot be opened here to be synced: its names are the file system's business.
///
/// # Errors
/// None.
pub const fn sync_folder(_: &Path) -> io::Result<()> {
    Ok(())
}

/// Bytes that may still be written where `path` is: not told without unsafe code.
///
/// # Errors
/// None.
pub const fn free_space(_: &Path) -> io::Result<Option<u64>> {
    Ok(None)
}

/// There is no limit on the size of files that a signal would tell of.
///
/// # Errors
/// None.
pub const fn refuse_large_files() -> io::Result<()> {
    Ok(())
}

/// Has a process start in a group of its own: Ctrl-C does not reach it.
pub fn own_group(command: &mut Command) -> &mut Command {
    command.creation_flags(NEW_GROUP)
}

/// What comes from the console, as events.
#[derive(Debug)]
pub struct Input;

impl Input {
    /// The console.
    pub const fn open() -> Self {
        Self
    }

    /// Waits for an event, up to `patience` if that is given.
    ///
    /// # Errors
    /// What the console answers.
    pub fn next(&mut self, _: &mut [u8], patience: Option<Duration>) -> io::Result<Came> {
        if !io::stdin().is_terminal() {
            return Ok(Came::Gone);
        }
        match patience {
            Some(time) if !crossterm::event::poll(time)? => Ok(Came::Silence),
            _ => crossterm::event::read().map(Came::Event),
        }
    }
}

/// The console that pictures go to, past all buffers.
///
/// # Errors
/// Where the process has no room for another file.
#[expect(clippy::disallowed_methods, reason = "a screen is control characters; text goes through the ANSI backend")]
pub fn terminal_output() -> io::Result<File> {
    Ok(File::from(io::stdout().as_handle().try_clone_to_owned()?))
}

/// Nothing holds a console's output up that could be thrown away.
pub fn free_the_screen() -> ! {
    loop {
        thread::park();
    }
}

/// In raw mode Ctrl-C is a key, and the size of the console is an event: there are no signals to hear.
///
/// # Errors
/// None.
pub fn listen(_: impl FnMut(Signal) -> bool + Send + 'static) -> io::Result<()> {
    Ok(())
}

/// A console has no way to stop a program until it is continued.
///
/// # Errors
/// Always.
pub fn suspend() -> io::Result<()> {
    Err(io::Error::from(io::ErrorKind::Unsupported))
}

/// Ends with the exit code that shells give to a program which a signal has ended.
pub fn die(signal: i32) -> ! {
    process::exit(128 + signal)
}
