//! Stored data on this machine: folders, settings, tables, runs and practice, and problems with them.

use std::path::{Path, PathBuf};

use serde::{Serialize, Serializer};

use crate::{
    calibration::kept_entries,
    commands::input::table_in,
    drills::Store,
    learning::run::list::{Listing, runs_in},
    storage::{Places, folder_state, without_numbers},
    terminal::{Complaint, SavedSession},
};

/// Free disk space below which the disk counts as full, bytes: enough for the last checkpoints of a run and a few sessions.
const LEAST_FREE: u64 = 50 << 20;

/// A folder that the program writes into.
#[derive(Serialize)]
pub struct Place {
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

impl Place {
    fn look(what: &'static str, path: &Path) -> Self {
        let state = folder_state(path);
        let refusal = state.refusal.map(|error| without_numbers(error.to_string()));
        Self { what, path: path.to_owned(), exists: state.exists, refusal, free_bytes: state.free }
    }

    /// Returns a sentence if nothing can be stored there.
    pub fn problem(&self) -> Option<String> {
        let (what, path) = (self.what, self.path.display());
        if let Some(refusal) = &self.refusal {
            return Some(format!("nothing can be written to the folder of {what}, {path}: {refusal}"));
        }
        let free = self.free_bytes.filter(|free| *free < LEAST_FREE)?;
        Some(format!("the disk of the folder of {what}, {path}, is nearly full: {} MB are free", free / 1_000_000))
    }
}

/// Returns the folders, each once.
pub fn places(places: &Places) -> Vec<Place> {
    let folder = |file: &Path| file.parent().map(Path::to_owned).unwrap_or_default();
    [
        ("settings", folder(&places.settings)),
        ("practice, tables and runs", folder(&places.player)),
        ("the last session and the log", folder(&places.log)),
    ]
    .map(|(what, path)| Place::look(what, &path))
    .into()
}

/// The stored data.
#[derive(Serialize)]
pub struct Kept {
    pub settings: Found,
    /// The user's own table files.
    pub tables: Found,
    pub runs: Found,
    pub sessions: Found,
    pub positions: Found,
    /// The skill that the player has saved as their own.
    pub player: Found,
    /// Strokes of a calibration.
    pub calibration: Found,
    /// Strokes of the last daily check.
    pub daily_check: Found,
    /// The saved state of the last session.
    pub last: Found,
}

/// The number of stored items of a kind, and the problems with them.
#[derive(Serialize)]
pub struct Found {
    #[serde(serialize_with = "lossy")]
    pub path: PathBuf,
    pub count: usize,
    pub wrong: Vec<String>,
}

impl Found {
    /// Creates an entry from the number of items, or from the error of reading them.
    fn of(path: &Path, count: Result<usize, impl ToString>) -> Self {
        let wrong = count.as_ref().err().map(ToString::to_string);
        Self { path: path.to_owned(), count: count.unwrap_or(0), wrong: wrong.into_iter().collect() }
    }
}

impl Kept {
    /// Checks all stored data.
    pub fn find(places: &Places, complaints: &[Complaint]) -> Self {
        let store = Store::new(places);
        let (sessions, positions, own) = (store.sessions(), store.positions(), store.own_skill());
        Self {
            settings: Found {
                path: places.settings.clone(),
                count: usize::from(places.settings.is_file()),
                wrong: Complaint::sentences(&places.settings, complaints),
            },
            tables: tables(places),
            runs: runs(&places.runs),
            sessions: Found { path: places.sessions.clone(), count: sessions.items.len(), wrong: sessions.notes },
            positions: Found { path: places.positions.clone(), count: positions.items.len(), wrong: positions.notes },
            player: Found::of(&places.player, own.map(|own| usize::from(own.is_some()))),
            calibration: strokes(&places.calibration),
            daily_check: strokes(&places.daily_check),
            last: last(&places.last),
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
fn strokes(path: &Path) -> Found {
    Found::of(path, kept_entries(path).map(|entries| entries.trials.len()))
}

/// Checks the last session and the earlier ones that can be resumed.
fn last(path: &Path) -> Found {
    let last = SavedSession::load(path).map_err(|error| format!("{}: {error}", path.display()));
    Found::of(path, last.map(|last| last.map_or(0, |last| last.with_former().len())))
}

/// Checks the user's own tables.
fn tables(places: &Places) -> Found {
    let mut found = Found { path: places.tables.clone(), count: 0, wrong: Vec::new() };
    for path in places.own_tables() {
        match table_in(&path) {
            Ok(_) => found.count += 1,
            Err(failure) => found.wrong.push(failure.to_string()),
        }
    }
    found
}

/// Checks the user's runs.
fn runs(folder: &Path) -> Found {
    match if folder.exists() { runs_in(folder) } else { Ok(Listing::default()) } {
        Ok(Listing { runs, unreadable }) => Found { path: folder.to_owned(), count: runs.len(), wrong: unreadable },
        Err(error) => Found::of(folder, Err(format!("{}: {error}", folder.display()))),
    }
}
