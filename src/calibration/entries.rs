//! The player's entries: trials with their marks as written in a file, and their conversion to readings.

use std::{collections::BTreeMap, fmt};

use serde::{Deserialize, Serialize};

use super::{
    estimate::{Reading, Trial},
    protocol::{Mark, PROTOCOL, Quantity, Test, Unit},
};
use crate::{
    printing::parse_number,
    storage::{describe_json_error, describe_toml_error},
    table::Table,
};

/// Standard error of a position measured with a tape, diamonds: 5 mm.
const TAPE_ERROR: f64 = 0.015;

/// Shortest accepted time, s: nobody starts and stops a watch faster.
const MIN_TIME: f64 = 0.2;

/// Largest accepted number of short rails that a ball hits in a test: nobody strikes harder.
pub const MAX_RAILS: usize = 12;

/// A file of entries.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Entries {
    /// The name of the calibrated table.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// The strokes, in the order in which they were played.
    #[serde(default, rename = "trial", skip_serializing_if = "Vec::is_empty")]
    pub trials: Vec<Entry>,
}

/// One stroke.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Entry {
    /// Name of the test.
    pub test: String,
    /// Number of short rails that the ball hit, if it is not the one that the test expects.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rails: Option<usize>,
    /// Whether it was played from the far end of the table, with all marks counted from the player's position: the
    /// balls then hit the opposite rails.
    #[serde(default, rename = "far-end", skip_serializing_if = "std::ops::Not::not")]
    pub far_end: bool,
    /// Standard errors of marks, if they are not the usual ones.
    #[serde(default, rename = "sure", skip_serializing_if = "BTreeMap::is_empty")]
    pub standard_errors: BTreeMap<String, MarkValue>,
    /// The marks by their names.
    #[serde(flatten)]
    pub marks: BTreeMap<String, MarkValue>,
}

/// A number as written: in the mark's unit, or with its own unit, like `"412 mm"`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged, expecting = "expected a number, or a text like \"412 mm\"")]
pub enum MarkValue {
    /// A number in the mark's unit.
    Number(f64),
    /// A text with a unit.
    Text(String),
}

impl fmt::Display for MarkValue {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => write!(formatter, "{number}"),
            Self::Text(text) => write!(formatter, "\"{text}\""),
        }
    }
}

impl MarkValue {
    /// Returns the number in the mark's unit, and whether it was measured with a tape.
    fn read(&self, unit: Unit, table: &Table) -> Option<(f64, bool)> {
        let text = match self {
            Self::Number(number) => return Some((*number, false)),
            Self::Text(text) => text.trim(),
        };
        let digits = text.trim_end_matches(|letter: char| letter.is_alphabetic());
        let number = parse_number(digits)?;
        match (unit, &text[digits.len()..]) {
            (_, "") | (Unit::Diamonds, "d" | "diamonds") | (Unit::Seconds, "s") => Some((number, false)),
            (Unit::Diamonds, "mm") => Some((1e-3 * number / table.diamond(), true)),
            (Unit::Diamonds, "cm") => Some((1e-2 * number / table.diamond(), true)),
            _ => None,
        }
    }
}

/// A problem of an entry; the part with the problem is left out.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("trial {number} ({test}): {what}")]
pub struct EntryProblem {
    /// Number of the trial, from 1 on.
    pub number: usize,
    /// Name of its test.
    pub test: String,
    /// The problem, and what would be accepted.
    pub what: String,
}

impl Entries {
    /// Parses a file's text: TOML, or JSON if it begins with a brace.
    ///
    /// # Errors
    /// A message if the text is neither.
    pub fn parse(text: &str) -> Result<Self, String> {
        if text.trim_start().starts_with('{') {
            return serde_json::from_str(text).map_err(|error| describe_json_error(&error));
        }
        toml::from_str(text).map_err(|error| describe_toml_error(text, &error))
    }

    /// Returns the usable trials, each with its number in the file from 0 on, and the problems of all entries.
    pub fn trials(&self, table: &Table) -> (Vec<(usize, Trial)>, Vec<EntryProblem>) {
        let (mut trials, mut odd) = (Vec::new(), Vec::new());
        for (index, entry) in self.trials.iter().enumerate() {
            let (readings, what) = entry.readings(table);
            odd.extend(what.into_iter().map(|what| EntryProblem { number: index + 1, test: entry.test.clone(), what }));
            if let Some(test) = Test::named(&entry.test)
                && !readings.is_empty()
            {
                trials.push((index, Trial { test, is_turned: entry.far_end, readings }));
            }
        }
        (trials, odd)
    }

