//! Input that several subcommands share: tables, layouts, numbers and files of JSON Lines.

use std::{
    collections::HashMap,
    fmt::Display,
    io::{self, BufRead, BufReader, Write},
    ops::RangeInclusive,
    path::{Path, PathBuf},
    str::FromStr,
    time::Duration,
};

use serde::{Serialize, de::DeserializeOwned};
use serde_json::json;

use super::{
    Failure,
    output::print_note,
    request::{Keys, parse_request},
};
use crate::{
    game::{Reward, Rule},
    learning::{Policy, policy::file::Origin},
    printing,
    storage::{self, DataPaths, MAX_LINE_BYTES, NextLine, next_line},
    table::{BALLS, CueBall, Layout, PRESETS, Table, TableError},
};

/// Returns the bundled table, the table in the TOML file at the path `name`, or the user's own table whose file or which itself has that
/// name.
pub fn table_by_name(name: &str) -> Result<Table, Failure> {
    match Table::preset(name) {
        Err(error @ TableError::Unknown(_)) => {
            let (here, paths) = (Some(PathBuf::from(name)).filter(|path| path.exists()), DataPaths::of_this_user());
            let file = here.clone().filter(|path| !path.is_dir());
            match file.or_else(|| paths.own_table(name)).or(here) {
                Some(path) => load_table(&path),
                None => own_table_named(name, &paths.own_tables(), &error),
            }
        }
        table => table.map_err(Failure::wrong_input),
    }
}

/// Returns the table among `files` whose own name, by which the output calls it, is `name`; `unknown` is the error if there is none.
fn own_table_named(name: &str, files: &[PathBuf], unknown: &TableError) -> Result<Table, Failure> {
    let tables = files.iter().filter_map(|file| Some((file, load_table(file).ok()?)));
    let (mut named, others): (Vec<_>, Vec<_>) = tables.partition(|(_, table)| table.name == name);
    if named.len() > 1 {
        let files: Vec<_> = named.iter().map(|(file, _)| file.display().to_string()).collect();
        return Err(Failure::failed(format_args!(
            "\"{name}\" is the name of several tables of your own; accepted is one of their files: {}",
            files.join(", ")
        )));
    }
    let stem = |file: &PathBuf| file.file_stem().map(|stem| stem.to_string_lossy().into_owned());
    let known = others.iter().flat_map(|(file, table)| [stem(file), Some(table.name.clone())]).flatten();
    let meant = || printing::did_you_mean(name, known.chain(PRESETS.map(str::to_owned)));
    named.pop().map(|(_, table)| table).ok_or_else(|| Failure::failed(format_args!("{unknown}{}", meant())))
}

/// Returns the bundled table of this name. Stored positions refer to a table by name, so the name must mean the same to everybody.
pub fn bundled_table(name: &str) -> Result<Table, Failure> {
    Table::preset(name).map_err(|_| {
        Failure::wrong_input(format_args!(
            "positions are saved for bundled tables only, and \"{name}\" is not one; accepted are {}",
            PRESETS.map(|name| format!("\"{name}\"")).join(", ")
        ))
    })
}

/// Reads the table in a TOML file.
pub fn load_table(file: &Path) -> Result<Table, Failure> {
    let text = storage::read_text(file, storage::MAX_SMALL_FILE)
        .map_err(|error| Failure::failed(format_args!("{} cannot be read: {error}", file.display())))?;
    Table::from_file(file, &text).map_err(|error| Failure::wrong_input(format_args!("{}: {error}", file.display())))
}

/// Prints notes about a policy that was trained on another table or, if `rule` is given, for another reward.
pub fn note_training_mismatch(policy: &Policy, table: &Table, rule: Option<Rule>) {
    let Origin { reward, table: trained_on, .. } = policy.origin();
    if let Some(rule) = rule.filter(|rule| *reward != Reward::for_rule(*rule)) {
        print_note(format_args!("note: this policy was trained for {reward}; of the rule \"{rule}\" it knows nothing"));
    }
    if !policy.is_trained_for(table) {
        print_note(format_args!("note: this policy was trained on \"{trained_on}\", not on \"{}\"", table.name));
    }
}

