//! `carom completions` and `carom man`: shell completions and manual pages, generated from the definition of the command line.

use std::io::Write;

use clap::CommandFactory;
use clap_complete::Shell;

use super::{Cli, Failure};
use crate::{
    coach::Skill,
    drills::Category,
    game::{Reward, Rule},
    learning::agents::AGENTS,
    printing::{self, FULL_VERSION, did_you_mean},
    study::reproduction::FIGURES,
    table::{CueBall, Side},
};

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
    clap_complete::generate(args.shell, &mut with_known_words(Cli::command()), "carom", &mut script);
    // Not directly to the pipe: clap_complete panics if the reader has closed it.
    Ok(printing::stdout().exact(true).write_all(&script)?)
}

/// Lists the words that complete a value, for options whose parser accepts other forms too, or has a message of its own.
fn with_known_words(command: clap::Command) -> clap::Command {
    let words = |option: &str| match option {
        "rule" | "games" => Rule::ALL.map(Rule::name).to_vec(),
        "skill" => Skill::NAMED.map(|(name, _)| name).into_iter().chain(["own"]).collect(),
        "first" => vec!["any", "yellow", "red", "cushion"],
        "ball" => [CueBall::White, CueBall::Yellow].map(CueBall::name).to_vec(),
        "side" => [Side::Left, Side::Right].map(Side::name).to_vec(),
        "category" => Category::ALL.map(Category::name).to_vec(),
        "reward" => Reward::ALL.map(Reward::name).to_vec(),
        "figures" => FIGURES.iter().map(|figure| figure.name).collect(),
        "doubt" | "choose_doubt" => vec!["full", "none"],
        "results" => vec!["make", "miss", "undo"],
        "level" => vec!["1", "2", "3"],
        "grade" => vec!["0", "1", "2", "3", "4", "5"],
        "agent" => AGENTS.map(|agent| agent.name).to_vec(),
        _ => Vec::new(),
    };
    let with_words = |arg: clap::Arg| match words(arg.get_id().as_str()) {
        known if known.is_empty() => arg,
        known => arg.value_parser(known),
    };
    command.mut_args(with_words).mut_subcommands(with_known_words)
}

pub(super) fn man(args: &Man) -> Result<(), Failure> {
    // The subcommand help has no page.
    let mut program = Cli::command().disable_help_subcommand(true);
    for subcommand in program.get_subcommands_mut() {
        *subcommand = subcommand.clone().disable_help_subcommand(true);
    }
    program.build();
    let mut command = &program;
    for name in &args.command {
        command = command.find_subcommand(name).ok_or_else(|| {
            let known: Vec<_> = command.get_subcommands().map(clap::Command::get_name).collect();
            let whole = command.get_bin_name().unwrap_or_default();
            Failure::wrong_input(if known.is_empty() {
                format!("\"{whole}\" has no subcommands; leave out \"{name}\"")
            } else {
                let meant = did_you_mean(name, &known);
                format!("there is no subcommand \"{name}\" of {whole}; there are: {}{meant}", known.join(", "))
            })
        })?;
    }
    let mut page = Vec::new();
    clap_mangen::Man::new(command.clone().version(FULL_VERSION)).render(&mut page)?;
    Ok(printing::stdout().exact(true).write_all(&page)?)
}
