//! The stiff and extreme cases. Each draws many shots and may have an additional check.

mod chatter;
mod cushion;
mod flights;
mod grazing;
mod lone;
mod models;
mod pressed;
mod rail_course;
mod simultaneous;
mod smooth_courses;
mod strokes;
mod sweeps;
mod tables;
mod touching;

use super::{Check, Generator, Limits, Progress, Sweep, SweepResult};
use crate::table::{THESIS_PRESETS, Table};

/// One row of the stability table.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    /// What is hard about the case.
    pub name: &'static str,
    /// What must hold in addition to the invariants.
    pub requirement: &'static str,
    /// The tables of the case.
    pub tables: fn() -> Vec<Table>,
    /// Draws a shot.
    pub shot: Generator,
    /// The additional check, if any.
    pub check: Option<Check>,
    /// Limits of the invariants.
    pub limits: Limits,
    /// The kind of the case, which determines its number of shots.
    pub kind: CaseKind,
}

/// The field of [`super::Plan`] with the number of shots of a case.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CaseKind {
    /// The number of random shots.
    Random,
    /// The number of adversarial shots.
    Adversarial,
    /// The number for each stiff or extreme case.
    Case,
}

/// Returns all cases, in the order of the report.
pub fn all() -> Vec<Case> {
    [
        sweeps::CASES,
        grazing::CASES,
        cushion::CASES,
        touching::CASES,
        simultaneous::CASES,
        pressed::CASES,
        chatter::CASES,
        smooth_courses::CASES,
        strokes::CASES,
        tables::CASES,
        models::CASES,
        flights::CASES,
    ]
    .concat()
}

impl Case {
    /// Creates a stiff or extreme case in which the invariants must hold.
    const fn new(name: &'static str, tables: fn() -> Vec<Table>, shot: Generator) -> Self {
        Self { name, requirement: "", tables, shot, check: None, limits: Limits::STRICT, kind: CaseKind::Case }
    }

    /// Adds a description of what must hold in addition.
    const fn with_requirement(self, requirement: &'static str) -> Self {
        Self { requirement, ..self }
    }

    /// Adds a check and its description.
    const fn checked(self, requirement: &'static str, check: Check) -> Self {
        Self { check: Some(check), ..self.with_requirement(requirement) }
    }

    const fn of_kind(self, kind: CaseKind) -> Self {
        Self { kind, ..self }
    }

    /// Removes the limit of events, for tables on which shots inherently have more.
    const fn any_events(self) -> Self {
        Self { limits: Limits::ANY_EVENTS, ..self }
    }

    /// Plays `shots` shots on each table of the case. `watch` is that of [`Sweep::run`].
    pub fn run(&self, shots: u64, seed: u64, mut watch: impl FnMut(Progress) + Send) -> SweepResult {
        let on = |table| Sweep { table, generator: self.shot, check: self.check, shots, seed, limits: self.limits };
        (self.tables)()
            .into_iter()
            .map(|table| on(table).run(&mut watch))
            .fold(SweepResult::default(), SweepResult::merge)
    }
}

/// Returns the tables with the thesis' model, on which contacts rest longest.
fn presets() -> Vec<Table> {
    THESIS_PRESETS.iter().filter_map(|name| Table::preset(name).ok()).collect()
}

/// Returns the same tables, each as a [`variant`].
fn variants(what: &str, change: impl Fn(&mut Table)) -> Vec<Table> {
    THESIS_PRESETS.iter().filter_map(|name| variant(name, what, &change)).collect()
}

/// Returns the same tables with the restitution `e` in every contact.
fn with_restitution(e: f64) -> Vec<Table> {
    variants(&format!("e = {e}"), |table| (table.ball_restitution, table.rail_restitution) = (e, e))
}

/// Returns a bundled table with changed values and a name that states the change; `None` if the values are rejected.
fn variant(name: &str, what: &str, change: impl Fn(&mut Table)) -> Option<Table> {
    let mut table = Table::preset(name).ok()?;
    change(&mut table);
    table.name = format!("{name}, {what}");
    // Through its file format, which checks the values.
    Table::from_toml(&toml::to_string(&table).ok()?).ok()
}
