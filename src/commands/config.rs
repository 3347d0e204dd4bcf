//! `carom config`: displays the settings, their meaning and their current values, and checks the settings file.

use std::io::Write;

use super::{
    Failure,
    output::{plural, print_note},
};
use crate::{
    printing,
    terminal::{Mistake, Settings},
};

/// Show every setting with its meaning and accepted values, as a file to start from.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Print only the path of the settings file.
    #[arg(long)]
    path: bool,
    /// Print only the mistakes in the file.
    #[arg(long, conflicts_with = "path")]
    check: bool,
}

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let path = Settings::path();
    let mut out = printing::stdout().exact(true);
    if args.path {
        return Ok(writeln!(out, "{}", path.display())?);
    }
    let (settings, mistakes) = Settings::load(&path);
    if !args.check {
        write!(out, "# {}\n{}", path.display(), settings.document())?;
    }
    Mistake::sentences(&path, &mistakes).iter().for_each(print_note);
    match mistakes.len() {
        0 => Ok(()),
        count => Err(Failure::wrong_input(format_args!(
            "{} in {}: what is wrong there is not used",
            plural(count, "mistake"),
            path.display()
        ))),
    }
}
