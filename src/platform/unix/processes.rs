//! Processes that this one starts.

use std::{os::unix::process::CommandExt, process::Command};

/// Has a process start in a group of its own: what the terminal sends to this program does not reach it.
pub fn own_group(command: &mut Command) -> &mut Command {
    command.process_group(0)
}
