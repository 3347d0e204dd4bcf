//! Child processes.

use std::{os::unix::process::CommandExt, process::Command};

/// Starts the process in its own process group, so that signals from the terminal to this program do not reach it.
pub fn in_own_process_group(command: &mut Command) -> &mut Command {
    command.process_group(0)
}
