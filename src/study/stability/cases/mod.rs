//! The stiff and extreme cases: each draws many shots and knows what must hold of them besides the invariants.

mod chatter;
mod cushion;
mod flights;
mod grazing;
mod lone;
mod pressed;
mod rail_course;
mod simultaneous;
mod smooth_courses;
mod strokes;
mod sweeps;
mod tables;
mod touching;

use super::{Check, Generator, Limits, Progress, Sweep, Swept};
use crate::table::{JUDGED, Table};

/// One row of the stability table.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    /// What is hard about it.
    pub name: &'static str,
    /// What must hold besides the invariants.
    pub holds: &'static str,
    /// The tables on which it is played.
    pub tables: fn() -> Vec<Table>,
    /// Draws a shot.
    pub shot: Generator,
    /// Checks what must hold besides, if anything.
    pub check: Option<Check>,
    /// Limits of the invariants.
    pub limits: Limits,
    /// How many shots it gets.
    pub size: Size,
}

/// Which number of a [`super::Plan`] tells how many shots a case gets.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Size {
    /// That of the random shots.
    Random,
    /// That of the adversarial shots.
    Adversarial,
    /// That of each stiff or extreme case.
    Case,
}

/// All cases, in the order of the report.
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
        flights::CASES,
    ]
    .concat()
}

impl Case {
    /// A stiff or extreme case in which the invariants must hold.
    const fn new(name: &'static str, tables: fn() -> Vec<Table>, shot: Generator) -> Self {
        Self { name, holds: "", tables, shot, check: None, limits: Limits::STRICT, size: Size::Case }
    }

    /// With words for what holds besides.
    const fn holding(self, holds: &'static str) -> Self {
        Self { holds, ..self }
    }

    /// With something to check besides.
    const fn checked(self, holds: &'static str, check: Check) -> Self {
        Self { check: Some(check), ..self.holding(holds) }
    }

    const fn of_size(self, size: Size) -> Self {
        Self { size, ..self }
    }

    /// On tables where a shot has more events by nature.
    const fn any_events(self) -> Self {
        Self { limits: Limits::ANY_EVENTS, ..self }
    }

    /// Plays `shots` shots on each of its tables. `watch` is that of [`Sweep::run`].
    pub fn run(&self, shots: u64, seed: u64, mut watch: impl FnMut(Progress) + Send) -> Swept {
        let on = |table| Sweep { table, generator: self.shot, check: self.check, shots, seed, limits: self.limits };
        (self.tables)().into_iter().map(|table| on(table).run(&mut watch)).fold(Swept::default(), Swept::and)
    }
}

/// The bundled tables.
fn presets() -> Vec<Table> {
    JUDGED.iter().filter_map(|name| Table::preset(name).ok()).collect()
}

/// The bundled tables, each as a [`variant`].
fn variants(what: &str, change: impl Fn(&mut Table)) -> Vec<Table> {
    JUDGED.iter().filter_map(|name| variant(name, what, &change)).collect()
}

/// A bundled table with other numbers, of which its name tells; none if they are refused.
fn variant(name: &str, what: &str, change: impl Fn(&mut Table)) -> Option<Table> {
    let mut table = Table::preset(name).ok()?;
    change(&mut table);
    table.name = format!("{name}, {what}");
    // Through its file, which checks the values.
    Table::from_toml(&toml::to_string(&table).ok()?).ok()
}
