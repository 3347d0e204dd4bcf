//! Background tasks of the calibration page, and their reports.

use std::{
    io::ErrorKind,
    panic::{AssertUnwindSafe, catch_unwind},
    path::PathBuf,
};

use crate::{
    calibration::{
        Calibration, Edit, Entries, NextTest, SaveError, TablePlay, Trial, back_up_unreadable, calibrate, edit_entries,
        load_entries_or_empty, rank_tests_before_trials, save_table,
    },
    table::{Table, TableDoubt},
};

/// A task.
#[derive(Clone, Debug)]
pub enum CalibrationTask {
    /// Read the entries of a file.
    Read(PathBuf),
    /// Edit the entries of a file; the flag says whether the edit undoes an earlier one.
    Edit(PathBuf, Edit, bool),
    /// Set a file of entries aside that cannot be read, so that new entries can be saved.
    BackUpUnreadable(PathBuf),
    /// Evaluate entries: what they say about the table.
    Evaluate(Box<EvaluationTask>),
    /// Write a table to a file; the flag allows replacing another table.
    Save(PathBuf, Box<Table>, bool),
}

impl CalibrationTask {
    /// Whether the task has to be done before the program ends.
    pub const fn writes(&self) -> bool {
        !matches!(self, Self::Evaluate(_))
    }
}

/// Entries to be evaluated.
#[derive(Clone, Debug)]
pub struct EvaluationTask {
    /// Identifies the answer to this request.
    pub number: u64,
    /// Name of the resulting table.
    pub name: String,
    /// The table with the prior parameters.
    pub table: Table,
    /// How uncertain those parameters are.
    pub doubt: TableDoubt,
    /// The trials, each with its index among the entries.
    pub trials: Vec<(usize, Trial)>,
    /// Whether it is a daily check.
    pub is_daily: bool,
}

/// What the entries say about a table.
#[derive(Clone, Debug)]
pub struct Evaluation {
    /// The calibration; `None` if there are no entries yet.
    pub found: Option<Calibration>,
    /// All tests, the most informative first.
    pub next: Vec<NextTest>,
    /// For a daily check: how the table played before and how it plays now.
    pub play: Option<[TablePlay; 2]>,
}

/// Content of a file of entries.
#[derive(Clone, Debug)]
pub struct SavedEntries {
    /// All entries.
    pub entries: Entries,
    /// After an edit: the inverse edit, and whether the edit itself was an undo.
    pub back: Option<(Edit, bool)>,
}

/// Report of a task.
#[derive(Clone, Debug)]
pub enum CalibrationReport {
    /// Content of a file.
    Entries(PathBuf, Result<Box<SavedEntries>, String>),
    /// A file could not be changed.
    SaveFailed(PathBuf, String),
    /// Result of [`CalibrationTask::Evaluate`]: whether it was a daily check, and its number.
    Evaluated(bool, u64, Result<Box<Evaluation>, String>),
    /// Result of [`CalibrationTask::Save`]: `true` if saved, `false` if another table has the name.
    Saved(PathBuf, Result<bool, String>),
}

impl CalibrationTask {
    /// Runs the task on this thread. A panic in a simulation becomes an error message.
    pub fn run(self) -> CalibrationReport {
        match self {
            Self::Read(path) => {
                let kept = load_entries_or_empty(&path).map(|entries| Box::new(SavedEntries { entries, back: None }));
                CalibrationReport::Entries(path, kept.map_err(|error| error.to_string()))
            }
            Self::BackUpUnreadable(path) => match back_up_unreadable(&path) {
                Ok(()) => Self::Read(path).run(),
                Err(error) => CalibrationReport::Entries(path, Err(error.to_string())),
            },
            Self::Edit(path, edit, is_back) => match edit_entries(&path, &edit) {
                Ok((entries, back)) => CalibrationReport::Entries(
                    path,
                    Ok(Box::new(SavedEntries { entries, back: Some((back, is_back)) })),
                ),
                Err(error) => CalibrationReport::SaveFailed(path, error.to_string()),
            },
            Self::Evaluate(task) => {
                let failed = "the program failed on these marks; take the last one out and try again";
                let evaluation = catch_unwind(AssertUnwindSafe(|| task.evaluate()));
                let evaluation = evaluation.unwrap_or_else(|_| Err(failed.to_owned()));
                CalibrationReport::Evaluated(task.is_daily, task.number, evaluation.map(Box::new))
            }
            Self::Save(path, table, may_replace) => {
                let saved = match save_table(&path, &table, may_replace) {
                    Ok(()) => Ok(true),
                    Err(SaveError::Unwritable(_, error)) if error.kind() == ErrorKind::AlreadyExists => Ok(false),
                    Err(SaveError::NotATable(_)) if !may_replace => Ok(false),
                    Err(error) => Err(error.to_string()),
                };
                CalibrationReport::Saved(path, saved)
            }
        }
    }
}

impl EvaluationTask {
    fn evaluate(&self) -> Result<Evaluation, String> {
        let Self { name, table, doubt, trials, is_daily, .. } = self;
        if trials.is_empty() {
            let next = rank_tests_before_trials(table, doubt).map_err(|error| error.to_string())?;
            return Ok(Evaluation { found: None, next, play: None });
        }
        let found = calibrate(name, table, doubt, trials).map_err(|error| error.to_string())?;
        let play = is_daily.then(|| [TablePlay::of(table), TablePlay::of(&found.table)]);
        Ok(Evaluation { next: found.next.clone(), found: Some(found), play })
    }
}
