//! Unix: Linux, where all of it is tested, and similar systems.

mod clock;
mod files;
mod input;
mod signals;

use std::{os::unix::process::CommandExt, process::Command};

pub use self::{
    clock::{CLOCK_NAME, thread_time},
    files::{file_identity, free_space, lacks_locks, refuse_large_files, sync_folder, use_umask_permissions},
    input::{Input, discard_pending_output, terminal_output},
    signals::{exit_by_signal, handle_signals, suspend},
};

/// Whether the shell can suspend the program and continue it.
pub const CAN_SUSPEND: bool = true;

/// Whether a terminal identifies itself in the variable `TERM`.
pub const NEEDS_TERM: bool = true;

/// Starts the process in its own process group, so that signals from the terminal to this program do not reach it.
pub fn in_own_process_group(command: &mut Command) -> &mut Command {
    command.process_group(0)
}
