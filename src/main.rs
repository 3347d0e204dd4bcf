//! The program: parses the command line, runs it, and turns failures into a sentence and an exit code.

// What may not be used stands in clippy.toml.
#![cfg_attr(not(test), warn(clippy::disallowed_macros, clippy::disallowed_methods))]

use std::{io::Write, process::ExitCode};

use carom::{commands::Cli, printing};

// A quarter of a small network's update is malloc and free; mimalloc alone makes training 1.3 to 3 times faster. It is built
// without huge pages (`no_thp`): each makes 2 MB resident for the first byte in it, 17 MB after a recommendation, and nothing is faster.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

fn main() -> ExitCode {
    // What is left unwritten would be lost without a word as the process ends.
    let ended = Cli::read().and_then(Cli::run).and_then(|()| Ok(printing::stdout().flush()?));
    let Err(failure) = ended else { return ExitCode::SUCCESS };
    if !failure.is_silent() {
        // The terminal may be gone with the failure: then there is nobody to tell.
        let _ = writeln!(printing::stderr(), "carom: {failure}");
    }
    ExitCode::from(failure.code())
}
