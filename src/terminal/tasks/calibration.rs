//! Background tasks of the calibration's page, and their reports.

use std::{
    panic::{AssertUnwindSafe, catch_unwind},
    path::PathBuf,
};

use crate::{
    calibration::{
        Calibration, Edit, Entries, Next, Play, Trial, calibrate, edit_entries, kept_entries, prospects,
        put_aside_unread, save_table,
    },
    table::{Table, TableDoubt},
};

/// Something that is to be done.
#[derive(Clone, Debug)]
pub enum CalibrationTask {
    /// Read the entries of a file.
    Read(PathBuf),
    /// Change them; whether that takes an earlier change back.
    Edit(PathBuf, Edit, bool),
    /// Put a file of entries aside that cannot be read, so that others can be kept.
    PutAside(PathBuf),
    /// Find out what entries say of the table.
    Judge(Box<Judging>),
    /// Write a table to a file, over another table only where that is wanted.
    Save(PathBuf, Box<Table>, bool),
}

impl CalibrationTask {
    /// Whether it has to be done before the program ends.
    pub const fn writes(&self) -> bool {
        !matches!(self, Self::Judge(_))
    }
}

/// Entries that are to be judged.
#[derive(Clone, Debug)]
pub struct Judging {
    /// Tells this answer from those to earlier questions.
    pub number: u64,
    /// What the table shall be called.
    pub name: String,
    /// What is held of the table.
    pub table: Table,
    /// How much of it is open.
    pub doubt: TableDoubt,
    /// The trials, each with its number among the entries.
    pub trials: Vec<(usize, Trial)>,
    /// Whether it is a check of the day.
    pub is_daily: bool,
}

/// What entries say of a table.
#[derive(Clone, Debug)]
pub struct Judged {
    /// The calibration; none where there is no entry yet.
    pub found: Option<Calibration>,
    /// All tests, the one that tells most first.
    pub next: Vec<Next>,
    /// Of a check of the day: how the table played before and plays now.
    pub play: Option<[Play; 2]>,
}

/// What a file of entries holds.
#[derive(Clone, Debug)]
pub struct KeptEntries {
    /// All entries.
    pub entries: Entries,
    /// Where they were changed, the change back, and whether the change was one back itself.
    pub back: Option<(Edit, bool)>,
}

/// What has come of a task.
#[derive(Clone, Debug)]
pub enum CalibrationReport {
    /// What a file holds.
    Entries(PathBuf, Result<Box<KeptEntries>, String>),
    /// A change of a file was not made.
    Unkept(PathBuf, String),
    /// Of [`CalibrationTask::Judge`]: whether it was a check of the day, with its number.
    Judged(bool, u64, Result<Box<Judged>, String>),
    /// Of [`CalibrationTask::Save`]: whether it is saved, or another table is there.
    Saved(PathBuf, Result<bool, String>),
}

impl CalibrationTask {
    /// Does it on this thread. A panic in a simulation becomes a sentence.
    pub fn run(self) -> CalibrationReport {
        match self {
            Self::Read(path) => {
                let kept = kept_entries(&path).map(|entries| Box::new(KeptEntries { entries, back: None }));
                CalibrationReport::Entries(path, kept.map_err(|error| error.to_string()))
            }
            Self::PutAside(path) => match put_aside_unread(&path) {
                Ok(()) => Self::Read(path).run(),
                Err(error) => CalibrationReport::Entries(path, Err(error.to_string())),
            },
            Self::Edit(path, edit, is_back) => match edit_entries(&path, &edit) {
                Ok((entries, back)) => {
                    CalibrationReport::Entries(path, Ok(Box::new(KeptEntries { entries, back: Some((back, is_back)) })))
                }
                Err(error) => CalibrationReport::Unkept(path, error.to_string()),
            },
            Self::Judge(judging) => {
                let failed = "the program failed on these marks; take the last one out and try again";
                let judged = catch_unwind(AssertUnwindSafe(|| judging.judge()));
                let judged = judged.unwrap_or_else(|_| Err(failed.to_owned()));
                CalibrationReport::Judged(judging.is_daily, judging.number, judged.map(Box::new))
            }
            Self::Save(path, _, false) if path.exists() => CalibrationReport::Saved(path, Ok(false)),
            Self::Save(path, table, _) => {
                let saved = save_table(&path, &table).map(|()| true).map_err(|error| error.to_string());
                CalibrationReport::Saved(path, saved)
            }
        }
    }
}

impl Judging {
    fn judge(&self) -> Result<Judged, String> {
        let Self { name, table, doubt, trials, is_daily, .. } = self;
        if trials.is_empty() {
            let next = prospects(table, doubt).map_err(|error| error.to_string())?;
            return Ok(Judged { found: None, next, play: None });
        }
        let found = calibrate(name, table, doubt, trials).map_err(|error| error.to_string())?;
        let play = is_daily.then(|| [Play::of(table), Play::of(&found.table)]);
        Ok(Judged { next: found.next.clone(), found: Some(found), play })
    }
}
