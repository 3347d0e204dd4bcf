//! What is kept on this machine: folders, settings, tables, runs and practice, and what of it cannot be used.

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

/// Room on the disk below which it counts as full, bytes: the last checkpoints of a run and a few sessions.
const LITTLE: u64 = 50 << 20;

/// A folder that the program writes into.
#[derive(Serialize)]
pub struct Place {
    pub what: &'static str,
    #[serde(serialize_with = "lossy")]
    pub path: PathBuf,
    /// It is made when something is kept.
    pub exists: bool,
    /// Why nothing can be written there; none where it can.
    pub refusal: Option<String>,
    /// None where the system does not tell.
    pub free_bytes: Option<u64>,
}

/// A path as it can be told: JSON has no form for one that is no text.
fn lossy<S: Serializer>(path: &Path, to: S) -> Result<S::Ok, S::Error> {
    to.collect_str(&path.display())
}

impl Place {
    fn look(what: &'static str, path: &Path) -> Self {
        let state = folder_state(path);
        let refusal = state.refusal.map(|error| without_numbers(error.to_string()));
        Self { what, path: path.to_owned(), exists: state.exists, refusal, free_bytes: state.free }
    }

    /// Where nothing can be kept.
    pub fn problem(&self) -> Option<String> {
        let (what, path) = (self.what, self.path.display());
        if let Some(refusal) = &self.refusal {
            return Some(format!("nothing can be written to the folder of {what}, {path}: {refusal}"));
        }
        let free = self.free_bytes.filter(|free| *free < LITTLE)?;
        Some(format!("the disk of the folder of {what}, {path}, is nearly full: {} MB are free", free / 1_000_000))
    }
}

/// The folders, each once.
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

/// What was kept.
#[derive(Serialize)]
pub struct Kept {
    pub settings: Found,
    /// Table files of the user's own.
    pub tables: Found,
    pub runs: Found,
    pub sessions: Found,
    pub positions: Found,
    /// The skill that the player has kept as their own.
    pub player: Found,
    /// Strokes of a calibration.
    pub calibration: Found,
    /// Strokes of the last check of the day.
    pub daily_check: Found,
    /// Where the last session ended.
    pub last: Found,
}

/// How much there is of something, and what of it cannot be used.
#[derive(Serialize)]
pub struct Found {
    #[serde(serialize_with = "lossy")]
    pub path: PathBuf,
    pub count: usize,
    pub wrong: Vec<String>,
}

impl Found {
    /// So many, or why they cannot be read.
    fn of(path: &Path, count: Result<usize, impl ToString>) -> Self {
        let wrong = count.as_ref().err().map(ToString::to_string);
        Self { path: path.to_owned(), count: count.unwrap_or(0), wrong: wrong.into_iter().collect() }
    }
}

impl Kept {
    /// Looks at everything.
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

    /// A sentence for each thing that is wrong.
    pub fn problems(&self) -> impl Iterator<Item = String> {
        let Self { settings, tables, runs, sessions, positions, player, calibration, daily_check, last } = self;
        let all = [settings, tables, runs, sessions, positions, player, calibration, daily_check, last];
        all.into_iter().flat_map(|found| found.wrong.iter().cloned())
    }
}

/// The strokes in a file of a calibration.
fn strokes(path: &Path) -> Found {
    Found::of(path, kept_entries(path).map(|entries| entries.trials.len()))
}

/// The last session, and those before it that can be gone on with.
fn last(path: &Path) -> Found {
    let last = SavedSession::load(path).map_err(|error| format!("{}: {error}", path.display()));
    Found::of(path, last.map(|last| last.map_or(0, |last| last.with_former().len())))
}

/// The user's own tables.
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

/// The user's runs.
fn runs(folder: &Path) -> Found {
    match if folder.exists() { runs_in(folder) } else { Ok(Listing::default()) } {
        Ok(Listing { runs, unreadable }) => Found { path: folder.to_owned(), count: runs.len(), wrong: unreadable },
        Err(error) => Found::of(folder, Err(format!("{}: {error}", folder.display()))),
    }
}
