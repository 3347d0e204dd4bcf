//! The command line, one file a subcommand.

mod accuracy;
mod bench;
mod drill;
mod evaluate;
mod failure;
mod input;
mod named;
mod output;
mod play;
mod recommend;
mod reproduce;
mod simulate;
mod train;
mod watch;

use clap::{Parser, Subcommand};

pub use failure::Failure;

/// A terminal coach for carom billiards.
#[derive(Debug, Parser)]
#[command(version, about, long_about = None, args_conflicts_with_subcommands = true)]
pub struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
    /// Table of the terminal program: "match", "thesis" or the path of a TOML file.
    #[arg(long, default_value = "match")]
    table: String,
}

#[derive(Debug, Subcommand)]
enum Command {
    Simulate(simulate::Args),
    Recommend(recommend::Args),
    Train(train::Args),
    Watch(watch::Args),
    Drill(drill::Args),
    Play(play::Args),
    Evaluate(evaluate::Args),
    Accuracy(accuracy::Args),
    Bench(bench::Args),
    Reproduce(reproduce::Args),
}

impl Cli {
    /// Does what the command line asks for.
    ///
    /// # Errors
    /// A [`Failure`] with its sentence and exit code.
    pub fn run(self) -> Result<(), Failure> {
        match self.command {
            None => crate::terminal::run(input::table_named(&self.table)?, None).map_err(Failure::wrong_input),
            Some(Command::Simulate(args)) => simulate::run(&args),
            Some(Command::Recommend(args)) => recommend::run(&args),
            Some(Command::Train(args)) => train::run(&args),
            Some(Command::Watch(args)) => watch::run(&args),
            Some(Command::Drill(args)) => drill::run(&args),
            Some(Command::Play(args)) => play::run(&args),
            Some(Command::Evaluate(args)) => evaluate::run(&args),
            Some(Command::Accuracy(args)) => accuracy::run(&args),
            Some(Command::Bench(args)) => bench::run(&args),
            Some(Command::Reproduce(args)) => reproduce::run(&args),
        }
    }
}
