//! `carom completions` and `carom man`: shell completions and manual pages, generated from the definition of the command line.

use std::io::Write;

use clap::CommandFactory;
use clap_complete::Shell;

use super::{Cli, Failure};
use crate::printing;

/// Print the completions for a shell.
#[derive(Debug, clap::Args)]
pub struct Completions {
    /// The shell: bash, elvish, fish, powershell or zsh.
    shell: Shell,
}

/// Print the manual page of carom or of a subcommand.
#[derive(Debug, clap::Args)]
pub struct Man {
    /// The subcommand, such as "recommend"; without it, the program itself.
    #[arg(num_args = 0..)]
    command: Vec<String>,
}

pub(super) fn completions(args: &Completions) -> Result<(), Failure> {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut Cli::command(), "carom", &mut script);
    // Not directly to the pipe: clap_complete panics if the reader has closed it.
    Ok(printing::stdout().exact(true).write_all(&script)?)
}

pub(super) fn man(args: &Man) -> Result<(), Failure> {
    let mut program = Cli::command();
    program.build();
    let mut command = &program;
    for name in &args.command {
        let known = || command.get_subcommands().map(clap::Command::get_name).collect::<Vec<_>>().join(", ");
        command = command.find_subcommand(name).ok_or_else(|| {
            let known = known();
            let accepted = if known.is_empty() { "none".to_owned() } else { known };
            Failure::wrong_input(format_args!("there is no subcommand \"{name}\" of carom; there are: {accepted}"))
        })?;
    }
    let mut page = Vec::new();
    clap_mangen::Man::new(command.clone()).render(&mut page)?;
    Ok(printing::stdout().exact(true).write_all(&page)?)
}