/// The table and the balls of a single shot; each line of a batch has its own.
#[derive(Debug, clap::Args)]
pub struct PositionArgs {
    /// The table: "match", "textbook", "thesis", one of your own by its name, or the path of a TOML file.
    #[arg(long, default_value = "match", conflicts_with = "batch")]
    table: String,
    /// The balls, cue ball first: "x,y x,y x,y" in metres from the centre. Default: the opening position
    ///
    /// Diamonds from the lower left corner, "2d,2d 6d,2d 2d,2.5d", and lengths in mm, cm, in and ft are accepted, too. In the output, white is
    /// the cue ball, yellow the opponent's ball, and red the third ball. In JSON they are 0, 1 and 2.
    #[arg(long, allow_hyphen_values = true, conflicts_with = "batch")]
    layout: Option<String>,
}

impl PositionArgs {
    /// Returns the table and the validated layout.
    pub fn read(&self) -> Result<(Table, Layout), Failure> {
        let table = table_by_name(&self.table)?;
        let opening = Layout::opening(&table);
        let Some(text) = &self.layout else {
            opening.validate(&table).map_err(Failure::wrong_input)?;
            return Ok((table, opening));
        };
        let layout = Layout::parse(text, &table).map_err(Failure::wrong_input)?;
        if layout.validate(&table).is_err() {
            // If all numbers are in diamonds, so is the error. Numbers without a unit would be diamonds there, and are metres here.
            if text.matches('d').count() == 2 * BALLS {
                opening.with_positions(text, &table, CueBall::White, 0).map_err(Failure::wrong_input)?;
            }
            layout.validate(&table).map_err(Failure::wrong_input)?;
        }
        Ok((table, layout))
    }
}

/// Returns a clap parser for a whole number in a range. It names the range in every refusal; clap's own message does not if an unsigned
/// number is negative.
pub fn whole_number<T: FromStr + PartialOrd + Display + Clone>(
    range: RangeInclusive<T>,
) -> impl Fn(&str) -> Result<T, String> + Clone {
    move |text| {
        text.parse()
            .ok()
            .filter(|number| range.contains(number))
            .ok_or_else(|| format!("accepted is a whole number from {} to {}", range.start(), range.end()))
    }
}

/// Like [`whole_number`], without an upper bound.
pub fn whole_number_from<T: FromStr + PartialOrd + Display + Clone>(
    least: T,
) -> impl Fn(&str) -> Result<T, String> + Clone {
    move |text| {
        let number = text.parse().ok().filter(|number| *number >= least);
        number.ok_or_else(|| format!("accepted is a whole number from {least} on"))
    }
}

/// Parses a seed.
pub fn parse_seed(text: &str) -> Result<u64, String> {
    whole_number(0..=u64::MAX)(text)
}

/// Returns the time and the number of simulations of a search from the values of `--budget-ms` and `--simulations`. Without either, the time
/// is `default_ms`; with a number of simulations alone, it is unlimited, so that the result does not depend on the speed of the machine.
pub fn search_limits(budget_ms: Option<u64>, simulations: Option<u64>, default_ms: u64) -> (Duration, u64) {
    let budget = match (budget_ms, simulations) {
        (None, Some(_)) => Duration::MAX,
        (budget, _) => Duration::from_millis(budget.unwrap_or(default_ms)),
    };
    (budget, simulations.unwrap_or(u64::MAX))
}

/// Converts the value of `--minutes`, which may be fractional.
///
/// # Errors
/// Fails for a number that is not above 0, and for more than a thousand years.
pub fn parse_minutes(value: f64) -> Result<Duration, Failure> {
    if value > 0.0 && value <= MAX_MINUTES {
        return Ok(Duration::from_secs_f64(60.0 * value));
    }
    Err(Failure::wrong_input(format_args!(
        "--minutes {value:?} is not a valid time; accepted is a number above 0 and at most {MAX_MINUTES:e}"
    )))
}

/// Longest accepted time, minutes: a thousand years.
const MAX_MINUTES: f64 = 5e8;

/// The mark with which some editors begin a file.
pub const BYTE_ORDER_MARK: &str = "\u{feff}";

