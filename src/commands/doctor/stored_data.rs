//! Stored data on this machine: folders, settings, tables, runs and practice, and problems with them.

use std::path::{Path, PathBuf};

use serde::{Serialize, Serializer};

use crate::{
    calibration::load_entries_or_empty,
    commands::input::load_table,
    drills::Store,
    learning::run::list::{Listing, runs_in},
    storage::{DataPaths, folder_state, without_error_numbers},
    terminal::{Mistake, SavedSession},
};

/// Free disk space below which the disk counts as full, bytes: enough for the last checkpoints of a run and a few sessions.
const MIN_FREE: u64 = 50 << 20;

/// A folder that the program writes into.
#[derive(Serialize)]
pub struct FolderReport {
    pub what: &'static str,
    #[serde(serialize_with = "lossy")]
    pub path: PathBuf,
    /// Whether the folder exists. It is created on the first write.
    pub exists: bool,
    /// Why the folder is not writable; `None` if it is.
    pub refusal: Option<String>,
    /// `None` if the system does not report it.
    pub free_bytes: Option<u64>,
}

/// Serializes a path, with replacement characters if it is not valid UTF-8: JSON cannot represent such paths.
fn lossy<S: Serializer>(path: &Path, to: S) -> Result<S::Ok, S::Error> {
    to.collect_str(&path.display())
}

impl FolderReport {
    fn inspect(what: &'static str, path: &Path) -> Self {
        let state = folder_state(path);
        let refusal = state.refusal.map(|error| without_error_numbers(error.to_string()));
        Self { what, path: path.to_owned(), exists: state.exists, refusal, free_bytes: state.free }
    }

    /// Returns a sentence if nothing can be stored there.
    pub fn problem(&self) -> Option<String> {
        let (what, path) = (self.what, self.path.display());
        if let Some(refusal) = &self.refusal {
            return Some(format!("nothing can be written to the folder of {what}, {path}: {refusal}"));
        }
        let free = self.free_bytes.filter(|free| *free < MIN_FREE)?;
        Some(format!("the disk of the folder of {what}, {path}, is nearly full: {} MB are free", free / 1_000_000))
    }
}

/// Returns the folders, each once.
pub fn folders(paths: &DataPaths) -> Vec<FolderReport> {
    let folder = |file: &Path| file.parent().map(Path::to_owned).unwrap_or_default();
    [
        ("settings", folder(&paths.settings)),
        ("practice, tables and runs", folder(&paths.player)),
        ("the last session and the log", folder(&paths.log)),
    ]
    .map(|(what, path)| FolderReport::inspect(what, &path))
    .into()
}

/// The stored data.
#[derive(Serialize)]
pub struct StoredData {
    pub settings: StoredItems,
    /// The user's own table files.
    pub tables: StoredItems,
    pub runs: StoredItems,
    pub sessions: StoredItems,
    pub positions: StoredItems,
    /// The skill that the player has saved as their own.
    pub player: StoredItems,
    /// Strokes of a calibration.
    pub calibration: StoredItems,
    /// Strokes of the last daily check.
    pub daily_check: StoredItems,
    /// The saved state of the last session.
    pub last: StoredItems,
}

/// The number of stored items of a kind, and the problems with them.
#[derive(Serialize)]
pub struct StoredItems {
    #[serde(serialize_with = "lossy")]
    pub path: PathBuf,
    pub count: usize,
    pub wrong: Vec<String>,
}

impl StoredItems {
    /// Creates an entry from the number of items, or from the error of reading them.
    fn of(path: &Path, count: Result<usize, impl ToString>) -> Self {
        let wrong = count.as_ref().err().map(ToString::to_string);
        Self { path: path.to_owned(), count: count.unwrap_or(0), wrong: wrong.into_iter().collect() }
    }
}

impl StoredData {
    /// Checks all stored data.
    pub fn inspect(paths: &DataPaths, mistakes: &[Mistake]) -> Self {
        let store = Store::new(paths);
        let (sessions, positions, own) = (store.sessions(), store.positions(), store.own_skill());
        Self {
            settings: StoredItems {
                path: paths.settings.clone(),
                count: usize::from(paths.settings.is_file()),
                wrong: Mistake::sentences(&paths.settings, mistakes),
            },
            tables: tables(paths),
            runs: runs(&paths.runs),
            sessions: StoredItems { path: paths.sessions.clone(), count: sessions.items.len(), wrong: sessions.notes },
            positions: StoredItems {
                path: paths.positions.clone(),
                count: positions.items.len(),
                wrong: positions.notes,
            },
            player: StoredItems::of(&paths.player, own.map(|own| usize::from(own.is_some()))),
            calibration: strokes(&paths.calibration),
            daily_check: strokes(&paths.daily_check),
            last: last(&paths.last_session),
        }
    }

    /// Returns a sentence for each problem.
    pub fn problems(&self) -> impl Iterator<Item = String> {
        let Self { settings, tables, runs, sessions, positions, player, calibration, daily_check, last } = self;
        let all = [settings, tables, runs, sessions, positions, player, calibration, daily_check, last];
        all.into_iter().flat_map(|found| found.wrong.iter().cloned())
    }
}

/// Checks the strokes in a calibration file.
fn strokes(path: &Path) -> StoredItems {
    StoredItems::of(path, load_entries_or_empty(path).map(|entries| entries.trials.len()))
}

/// Checks the last session and the earlier ones that can be resumed.
fn last(path: &Path) -> StoredItems {
    let last = SavedSession::load(path).map_err(|error| format!("{}: {error}", path.display()));
    StoredItems::of(path, last.map(|last| last.map_or(0, |last| last.into_sessions().len())))
}

/// Checks the user's own tables.
fn tables(paths: &DataPaths) -> StoredItems {
    let mut found = StoredItems { path: paths.tables.clone(), count: 0, wrong: Vec::new() };
    for path in paths.own_tables() {
        match load_table(&path) {
            Ok(_) => found.count += 1,
            Err(failure) => found.wrong.push(failure.to_string()),
        }
    }
    found
}

/// Checks the user's runs.
fn runs(folder: &Path) -> StoredItems {
    match if folder.exists() { runs_in(folder) } else { Ok(Listing::default()) } {
        Ok(Listing { runs, unreadable }) => {
            StoredItems { path: folder.to_owned(), count: runs.len(), wrong: unreadable }
        }
        Err(error) => StoredItems::of(folder, Err(format!("{}: {error}", folder.display()))),
    }
}