    /// Returns the tests with missing strokes, and the number of these strokes.
    pub fn missing(&self) -> Vec<(&'static Test, usize)> {
        let played = |test: &Test| self.trials.iter().filter(|entry| entry.test == test.name).count();
        PROTOCOL
            .iter()
            .map(|test| (test, test.repetitions.saturating_sub(played(test))))
            .filter(|(_, missing)| *missing > 0)
            .collect()
    }
}

impl Entry {
    /// Converts the marks to readings, and returns the problems.
    pub fn readings(&self, table: &Table) -> (Vec<Reading>, Vec<String>) {
        let Some(test) = Test::named(&self.test) else {
            let names: Vec<&str> = PROTOCOL.iter().map(|test| test.name).collect();
            return (Vec::new(), vec![format!("there is no such test; the tests are {}", names.join(", "))]);
        };
        let (mut readings, mut odd) = (Vec::new(), Vec::new());
        let names: Vec<&str> = test.marks.iter().map(|mark| mark.name).collect();
        for name in self.marks.keys().chain(self.standard_errors.keys()).filter(|name| !names.contains(&name.as_str()))
        {
            let asked: Vec<&str> = test.field_names().collect();
            odd.push(format!("it has no mark \"{name}\"; its marks are {}", asked.join(", ")));
        }
        for (index, mark) in test.marks.iter().enumerate() {
            let Some(written) = self.marks.get(mark.name) else { continue };
            match self.reading(table, test, mark, written) {
                Ok((value, sure)) => readings.push(Reading { mark: index, value, standard_error: sure }),
                Err(what) => odd.push(what),
            }
        }
        if readings.is_empty() && odd.is_empty() {
            odd.push(format!("nothing is marked yet; its marks are {}", names.join(", ")));
        }
        (readings, odd)
    }

    /// Converts a mark to its value and standard error. The value of a ball that stops along the table is its travel ([`Test::travel`]).
    fn reading(&self, table: &Table, test: &Test, mark: &Mark, written: &MarkValue) -> Result<(f64, f64), String> {
        let Mark { name, .. } = mark;
        let unit = mark.unit();
        let no_number = |written: &MarkValue| {
            let (what, accepted) = match unit {
                Unit::Diamonds => ("length", "a number of diamonds, or a text like \"412 mm\""),
                Unit::Seconds => ("time", "a number of seconds"),
            };
            format!("{name} = {written} is no {what}; accepted is {accepted}")
        };
        let (value, is_taped) = written.read(unit, table).ok_or_else(|| no_number(written))?;
        let least = if unit == Unit::Seconds { MIN_TIME } else { 0.0 };
        let most = mark.max_value();
        if !(least..=most).contains(&value) {
            let reason = match unit {
                Unit::Diamonds => "no ball can be there",
                Unit::Seconds if value > most => "no ball rolls that long, so the stopwatch was left running",
                Unit::Seconds => "nobody stops a watch that fast",
            };
            return Err(format!("{name} = {written}: {reason}; accepted is {least} to {most} {}", unit.sign()));
        }
        // The centre of a ball that touches a rail is a radius from it, but the player may have marked the rail itself.
        let radius = table.radius / table.diamond();
        let value = if unit == Unit::Diamonds { value.clamp(radius, most - radius) } else { value };
        let sure = match self.standard_errors.get(*name) {
            None if is_taped => TAPE_ERROR,
            None => mark.standard_error,
            Some(written) => {
                let read = written.read(unit, table).map(|(sure, _)| sure).filter(|sure| *sure > 0.0 && *sure <= most);
                read.ok_or_else(|| {
                    let unit = unit.sign();
                    format!("{name} ~ {written}: how sure a mark is must be above 0 and at most {most} {unit}")
                })?
            }
        };
        if !matches!(mark.quantity, Quantity::StopAlong(_)) {
            return Ok((value, sure));
        }
        let rails = self.rails.or(test.rails).ok_or_else(|| {
            format!(
                "{name} = {written} needs the number of short rails that the ball hit; add it, for example as rails = 5"
            )
        })?;
        if rails > 0 && test.balls.len() > 1 {
            return Err(format!("rails = {rails}: no ball may meet a rail in this test; play it again, softer"));
        }
        if rails > MAX_RAILS {
            return Err(format!("rails = {rails}: nobody strikes that hard; accepted is 0 to {MAX_RAILS}"));
        }
        Ok((test.travel(table, rails, value), sure))
    }
}
