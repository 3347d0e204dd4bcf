//! The command line, one file for each subcommand.

mod accuracy;
mod bench;
mod bounded;
mod calibrate;
mod config;
mod doctor;
mod documents;
mod drill;
mod evaluate;
mod failure;
mod follow;
mod input;
mod lookup;
mod output;
mod play;
mod recommend;
mod reproduce;
mod request;
mod simulate;
mod table;
mod train;
mod typed_stroke;
mod watch;

use std::{any::TypeId, error::Error, ffi::OsString, io::Write};

use clap::{Arg, CommandFactory, FromArgMatches, Parser, Subcommand};

pub use failure::Failure;
use output::{print_note, refused_lines_result};

use crate::{
    platform,
    printing::{self, FULL_VERSION, is_hidden},
    storage::{Player, notice},
    terminal::{Mistake, Seat, Settings, TerminalError},
};

/// Variable in which sshd stores the command of the client, if the client's key is restricted to one command.
const SSH_REQUEST: &str = "SSH_ORIGINAL_COMMAND";

/// A terminal coach for carom billiards.
#[derive(Debug, Parser)]
#[command(version = FULL_VERSION, about, long_about = None, args_conflicts_with_subcommands = true)]
pub struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
    /// Table of the terminal program: "match", "textbook", "thesis", one of your own by its name, or the path of a TOML file.
    #[arg(long)]
    table: Option<String>,
    /// Use plain lines instead of a screen: for screen readers, and for terminals that cannot draw.
    #[arg(long)]
    plain: bool,
    /// For a machine that players share: no training can be started, the coach thinks for at most one second, and only the player's own
    /// files are read or written.
    #[arg(long)]
    guest: bool,
    /// The player whose settings, practice and last session are used: letters, digits, "-" and "_". Each player has a separate folder.
    #[arg(long, value_name = "NAME")]
    player: Option<Player>,
}

#[derive(Debug, Subcommand)]
enum Command {
    Simulate(simulate::Args),
    Recommend(recommend::Args),
    Train(train::Args),
    Watch(watch::Args),
    Follow(follow::Args),
    Drill(drill::Args),
    Play(play::Args),
    Evaluate(evaluate::Args),
    Accuracy(accuracy::Args),
    Bench(bench::Args),
    Calibrate(calibrate::Args),
    Reproduce(reproduce::Args),
    Table(table::Args),
    Config(config::Args),
    Doctor(doctor::Args),
    Completions(documents::Completions),
    Man(documents::Man),
}

impl Cli {
    /// Parses the command line.
    ///
    /// # Errors
    /// Fails if it is wrong or asks for help; the message is already printed then.
    pub fn read() -> Result<Self, Failure> {
        let request = std::env::var(SSH_REQUEST).unwrap_or_default();
        Self::parse_words(std::env::args_os()).and_then(|cli| cli.with_ssh_request(&request)).map_err(|answer| {
            // A value that is well-formed but whose file cannot be read is not wrong input.
            if let Some(failure) = answer.source().and_then(|source| source.downcast_ref::<Failure>())
                && failure.code() != 2
            {
                return failure.clone();
            }
            let words = std::env::args_os().chain([request.clone().into()]);
            let is_safe = words.into_iter().all(|word| !word.to_string_lossy().chars().any(is_hidden));
            let is_unicode = printing::is_unicode(|name| std::env::var(name).ok());
            let said = match answer.use_stderr() {
                // clap prints arguments unescaped, between its own escape codes for bold words, and does not transliterate.
                _ if is_safe && is_unicode => answer.print(),
                true => write!(printing::stderr(), "{}", answer.render()),
                false => write!(printing::stdout(), "{}", answer.render()),
            };
            let code = u8::try_from(answer.exit_code()).unwrap_or(2);
            match said.and_then(|()| printing::stdout().flush()) {
                Err(error) if code == 0 => error.into(),
                // The error output may be closed, too; the exit code still reports the error.
                _ => Failure::silent(code),
            }
        })
    }

    /// Parses the words of a command line, starting with the program's name.
    fn parse_words(words: impl IntoIterator<Item = impl Into<OsString> + Clone>) -> Result<Self, clap::Error> {
        let mut command = with_negative_numbers(Self::command());
        let mut matches = command.try_get_matches_from_mut(words)?;
        Self::from_arg_matches_mut(&mut matches).map_err(|error| error.format(&mut command))
    }

