//! `carom calibrate`: estimates the constants of a real table from a few short tests at it.

mod listing;
mod report;
mod session;
mod simulated;

use std::path::{Path, PathBuf};

use super::{
    Failure,
    input::{parse_seed, table_by_name, whole_number},
    output::{check_folder_exists, check_writable, print_line, print_note},
};
use crate::{
    calibration::{
        Entries, EntriesFileError, TablePlay, calibrate, load_entries, may_save_table, next_day_doubt, prior,
        save_table,
    },
    drills::MAX_TITLE_BYTES,
    storage::resolve_symlinks,
    table::{PRESETS, Table, TableDoubt},
};
use report::Report;

/// Default name of a calibrated table.
const NAME: &str = "own";

/// Estimate the constants of a real table and their uncertainty from a few short tests.
///
/// The player plays the tests at the table and writes down the results. With a FILE of these entries, the command reports what follows from
/// them. Without one, it asks for the tests one by one and saves every entry at once; the next call continues where this one ended.
#[derive(Debug, clap::Args)]
#[expect(clippy::struct_excessive_bools, reason = "each is a flag of the command line")]
pub struct Args {
    /// The entries: TOML as --template prints it, or JSON with the same names.
    file: Option<PathBuf>,
    /// The table to start from: "match", "textbook", "thesis", one of your own by its name, or the path of a TOML file, such as one from an
    /// earlier calibration.
    #[arg(long, default_value = "match", conflicts_with = "template")]
    table: String,
    /// Write the table to this TOML file.
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Name of the table. Default: the name in the entries, or "own"
    #[arg(long, conflicts_with_all = ["tests", "template", "simulate"])]
    name: Option<String>,
    /// A daily check: the table is one that was calibrated before. Two strokes, a lag and a Corner-5, show whether it plays shorter or
    /// longer than then.
    #[arg(long, conflicts_with_all = ["tests", "template", "simulate"])]
    daily: bool,
    /// List the tests: where to put the balls, how to strike, what to write down.
    #[arg(long, conflicts_with_all = ["file", "template", "simulate", "out"])]
    tests: bool,
    /// Print a file of entries to fill in.
    #[arg(long, conflicts_with_all = ["file", "simulate", "out", "json"])]
    template: bool,
    /// Measure the calibration itself: draw this many tables, let a simulated club player play all tests on each, and report how often the
    /// 95 % intervals contain the truth.
    #[arg(long, value_name = "TABLES", conflicts_with_all = ["file", "out"],
        value_parser = whole_number(1..=100_000_u32))]
    simulate: Option<u32>,
    /// With --simulate: the seed of the tables and the player.
    #[arg(long, requires = "simulate", conflicts_with_all = ["file", "out", "daily", "tests", "template"], default_value_t = 1,
        value_parser = parse_seed)]
    seed: u64,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
}

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    if args.template {
        return listing::template().lines().try_for_each(print_line);
    }
    let table = table_by_name(&args.table)?;
    if args.tests {
        return listing::tests(&table, args.json);
    }
    if let Some(tables) = args.simulate {
        return simulated::run(&table, &prior(&table), tables, args.seed, args.json);
    }
    let doubt = doubt(args, &table)?;
    // A session at the table is long, so problems with its output are reported before it begins.
    args.name.as_deref().map_or(Ok(()), check_name)?;
    args.out.as_deref().map_or(Ok(()), check_out)?;
    match &args.file {
        Some(file) => report_result(args, &table, &doubt, &load_entries(file).map_err(failure)?),
        None => session::run(args, &table, &doubt),
    }
}

/// Converts an error: invalid content of a file is wrong input.
fn failure(error: EntriesFileError) -> Failure {
    if matches!(error, EntriesFileError::Invalid(..)) {
        return Failure::wrong_input(format_args!(
            "{error}; carom calibrate --template prints a file of entries to begin with"
        ));
    }
    Failure::failed(error)
}

/// Returns the present uncertainty of the table's constants; for a daily check this includes possible changes overnight.
fn doubt(args: &Args, table: &Table) -> Result<TableDoubt, Failure> {
    match &table.doubt {
        _ if !args.daily => Ok(prior(table)),
        Some(doubt) => Ok(next_day_doubt(table, doubt)),
        None => Err(Failure::wrong_input(format_args!(
            "a daily check needs a table that was calibrated before, and \"{}\" was not; give its file with --table",
            table.name
        ))),
    }
}

/// Refuses names that a calibrated table must not have.
fn check_name(name: &str) -> Result<(), Failure> {
    if PRESETS.contains(&name) {
        return Err(Failure::wrong_input(format_args!(
            "\"{name}\" is the name of a bundled table; give another with --name"
        )));
    }
    if name.trim().is_empty() || name.len() > MAX_TITLE_BYTES {
        return Err(Failure::wrong_input(format_args!(
            "the name has {} bytes; accepted are up to {MAX_TITLE_BYTES}, not all of them blanks",
            name.len()
        )));
    }
    Ok(())
}

/// Refuses a path at which no table can be written.
fn check_out(path: &Path) -> Result<(), Failure> {
    let target = resolve_symlinks(path);
    check_folder_exists(&target)?;
    let folder = target.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    check_writable(folder, path)?;
    may_save_table(path).map_err(Failure::failed)
}

/// Calibrates with these entries, reports the result and writes the table.
fn report_result(args: &Args, table: &Table, doubt: &TableDoubt, entries: &Entries) -> Result<(), Failure> {
    let (trials, odd) = entries.trials(table);
    for oddity in &odd {
        print_note(format_args!("{oddity}; it is left out"));
    }
    let own = table.doubt.is_some().then_some(&table.name);
    let name = args.name.as_ref().or(entries.name.as_ref()).or(own).map_or(NAME, String::as_str);
    check_name(name)?;
    let found = calibrate(name, table, doubt, &trials).map_err(Failure::wrong_input)?;
    let play = args.daily.then(|| [TablePlay::of(table), TablePlay::of(&found.table)]);
    let report = Report::new(&found, entries, &odd, play);
    // Save before anything is printed: a closed output must not prevent it.
    let out = args.out.as_ref().filter(|_| odd.is_empty() && !found.is_contradictory());
    if let Some(path) = out {
        save_table(path, &found.table, true).map_err(Failure::failed)?;
    }
    if args.json {
        report.json()?;
    } else {
        report.text()?;
    }
    let written = args.out.as_ref().map_or("", |_| ", and no table is written");
    if !odd.is_empty() {
        let many = if odd.len() == 1 { "one entry is odd" } else { "some entries are odd" };
        return Err(Failure::wrong_input(format_args!("{many}{written}: correct or delete what is named above")));
    }
    if found.is_contradictory() {
        return Err(Failure::wrong_input(format_args!(
            "the strokes contradict each other{written}: correct or delete what is named above"
        )));
    }
    let Some(path) = out else { return Ok(()) };
    let said = format!("the table \"{}\" is written to {}", found.table.name, path.display());
    if args.json {
        print_note(said);
        return Ok(());
    }
    print_line(said)
}
