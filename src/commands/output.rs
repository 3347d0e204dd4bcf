//! Output that several subcommands share.

use std::{
    fmt::Display,
    io::{self, IsTerminal, Write},
    iter,
    path::Path,
    sync::LazyLock,
};

use ratatui::text::Span;
use serde::Serialize;

use super::Failure;
use crate::{
    coach::{Skill, Units, words::LengthUnit},
    game::Rule,
    physics::{CueInputs, Impulse},
    printing::{self, OneLine},
    storage::{MAX_LINE_BYTES, NextLine, folder_state, next_line},
    terminal::{Mistake, Settings},
};

/// Prints a sentence to the standard error. Errors are ignored: if the terminal is gone, such as after a broken ssh connection, the work
/// continues without a reader.
pub fn print_note(sentence: impl Display) {
    let _ = writeln!(printing::stderr(), "{sentence}");
}

/// Refuses a `folder` that is not writable, before anything is computed; `path` is the first file to be written there.
pub fn check_writable(folder: &Path, path: &Path) -> Result<(), Failure> {
    match folder_state(folder).refusal {
        Some(refusal) => Err(Failure::failed(format_args!("{} cannot be written: {refusal}", path.display()))),
        None => Ok(()),
    }
}

/// The words that end a session in lines, as the end of the input does.
const ENDS: [&str; 2] = ["quit", "done"];

/// Reads the next line of the standard input and trims it; `None` at the end of the input or at a word of [`ENDS`]. At a terminal, `words`
/// is the prompt. The inner failure is a line that is too long; more lines may follow it.
pub fn prompt_line(words: &str) -> Result<Option<Result<String, Failure>>, Failure> {
    if io::stdin().is_terminal() {
        // A prompt that cannot be written has no reader.
        let _ = printing::stderr().write_all(words.as_bytes());
    }
    let mut line = Vec::new();
    match next_line(&mut io::stdin().lock(), &mut line) {
        Ok(NextLine::Line) => {
            let text = String::from_utf8_lossy(line.trim_ascii());
            Ok((!ENDS.contains(&&*text)).then(|| Ok(text.into_owned())))
        }
        Ok(NextLine::End) => Ok(None),
        Ok(NextLine::TooLong) => Ok(Some(Err(Failure::wrong_input(format_args!(
            "a line is too long; accepted are up to {MAX_LINE_BYTES} bytes"
        ))))),
        Err(error) => Err(Failure::failed(format_args!("the input cannot be read: {error}"))),
    }
}

/// Prints one line to the standard output; line breaks in `text` are escaped.
pub fn print_line(text: impl Display) -> Result<(), Failure> {
    Ok(writeln!(printing::stdout(), "{}", OneLine(text))?)
}

/// Formats a shot in the form that the command line accepts.
pub fn shot_text(cue: &CueInputs) -> String {
    let CueInputs { a, b, theta, speed, .. } = *cue;
    format!("{a:.4},{b:.4},{:.3},{},{speed:.3}", theta.to_degrees(), cue.phi_text(3))
}

/// States how often a player of this skill makes a shot, with the 95 % interval.
pub fn chance_words(skill: Skill, rate: f64, [low, high]: [f64; 2]) -> String {
    let [rate, low, high] = [rate, low, high].map(|share| 100.0 * share);
    format!("{} makes it {rate:.1} % of the time ({low:.1} to {high:.1} %)", player_words(skill))
}

/// Names the player of a skill; one without a name by the average at three-cushion, because nobody knows the errors by heart.
pub fn player_words(skill: Skill) -> String {
    let average = (100.0 * Skill::average(skill.scale())).round() / 100.0;
    match skill.to_string() {
        name if name.contains('=') => format!("a player who averages {average} at three-cushion"),
        name => format!("a player of skill \"{name}\""),
    }
}

/// Returns the result of a command that refused `refused` lines of its input. A person at a terminal has seen the reasons and can retype
/// the lines; a program learns it from the exit code.
///
/// # Errors
/// Fails if lines of a pipe or a file were refused.
pub fn refused_lines_result(refused: usize) -> Result<(), Failure> {
    if refused == 0 || io::stdin().is_terminal() {
        return Ok(());
    }
    Err(Failure::wrong_input(format_args!("{} refused; the reasons are above", plural(refused, "line"))))
}

