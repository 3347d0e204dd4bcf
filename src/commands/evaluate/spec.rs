//! What an evaluation measures, and the parts that several processes or machines share it out in.

use std::{
    collections::BTreeSet,
    fmt,
    path::{Path, PathBuf},
    str::FromStr,
};

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::{self_play::InningRecord, shots::ShotRecord};
use crate::{
    coach::{Doubt, Skill},
    commands::Failure,
    storage,
    table::Table,
};

/// What is measured: all parts of an evaluation have it in common.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[expect(clippy::struct_excessive_bools, reason = "each is a flag of the command line, or follows from some")]
pub struct Spec {
    /// Who decides: "recommender", "policy" or "random search".
    pub player: String,
    /// The policy, of players that have one.
    pub policy: Option<String>,
    /// Checksum of its networks, whatever it is called; parts of earlier versions have none.
    pub checksum: Option<String>,
    /// Version and source of the program that measured; parts of earlier versions have none.
    pub version: Option<String>,
    /// Which of the bundled networks they are, where these play alone.
    pub networks: Option<String>,
    pub table: Table,
    /// Whether every layout has a table of its own, drawn around that one.
    pub drawn_tables: bool,
    /// The reward or the rule.
    pub measure: String,
    /// Whether that is yes or no.
    pub is_yes_or_no: bool,
    pub seed: u64,
    /// Layouts of all parts together.
    pub layouts: u32,
    pub skill: Option<Skill>,
    pub doubt: Doubt,
    /// The doubt that shots are chosen with, where it is another.
    pub choose_doubt: Option<Doubt>,
    pub plan: bool,
    pub no_jumps: bool,
    /// What the recommender has for a layout: a time, or a number of simulations.
    pub budget_ms: Option<u64>,
    pub simulations: Option<u64>,
    /// Shots of the random search.
    pub random_search: Option<u32>,
    /// Points after which an inning of self-play is broken off.
    pub most_points: Option<u32>,
}

impl Spec {
    /// In what the layouts of another measurement differ, or what is measured on them.
    pub fn difference_of_layouts(&self, other: &Self) -> Option<String> {
        let of = |spec: &Self| {
            let Self { measure, seed, layouts, drawn_tables, table, .. } = spec;
            serde_json::json!({
                "measure": measure, "seed": seed, "layouts": layouts, "drawn_tables": drawn_tables, "table": table
            })
        };
        difference(&of(self), &of(other)).map(|(name, values)| format!("{name} {values}"))
    }

    /// Takes from the specification of another part what this one, of an earlier version, does not say.
    fn learn_from(&mut self, other: &Self) {
        self.checksum = self.checksum.take().or_else(|| other.checksum.clone());
        self.version = self.version.take().or_else(|| other.version.clone());
    }
}

/// A part of the layouts: `k/n` is every n-th layout from the k-th on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct Shard {
    part: u32,
    of: u32,
}

impl Shard {
    /// All layouts.
    pub const WHOLE: Self = Self { part: 1, of: 1 };

    /// Whether the layout with this number, from 0, belongs to it.
    pub const fn holds(self, index: u32) -> bool {
        index % self.of == self.part - 1
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{}/{}", self.part, self.of)
    }
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let shard = text.split_once('/').and_then(|(part, of)| Some((part.parse().ok()?, of.parse().ok()?)));
        match shard {
            Some((part, of)) if (1..=of).contains(&part) => Ok(Self { part, of }),
            _ => Err(format!("\"{text}\" is no part: write K/N like 2/8, K from 1 to N")),
        }
    }
}

impl TryFrom<String> for Shard {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl From<Shard> for String {
    fn from(shard: Shard) -> Self {
        shard.to_string()
    }
}

/// What was measured on each layout.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Records {
    /// One shot a layout.
    Shots(Vec<ShotRecord>),
    /// One inning a layout.
    Innings(Vec<InningRecord>),
}

/// What one process measured.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Part {
    #[serde(rename = "order")]
    pub spec: Spec,
    pub shard: Shard,
    pub records: Records,
}

impl Part {
    /// What another part has measured otherwise, or in how many parts; `None` where both are of one evaluation.
    fn difference(&self, other: &Self) -> Option<String> {
        let [mut own, mut others] = [self, other].map(|part| part.spec.clone());
        own.learn_from(&others);
        others.learn_from(&own);
        if own == others {
            let (own, others) = (self.shard.of, other.shard.of);
            return (own != others).then(|| format!("of {own} and of {others} parts"));
        }
        let [one, two] = [own, others].map(|spec| serde_json::to_value(spec).unwrap_or_default());
        let told = |(name, values): (String, String)| match name.as_str() {
            "checksum" => format!("not by the same networks, whatever they are called (checksums {values})"),
            "version" => format!("by different versions of carom, {values}"),
            name => format!("{name} {values}"),
        };
        Some(difference(&one, &two).map_or_else(|| "other settings".to_owned(), told))
    }
}

