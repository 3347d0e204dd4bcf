//! The program: parses the command line, runs it, and turns failures into a sentence and an exit code.

// The disallowed macros and methods are listed in clippy.toml.
#![cfg_attr(not(test), warn(clippy::disallowed_macros, clippy::disallowed_methods))]

use std::{io::Write, process::ExitCode};

use carom::{commands::Cli, printing};

// malloc and free take a quarter of the time of a small network's update; mimalloc alone makes training 1.3 to 3 times faster. It is built
// without huge pages (`no_thp`): each of them makes 2 MB resident as soon as one byte is used (17 MB after a recommendation) and nothing
// becomes faster.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

fn main() -> ExitCode {
    // Flush explicitly: output that fails to be written as the process ends would be lost without a message.
    let ended = Cli::read().and_then(Cli::run).and_then(|()| Ok(printing::stdout().flush()?));
    let Err(failure) = ended else { return ExitCode::SUCCESS };
    if !failure.is_silent() {
        // If the terminal is gone, too, nobody can read the message.
        let _ = writeln!(printing::stderr(), "carom: {failure}");
    }
    ExitCode::from(failure.code())
}