/// Refuses a path in a missing folder: a mistyped path must not create folders that nobody looks into.
///
/// # Errors
/// Fails if the folder of `file` does not exist.
pub fn check_folder_exists(file: &Path) -> Result<(), Failure> {
    match file.parent() {
        Some(folder) if !folder.as_os_str().is_empty() && !folder.is_dir() => {
            let (file, folder) = (file.display(), folder.display());
            Err(Failure::failed(format_args!("{file}: there is no folder {folder}; make it first")))
        }
        _ => Ok(()),
    }
}

/// Formats a count with its noun in the singular or plural.
pub fn plural(count: usize, thing: &str) -> String {
    format!("{count} {thing}{}", if count == 1 { "" } else { "s" })
}

/// States the skill and the rule, for commands in which only the command line sets them.
pub fn player_and_rule_words(skill: Skill, rule: Rule) -> String {
    format!(
        "For {} under the rule {rule}; --skill and --rule choose others. The screen's skill and rule are not used.",
        player_words(skill)
    )
}

/// Returns the units that the user has chosen. The first call notes mistakes in their settings; `carom config --check` reports all mistakes.
pub fn units() -> Units {
    static UNITS: LazyLock<Units> = LazyLock::new(|| {
        let path = Settings::path();
        let (settings, mistakes) = Settings::load(&path);
        let is_about_units = |mistake: &&Mistake| mistake.line.is_none() || mistake.text.contains("_unit");
        for mistake in mistakes.iter().filter(is_about_units) {
            print_note(format_args!("note: {}: {mistake}", path.display()));
        }
        settings.units
    });
    *UNITS
}

/// Formats the equivalent ball impulse, with speeds in the unit that belongs to the length `unit`.
pub fn impulse_words(impulse: &Impulse, unit: LengthUnit) -> String {
    let (factor, symbol) = unit.speed();
    // Adding zero removes the sign of a rounded minus zero.
    let tidy = |x: f64| (1e3 * x).round() / 1e3 + 0.0;
    let (v, w) = ((factor * impulse.velocity).to_array().map(tidy), impulse.spin.to_array().map(tidy));
    let lift = match tidy(factor * impulse.lift) {
        0.0 => "0".to_owned(),
        lift => format!("{lift:.3}"),
    };
    let [x, y] = v;
    format!("impulse: V0 = ({x:.3}, {y:.3}, {lift}) {symbol}, w0 = ({:.3}, {:.3}, {:.3}) rad/s", w[0], w[1], w[2])
}

/// Prints a line of JSON to the standard output.
pub fn json_line(value: &impl Serialize) -> io::Result<()> {
    printing::json_line(&mut printing::stdout().exact(true), value)
}

/// Prints a table to the standard output, laid out by [`columns`].
pub fn print_table<const COLUMNS: usize>(
    heads: [&str; COLUMNS],
    rows: impl IntoIterator<Item = [String; COLUMNS]>,
    numbers: &[usize],
) -> Result<(), Failure> {
    let rows: Vec<_> = iter::once(heads.map(str::to_owned)).chain(rows).collect();
    columns(&rows, numbers).iter().try_for_each(print_line)
}

/// Formats rows of cells as lines with aligned columns, measured in terminal columns. The columns in `numbers` are right-aligned.
pub fn columns<const COLUMNS: usize>(rows: &[[String; COLUMNS]], numbers: &[usize]) -> Vec<String> {
    let rows: Vec<_> = rows.iter().map(|row| row.each_ref().map(|cell| OneLine(cell).to_string())).collect();
    let width = |cell: &str| Span::raw(cell).width();
    let widths: [usize; COLUMNS] =
        std::array::from_fn(|column| rows.iter().map(|row| width(&row[column])).max().unwrap_or(0));
    let line = |row: &[String; COLUMNS]| {
        let cells = row.iter().zip(widths).enumerate().map(|(column, (cell, widest))| {
            let blanks = " ".repeat(widest - width(cell));
            if numbers.contains(&column) { blanks + cell } else { cell.clone() + &blanks }
        });
        cells.collect::<Vec<_>>().join("  ").trim_end().to_owned()
    };
    rows.iter().map(line).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_measured_in_terminal_columns() {
        let rows = [["name", "shots", "of"], ["日本", "5", "5000000"], ["e\u{301}", "1000000", "5"]];
        let lines = columns(&rows.map(|row| row.map(str::to_owned)), &[1, 2]);
        assert_eq!(lines, ["name    shots       of", "日本        5  5000000", "e\u{301}     1000000        5"]);
    }
}
