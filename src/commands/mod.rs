//! The command line, one file a subcommand.

mod accuracy;
mod bench;
mod bounded;
mod calibrate;
mod config;
mod documents;
mod drill;
mod evaluate;
mod failure;
mod input;
mod lookup;
mod output;
mod play;
mod recommend;
mod reproduce;
mod simulate;
mod table;
mod train;
mod watch;

use std::{error::Error, io::Write, process::ExitCode};

use clap::{Parser, Subcommand};

pub use failure::Failure;
use output::tell;

use crate::{
    printing::{self, is_hidden},
    storage::{Places, notice, refuse_large_files},
    terminal::{Settings, TerminalError},
};

/// A terminal coach for carom billiards.
#[derive(Debug, Parser)]
#[command(version, about, long_about = None, args_conflicts_with_subcommands = true)]
pub struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
    /// Table of the terminal program: "match", "textbook", "thesis" or the path of a TOML file.
    #[arg(long)]
    table: Option<String>,
    /// Talk in lines instead of a screen: for screen readers, and terminals that cannot draw.
    #[arg(long)]
    plain: bool,
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
    Calibrate(calibrate::Args),
    Reproduce(reproduce::Args),
    Table(table::Args),
    Config(config::Args),
    Completions(documents::Completions),
    Man(documents::Man),
}

impl Cli {
    /// What the command line says.
    ///
    /// # Errors
    /// Where it is wrong or asks for help: all is said then, and this is the exit code.
    pub fn read() -> Result<Self, ExitCode> {
        Self::try_parse().map_err(|answer| {
            // A value that is right and whose file cannot be read is no wrong input.
            if let Some(failure) = answer.source().and_then(|source| source.downcast_ref::<Failure>())
                && failure.code() != 2
            {
                tell(format_args!("carom: {failure}"));
                return ExitCode::from(failure.code());
            }
            let is_safe = std::env::args_os().all(|argument| !argument.to_string_lossy().chars().any(is_hidden));
            // clap repeats what it was given as it is, between the codes of its own bold words.
            let said = if is_safe { answer.print() } else { write!(printing::stderr(), "{}", answer.render()) };
            // Nobody may be left to tell.
            let _ = said;
            ExitCode::from(u8::try_from(answer.exit_code()).unwrap_or(2))
        })
    }

    /// The terminal program, with the user's settings.
    fn open(self) -> Result<(), Failure> {
        let path = Settings::path();
        let (settings, complaints) = Settings::load(&path);
        let table = input::table_named(self.table.as_ref().unwrap_or(&settings.table))?;
        if self.plain {
            if let Some(news) = notice(&Places::of_this_user(), &path) {
                tell(format_args!("note: {news}"));
            }
            for complaint in &complaints {
                tell(format_args!("{}: {complaint}", path.display()));
            }
            return crate::terminal::talk(table, &settings).map_err(failure);
        }
        crate::terminal::run(table, &settings, &complaints).map_err(failure)
    }

    /// Does what the command line asks for.
    ///
    /// # Errors
    /// A [`Failure`] with its sentence and exit code.
    pub fn run(self) -> Result<(), Failure> {
        refuse_large_files().map_err(Failure::failed)?;
        match self.command {
            None => self.open(),
            Some(Command::Simulate(args)) => simulate::run(&args),
            Some(Command::Recommend(args)) => recommend::run(&args),
            Some(Command::Train(args)) => train::run(&args),
            Some(Command::Watch(args)) => watch::run(&args),
            Some(Command::Drill(args)) => drill::run(&args),
            Some(Command::Play(args)) => play::run(&args),
            Some(Command::Evaluate(args)) => evaluate::run(&args),
            Some(Command::Accuracy(args)) => accuracy::run(&args),
            Some(Command::Bench(args)) => bench::run(&args),
            Some(Command::Calibrate(args)) => calibrate::run(&args),
            Some(Command::Reproduce(args)) => reproduce::run(&args),
            Some(Command::Table(args)) => table::run(&args),
            Some(Command::Config(args)) => config::run(&args),
            Some(Command::Completions(args)) => documents::completions(&args),
            Some(Command::Man(args)) => documents::man(&args),
        }
    }
}

fn failure(error: TerminalError) -> Failure {
    match error {
        // A pipe that is closed is no failure.
        TerminalError::Io(error) => error.into(),
        other => Failure::wrong_input(other),
    }
}
