//! Specification of an evaluation, and its parts, which several processes or machines can measure.

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

/// The specification of an evaluation, which all its parts share.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[expect(clippy::struct_excessive_bools, reason = "each is a flag of the command line, or follows from some")]
pub struct Spec {
    /// The player: "recommender", "policy" or "random search".
    pub player: String,
    /// The policy, for players that have one.
    pub policy: Option<String>,
    /// Checksum of its networks, independent of its name; absent in parts from earlier versions.
    pub checksum: Option<String>,
    /// Version and source of the program that measured; absent in parts from earlier versions.
    pub version: Option<String>,
    /// Name of the bundled networks, if they play alone.
    pub networks: Option<String>,
    pub table: Table,
    /// Whether every layout has its own table, drawn around `table`.
    pub drawn_tables: bool,
    /// Name of the reward or the rule.
    pub measure: String,
    /// Whether the reward is just 0 or 1.
    pub is_yes_or_no: bool,
    pub seed: u64,
    /// Number of layouts of all parts together.
    pub layouts: u32,
    pub skill: Option<Skill>,
    pub doubt: Doubt,
    /// The doubt with which shots are chosen, if it differs.
    pub choose_doubt: Option<Doubt>,
    pub plan: bool,
    pub no_jumps: bool,
    /// The limit of the recommender for a layout: a time, or a number of simulations.
    pub budget_ms: Option<u64>,
    pub simulations: Option<u64>,
    /// Number of shots of the random search.
    pub random_search: Option<u32>,
    /// Points after which an inning of self-play is stopped.
    pub most_points: Option<u32>,
}

impl Spec {
    /// Describes how the layouts of another measurement, or the quantity measured on them, differ.
    pub fn layout_difference(&self, other: &Self) -> Option<String> {
        let of = |spec: &Self| {
            let Self { measure, seed, layouts, drawn_tables, table, .. } = spec;
            serde_json::json!({
                "measure": measure, "seed": seed, "layouts": layouts, "drawn_tables": drawn_tables, "table": table
            })
        };
        difference(&of(self), &of(other)).map(|(name, values)| format!("{name} {values}"))
    }

    /// Completes this specification, which an earlier version may have written, from that of another part.
    fn complete_from(&mut self, other: &Self) {
        self.checksum = self.checksum.take().or_else(|| other.checksum.clone());
        self.version = self.version.take().or_else(|| other.version.clone());
    }
}

/// A part of the layouts: `k/n` is every n-th layout, starting with the k-th.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct Shard {
    part: u32,
    of: u32,
}

impl Shard {
    /// All layouts.
    pub const WHOLE: Self = Self { part: 1, of: 1 };

    /// Whether the layout with this number, from 0, belongs to the part.
    pub const fn contains(self, index: u32) -> bool {
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
            _ => Err(format!("\"{text}\" is not a part: write K/N like 2/8, N up to {}, K from 1 to N", u32::MAX)),
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

/// The records of all layouts.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Records {
    /// One shot per layout.
    Shots(Vec<ShotRecord>),
    /// One inning per layout.
    Innings(Vec<InningRecord>),
}

/// The measurement of one process.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Part {
    #[serde(rename = "order")]
    pub spec: Spec,
    pub shard: Shard,
    pub records: Records,
}

impl Part {
    /// Describes how another part differs in its specification or its number of parts; `None` if both belong to one evaluation.
    fn difference(&self, other: &Self) -> Option<String> {
        let [mut own, mut others] = [self, other].map(|part| part.spec.clone());
        own.complete_from(&others);
        others.complete_from(&own);
        if own == others {
            let (own, others) = (self.shard.of, other.shard.of);
            return (own != others).then(|| format!("of {own} and of {others} parts"));
        }
        let [one, two] = [own, others].map(|spec| serde_json::to_value(spec).unwrap_or_default());
        let describe = |(name, values): (String, String)| match name.as_str() {
            "checksum" => format!("not by the same networks, whatever they are called (checksums {values})"),
            "version" => format!("by different versions of carom, {values}"),
            name => format!("{name} {values}"),
        };
        Some(difference(&one, &two).map_or_else(|| "other settings".to_owned(), describe))
    }
}

/// Returns the first field in which two objects differ, with both values.
fn difference(one: &Value, two: &Value) -> Option<(String, String)> {
    let mut fields = one.as_object().into_iter().flatten();
    let (name, value) = fields.find(|(name, value)| two[name.as_str()] != **value)?;
    Some((name.clone(), format!("{value} and {}", two[name.as_str()])))
}

/// Explains where the content stops being a part, without the jargon of the JSON library.
fn describe_content_error(error: &serde_json::Error) -> String {
    if error.is_data() {
        return format!("it contains something else at line {}, column {}", error.line(), error.column());
    }
    storage::describe_json_error(error)
}

/// Merges the parts in these files into the whole.
pub fn merge(files: &[PathBuf]) -> Result<(Spec, Records), Failure> {
    let missing =
        |shard: Shard| Failure::wrong_input(format_args!("part {shard} is missing; give the files of all parts"));
    let mut whole: Option<Part> = None;
    let mut seen = BTreeSet::new();
    for path in files {
        let part = read(path)?;
        let (first, shown) = (files[0].display(), path.display());
        let different = |what: &str| {
            Failure::wrong_input(format_args!("{first} and {shown} are parts of different evaluations: {what}"))
        };
        // Check this first, because parts of another evaluation may have the same number.
        if let Some(what) = whole.as_ref().and_then(|whole| whole.difference(&part)) {
            return Err(different(&what));
        }
        if !seen.insert(part.shard.part) {
            let shard = part.shard;
            return Err(Failure::wrong_input(format_args!("{shown} holds part {shard}, which another file holds too")));
        }
        match &mut whole {
            None => whole = Some(part),
            Some(whole) => {
                whole.spec.complete_from(&part.spec);
                if !whole.records.append(part.records) {
                    return Err(different("other records"));
                }
            }
        }
    }
    // The command line requires at least one file.
    let Some(Part { spec, shard: Shard { of, .. }, mut records }) = whole else {
        return Err(missing(Shard::WHOLE));
    };
    if let Some(part) = (1..=of).find(|part| !seen.contains(part)) {
        return Err(missing(Shard { part, of }));
    }
    records.sort();
    // An inning of self-play may have been left out for want of time.
    if let Records::Shots(shots) = &records
        && shots.iter().map(|shot| shot.layout).ne(0..spec.layouts)
    {
        let (held, layouts) = (shots.len(), spec.layouts);
        return Err(Failure::wrong_input(format_args!(
            "the parts hold {held} of {layouts} layouts; run the incomplete part again"
        )));
    }
    Ok((spec, records))
}

fn read(path: &Path) -> Result<Part, Failure> {
    let shown = path.display();
    let text = storage::read(path, storage::MAX_LARGE_FILE)
        .map_err(|error| Failure::failed(format_args!("{shown} cannot be read: {error}")))?;
    serde_json::from_slice(&text).map_err(|error| {
        Failure::wrong_input(format_args!(
            "{shown} is not a part of an evaluation, as carom evaluate --shard prints it: {}",
            describe_content_error(&error)
        ))
    })
}

impl Records {
    /// Appends the records of another part; returns `false` if they are of the other kind.
    fn append(&mut self, other: Self) -> bool {
        match (self, other) {
            (Self::Shots(all), Self::Shots(more)) => all.extend(more),
            (Self::Innings(all), Self::Innings(more)) => all.extend(more),
            _ => return false,
        }
        true
    }

    /// Sorts the records by layout.
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