    /// Applies the command that a guest gave to `ssh`: a guest may follow another player and do nothing else.
    fn with_ssh_request(self, words: &str) -> Result<Self, clap::Error> {
        let words: Vec<&str> = words.split_whitespace().collect();
        if !self.guest || words.first() != Some(&"follow") {
            return Ok(self);
        }
        let request = Self::parse_words(["carom"].iter().chain(&words))?;
        Ok(Self { command: request.command, ..self })
    }

    /// Returns the seat that determines which files are read and written.
    fn seat(&self) -> Result<Seat, Failure> {
        let player = self.player.clone().or_else(|| self.guest.then(Player::default));
        let Some(player) = player else { return Ok(Seat::of_this_user()) };
        Seat::of_player(&player, self.guest).map_err(Failure::failed)
    }

    /// Opens the full-screen program, or plain mode, with the player's settings.
    fn open(self) -> Result<(), Failure> {
        // Check the terminal first: a player's folder is created only for somebody who can play.
        if !self.plain {
            crate::terminal::require_terminal(self.guest).map_err(failure)?;
        }
        let seat = self.seat()?;
        // The operator of the machine chose the table on the command line, so it is read before a guest is confined to their folder.
        let named = self.table.as_deref().map(input::table_by_name).transpose()?;
        seat.confine_process(None).map_err(|error| {
            let folder = seat.paths.root.display();
            Failure::failed(format_args!("the player's folder {folder} cannot be made: {error}"))
        })?;
        let path = &seat.paths.settings;
        let (settings, mistakes) = Settings::load(path);
        let settings = seat.restrict_settings(settings);
        let table = named.map_or_else(|| input::table_by_name(&settings.table), Ok)?;
        if self.plain {
            if let Some(news) = notice(&seat.paths) {
                print_note(format_args!("note: {news}"));
            }
            Mistake::sentences(path, &mistakes).iter().for_each(print_note);
            return refused_lines_result(crate::terminal::run_plain(table, &settings, &seat.paths).map_err(failure)?);
        }
        crate::terminal::run(table, &settings, &mistakes, seat).map_err(failure)
    }

    /// Runs the command.
    ///
    /// # Errors
    /// Returns a [`Failure`] with its sentence and exit code.
    pub fn run(self) -> Result<(), Failure> {
        platform::refuse_large_files().map_err(Failure::failed)?;
        match self.command {
            None => self.open(),
            Some(Command::Simulate(args)) => simulate::run(&args),
            Some(Command::Recommend(args)) => recommend::run(&args),
            Some(Command::Train(args)) => train::run(&args),
            Some(Command::Watch(args)) => watch::run(&args),
            Some(Command::Follow(ref args)) => follow::run(args, self.seat()?),
            Some(Command::Drill(args)) => drill::run(&args),
            Some(Command::Play(args)) => play::run(&args),
            Some(Command::Evaluate(args)) => evaluate::run(&args),
            Some(Command::Accuracy(args)) => accuracy::run(&args),
            Some(Command::Bench(args)) => bench::run(&args),
            Some(Command::Calibrate(args)) => calibrate::run(&args),
            Some(Command::Reproduce(args)) => reproduce::run(&args),
            Some(Command::Table(args)) => table::run(&args),
            Some(Command::Config(args)) => config::run(&args),
            Some(Command::Doctor(args)) => doctor::run(&args),
            Some(Command::Completions(args)) => documents::completions(&args),
            Some(Command::Man(args)) => documents::man(&args),
        }
    }
}

/// Makes numeric options of the command accept negative numbers as values, instead of reading them as unknown options. A value out of range
/// is then refused with the accepted range.
fn with_negative_numbers(command: clap::Command) -> clap::Command {
    let numbers =
        [TypeId::of::<f64>(), TypeId::of::<u64>(), TypeId::of::<u32>(), TypeId::of::<u16>(), TypeId::of::<u8>()];
    let with_negative = |option: Arg| {
        let value = option.get_value_parser().type_id();
        if numbers.iter().any(|number| value == *number) { option.allow_negative_numbers(true) } else { option }
    };
    command.mut_args(with_negative).mut_subcommands(with_negative_numbers)
}

fn failure(error: TerminalError) -> Failure {
    match error {
        // A closed pipe does not count as a failure.
        TerminalError::Io(error) => error.into(),
        other => Failure::wrong_input(other),
    }
}