/// The first field in which two objects differ, and its values.
fn difference(one: &Value, two: &Value) -> Option<(String, String)> {
    let mut fields = one.as_object().into_iter().flatten();
    let (name, value) = fields.find(|(name, value)| two[name.as_str()] != **value)?;
    Some((name.clone(), format!("{value} and {}", two[name.as_str()])))
}

/// Why parts cannot be put together.
#[derive(Debug, thiserror::Error)]
pub enum MergeError {
    /// A file cannot be read.
    #[error("{} cannot be read: {error}", path.display())]
    File { path: PathBuf, error: std::io::Error },
    /// Its contents are no part.
    #[error("{} is no part of an evaluation, as carom evaluate --shard prints it: {}", path.display(), what_is_wrong(error))]
    Contents { path: PathBuf, error: serde_json::Error },
    /// The parts measured different things.
    #[error("{} and {} are parts of different evaluations: {what}", one.display(), other.display())]
    Different { one: PathBuf, other: PathBuf, what: String },
    /// The same layouts twice.
    #[error("{} holds part {shard}, which another file holds too", path.display())]
    Twice { path: PathBuf, shard: Shard },
    /// Parts are missing.
    #[error("part {shard} is missing; give the files of all parts")]
    Missing { shard: Shard },
}

impl From<MergeError> for Failure {
    fn from(error: MergeError) -> Self {
        match error {
            MergeError::File { .. } => Self::failed(error),
            _ => Self::wrong_input(error),
        }
    }
}

/// Where the contents stop being a part, without the words of the library that reads them.
fn what_is_wrong(error: &serde_json::Error) -> String {
    if error.is_data() {
        return format!("it holds something else at line {}, column {}", error.line(), error.column());
    }
    storage::json_flaw(error)
}

/// The whole of which these files hold the parts.
pub fn merged(files: &[PathBuf]) -> Result<(Spec, Records), MergeError> {
    let mut whole: Option<Part> = None;
    let mut seen = BTreeSet::new();
    for path in files {
        let part = read(path)?;
        let different = |what| MergeError::Different { one: files[0].clone(), other: path.clone(), what };
        // First, as parts of another evaluation may have the same number.
        if let Some(what) = whole.as_ref().and_then(|whole| whole.difference(&part)) {
            return Err(different(what));
        }
        if !seen.insert(part.shard.part) {
            return Err(MergeError::Twice { path: path.clone(), shard: part.shard });
        }
        match &mut whole {
            None => whole = Some(part),
            Some(whole) => {
                whole.spec.learn_from(&part.spec);
                if !whole.records.append(part.records) {
                    return Err(different("other records".to_owned()));
                }
            }
        }
    }
    // The command line asks for one file at least.
    let Some(Part { spec, shard: Shard { of, .. }, mut records }) = whole else {
        return Err(MergeError::Missing { shard: Shard::WHOLE });
    };
    if let Some(part) = (1..=of).find(|part| !seen.contains(part)) {
        return Err(MergeError::Missing { shard: Shard { part, of } });
    }
    records.sort();
    Ok((spec, records))
}

fn read(path: &Path) -> Result<Part, MergeError> {
    let text =
        storage::read(path, storage::LARGE).map_err(|error| MergeError::File { path: path.to_owned(), error })?;
    serde_json::from_slice(&text).map_err(|error| MergeError::Contents { path: path.to_owned(), error })
}

impl Records {
    /// Takes the records of another part; not if they are of the other kind.
    fn append(&mut self, other: Self) -> bool {
        match (self, other) {
            (Self::Shots(all), Self::Shots(more)) => all.extend(more),
            (Self::Innings(all), Self::Innings(more)) => all.extend(more),
            _ => return false,
        }
        true
    }

    /// Brings them into the order of the layouts.
    fn sort(&mut self) {
        match self {
            Self::Shots(records) => records.sort_by_key(|record| record.layout),
            Self::Innings(records) => records.sort_by_key(|record| record.layout),
        }
    }
}

#[cfg(test)]
impl Spec {
    /// A measurement of the simplest kind.
    pub fn of_random_search(layouts: u32) -> Self {
        Self {
            player: "random search".to_owned(),
            measure: "straight".to_owned(),
            is_yes_or_no: true,
            seed: 4,
            layouts,
            random_search: Some(30),
            ..Self::default()
        }
    }
}