/// Answers every line of the JSON Lines in `file` (`-` is the standard input) on the standard output, in the same order. A refused line is
/// answered with `error`, and the following lines are still processed; the command then ends with exit code 2.
pub fn answer_lines<Q: DeserializeOwned + Keys, A: Serialize>(
    file: &str,
    mut answer: impl FnMut(Q) -> Result<A, Failure>,
) -> Result<(), Failure> {
    let mut reader: Box<dyn BufRead> = if file == "-" {
        Box::new(io::stdin().lock())
    } else {
        let unreadable = |error| Failure::failed(format_args!("{file} cannot be read: {error}"));
        Box::new(BufReader::new(storage::open_stream(Path::new(file)).map_err(unreadable)?))
    };
    let is_stream = file == "-" || !Path::new(file).is_file();
    let mut out = io::BufWriter::new(printing::stdout().exact(true));
    let (mut lines, mut refused) = (0_usize, 0_usize);
    let (mut line, mut index) = (Vec::new(), 0_usize);
    loop {
        index += 1;
        let unreadable = |error| Failure::failed(format_args!("{file} cannot be read at line {index}: {error}"));
        let request = match next_line(&mut reader, &mut line).map_err(unreadable)? {
            NextLine::End => break,
            NextLine::Line if line.trim_ascii().is_empty() => continue,
            NextLine::Line => {
                let request = line.strip_prefix(BYTE_ORDER_MARK.as_bytes()).filter(|_| index == 1).unwrap_or(&line);
                parse_request(request).map_err(|reason| format!("line {index} is not a valid JSON request: {reason}"))
            }
            NextLine::TooLong => Err(format!("line {index} is too long; accepted are up to {MAX_LINE_BYTES} bytes")),
        };
        lines += 1;
        let answered =
            request.and_then(|request| answer(request).map_err(|failure| format!("line {index}: {failure}")));
        match answered {
            Ok(answer) => printing::json_line(&mut out, &answer)?,
            Err(error) => {
                refused += 1;
                printing::json_line(&mut out, &json!({ "error": error }))?;
            }
        }
        if is_stream {
            // A program at the other end of a pipe waits for this answer before it sends the next request.
            out.flush()?;
        }
    }
    out.flush()?;
    if refused > 0 {
        return Err(Failure::wrong_input(format_args!(
            "{refused} of {lines} lines were refused; each says why in its \"error\""
        )));
    }
    Ok(())
}

/// A cache of one value per table name.
pub struct TableCache<T, F> {
    make: F,
    made: HashMap<String, T>,
}

impl<T, F: Fn(Table) -> Result<T, Failure>> TableCache<T, F> {
    /// Creates an empty cache whose values are computed by `make`.
    pub fn new(make: F) -> Self {
        Self { make, made: HashMap::new() }
    }

    /// Returns the value for the table called `name`.
    pub fn get(&mut self, name: &str) -> Result<&T, Failure> {
        if !self.made.contains_key(name) {
            let made = (self.make)(table_by_name(name)?)?;
            self.made.insert(name.to_owned(), made);
        }
        Ok(&self.made[name])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_use_the_typed_unit() {
        let said = |layout: &str| {
            let args = PositionArgs { table: "match".to_owned(), layout: Some(layout.to_owned()) };
            args.read().unwrap_err().to_string()
        };
        assert!(said("9d,1d 7d,1d 1d,1d").contains("accepted are 0.09d to 7.91d"));
        assert!(said("2,0 0,0 0.5,0").contains("accepted are |x| <= 1.3892"));
        let [metres, diamonds] = ["2d,2d 3,0.2 6d,2d", "2d,2d 0.1,0.2 9d,2d"].map(said);
        assert!(metres.contains("yellow at (3.0000, 0.2000) m"), "{metres}");
        assert!(diamonds.contains("red at (1.7750, 0.0000) m"), "{diamonds}");
        assert!(said("2,3 5,1 6,3").ends_with("in metres from the middle, or diamonds like 2d,0.5d"));
        assert!(said("0,0 0.5,0").contains("0,0 0.5,0"), "one place is missing");
    }

    #[test]
    fn invalid_times_are_refused_and_quoted() {
        for wrong in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(parse_minutes(wrong).unwrap_err().to_string().contains(&wrong.to_string()));
        }
        assert_eq!(parse_minutes(0.5).unwrap(), Duration::from_secs(30));
    }
}
