//! Checkpoints: the last one and the one before, each whole and verified, so that one of them can always be gone on
//! from.

use std::{
    io::Read,
    path::{Path, PathBuf},
};

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::{
    checksum::{UNSEALED, is_whole, seal},
    config::{Schedule, Start},
    error::RunError,
    tally::Tally,
};
use crate::{
    learning::{
        learner::{Agent, Learner},
        weights::{Reader, WeightsError, Writer},
    },
    storage::Staged,
};

/// The last checkpoint.
pub const CURRENT: &str = "checkpoint.safetensors";

/// The one before.
pub const PREVIOUS: &str = "checkpoint-previous.safetensors";

/// Version of what a checkpoint holds.
const FORMAT: u32 = 2;

/// Longest header that is believed, bytes. Notes and names of arrays take some thousands.
const LONGEST_HEADER: u64 = 1 << 24;

/// What a checkpoint says beside the learner's arrays. No clock goes in: equal states give equal files.
#[derive(Serialize, Deserialize)]
struct Note {
    /// First, so that it is found ([`seal`]).
    checksum: String,
    format: u32,
    agent: String,
    /// Shots played, for whoever reads nothing but the header.
    shots: u64,
    #[serde(flatten)]
    state: State,
    learner: Value,
}

/// What of a run lives beside its learner.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// When it reports and is measured.
    pub schedule: Schedule,
    /// Whose weights it started from.
    pub from: Option<Start>,
    /// What it has to report next.
    pub tally: Tally,
}

/// Why a checkpoint cannot be gone on from.
#[derive(Debug, thiserror::Error)]
#[error("{path}: {reason}")]
pub struct Damage {
    path: String,
    reason: DamageReason,
}

#[derive(Debug, thiserror::Error)]
enum DamageReason {
    #[error("{0}")]
    File(#[from] std::io::Error),
    #[error("it is damaged: its content does not fit its checksum")]
    Checksum,
    #[error("it has no checksum: it is damaged, or not a checkpoint of this version of carom")]
    Unsealed,
    #[error("it has format {0}, and this version of carom reads format {FORMAT}")]
    Format(u32),
    #[error("its agent \"{0}\" is not known to this version of carom")]
    Agent(String),
    #[error("{0}")]
    Content(#[from] WeightsError),
}

/// The bytes of a checkpoint.
///
/// # Errors
/// Whatever candle or safetensors reports.
pub fn bytes(learner: &dyn Learner, state: &State) -> Result<Vec<u8>, WeightsError> {
    let mut writer = Writer::default();
    let note = Note {
        checksum: UNSEALED.to_owned(),
        format: FORMAT,
        agent: learner.agent().to_owned(),
        shots: learner.shots(),
        state: state.clone(),
        learner: learner.save(&mut writer)?,
    };
    let mut bytes = writer.finish(&note)?;
    if seal(&mut bytes) { Ok(bytes) } else { Err(WeightsError::Foreign) }
}

/// The learner and the run's state in a checkpoint's bytes.
fn restore(bytes: &[u8]) -> Result<(Box<dyn Learner>, State), DamageReason> {
    match is_whole(bytes) {
        Some(true) => {}
        Some(false) => return Err(DamageReason::Checksum),
        None => return Err(DamageReason::Unsealed),
    }
    let reader = Reader::new(bytes)?;
    let Version { format } = reader.note()?;
    if format != FORMAT {
        return Err(DamageReason::Format(format));
    }
    let Note { agent, state, learner, .. } = reader.note()?;
    let agent = Agent::named(&agent).map_err(|_| DamageReason::Agent(agent))?;
    Ok(((agent.restore)(&reader, learner)?, state))
}

/// Whether the bytes claim to be a checkpoint, whole or not.
pub fn is_checkpoint(bytes: &[u8]) -> bool {
    is_whole(bytes).is_some()
}

/// What the checkpoint with these bytes, read from `path`, holds.
///
/// # Errors
/// Where it is damaged or of another version.
pub fn load(path: &Path, bytes: Vec<u8>) -> Result<Loaded, RunError> {
    let (learner, state) = restore(&bytes).map_err(|reason| RunError::Checkpoints {
        folder: path.parent().unwrap_or(path).display().to_string(),
        current: Box::new(Damage { path: path.display().to_string(), reason }),
        previous: None,
    })?;
    Ok(Loaded { learner, state, bytes, fallback: None })
}

/// The part of a note that every version has.
#[derive(Deserialize)]
struct Version {
    format: u32,
}

/// Shots that the checkpoint in `folder` has played, from its header alone; `None` where that cannot be read.
pub fn shots_in(folder: &Path) -> Option<u64> {
    #[derive(Deserialize)]
    struct Header {
        #[serde(rename = "__metadata__")]
        metadata: std::collections::HashMap<String, String>,
    }
    #[derive(Deserialize)]
    struct Progress {
        shots: u64,
    }
    let read = |name: &str| {
        let mut file = std::fs::File::open(folder.join(name)).ok()?;
        let mut length = [0; 8];
        file.read_exact(&mut length).ok()?;
        let length = u64::from_le_bytes(length).min(LONGEST_HEADER);
        let mut text = String::new();
        file.take(length).read_to_string(&mut text).ok()?;
        let header: Header = serde_json::from_str(&text).ok()?;
        let progress: Progress = serde_json::from_str(header.metadata.get("carom")?).ok()?;
        Some(progress.shots)
    };
    read(CURRENT).or_else(|| read(PREVIOUS))
}

/// What a run goes on from.
#[derive(Debug)]
pub struct Loaded {
    /// The learner.
    pub learner: Box<dyn Learner>,
    /// The run's own state.
    pub state: State,
    /// The checkpoint's bytes.
    pub bytes: Vec<u8>,
    /// Why it is the one before the last, if it is.
    pub fallback: Option<Damage>,
}

/// The checkpoints of a folder.
#[derive(Debug)]
pub struct Checkpoints {
    folder: PathBuf,
    /// Whether the last one is fit to become the one before. A damaged one must not push out a whole one.
    current_is_whole: bool,
}

impl Checkpoints {
    /// Those of a run that has none yet.
    pub fn new(folder: &Path) -> Self {
        Self { folder: folder.to_owned(), current_is_whole: false }
    }

    /// Those that are there, and what the newer one of them that is whole holds.
    ///
    /// # Errors
    /// [`RunError::Missing`] or [`RunError::Checkpoints`].
    pub fn open(folder: &Path) -> Result<(Self, Loaded), RunError> {
        let read = |name: &str| {
            let path = folder.join(name);
            let read = || {
                let bytes = std::fs::read(&path)?;
                let (learner, state) = restore(&bytes)?;
                Ok(Loaded { learner, state, bytes, fallback: None })
            };
            read().map_err(|reason| Damage { path: path.display().to_string(), reason })
        };
        let is_missing = |damage: &Damage| match &damage.reason {
            DamageReason::File(error) => error.kind() == std::io::ErrorKind::NotFound,
            _ => false,
        };
        let current = match read(CURRENT) {
            Ok(loaded) => return Ok((Self { folder: folder.to_owned(), current_is_whole: true }, loaded)),
            Err(damage) => damage,
        };
        match read(PREVIOUS) {
            Ok(loaded) => Ok((Self::new(folder), Loaded { fallback: Some(current), ..loaded })),
            Err(previous) if is_missing(&previous) && is_missing(&current) => {
                Err(RunError::Missing(folder.display().to_string()))
            }
            Err(previous) => {
                let previous = (!is_missing(&previous)).then(|| Box::new(previous));
                let current = Box::new(current);
                Err(RunError::Checkpoints { folder: folder.display().to_string(), current, previous })
            }
        }
    }

    /// Adds a checkpoint; the last one becomes the one before.
    ///
    /// # Errors
    /// Whatever the file system reports. The whole ones that were there are still there.
    pub fn write(&mut self, bytes: &[u8]) -> std::io::Result<()> {
        let current = self.folder.join(CURRENT);
        let staged = Staged::new(&current, bytes)?;
        // Killed between the two renames, the run goes on from the one before.
        if std::mem::take(&mut self.current_is_whole) {
            std::fs::rename(&current, self.folder.join(PREVIOUS))?;
        }
        staged.publish()?;
        self.current_is_whole = true;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        learning::trainer::{Trainer, tests::small_task},
        table::Table,
    };
    use std::fs;

    fn state() -> State {
        State { schedule: Schedule::for_shots(100), from: None, tally: Tally::default() }
    }

    /// A folder with two checkpoints, and the shots that each has played.
    fn folder_of_two() -> (tempfile::TempDir, Checkpoints, [u64; 2]) {
        let folder = tempfile::tempdir().unwrap();
        let mut learner = Trainer::new(small_task(), Table::default()).unwrap();
        let mut checkpoints = Checkpoints::new(folder.path());
        let shots = [(); 2].map(|()| {
            learner.turn().unwrap();
            checkpoints.write(&bytes(&learner, &state()).unwrap()).unwrap();
            learner.shots()
        });
        (folder, checkpoints, shots)
    }

    fn shots_after_opening(folder: &Path) -> Result<(u64, bool), RunError> {
        Checkpoints::open(folder).map(|(_, loaded)| (loaded.learner.shots(), loaded.fallback.is_some()))
    }

    #[test]
    fn the_last_one_is_used_and_the_one_before_where_it_is_damaged_or_missing() {
        let (folder, _, [before, last]) = folder_of_two();
        let (current, previous) = (folder.path().join(CURRENT), folder.path().join(PREVIOUS));
        assert_eq!(shots_after_opening(folder.path()).unwrap(), (last, false));
        assert_eq!(shots_in(folder.path()), Some(last));
        let whole = fs::read(&current).unwrap();
        // The length of the header, the header, its end, the arrays' begin and end.
        for index in [0, 7, 9, 60, whole.len() / 2, whole.len() - 1] {
            let mut damaged = whole.clone();
            damaged[index] ^= 4;
            fs::write(&current, damaged).unwrap();
            assert_eq!(shots_after_opening(folder.path()).unwrap(), (before, true), "byte {index}");
        }
        fs::remove_file(&current).unwrap();
        assert_eq!(shots_after_opening(folder.path()).unwrap(), (before, true));
        fs::write(&current, &whole[..whole.len() - 1]).unwrap();
        fs::write(&previous, b"").unwrap();
        let message = shots_after_opening(folder.path()).unwrap_err().to_string();
        assert!(message.contains(CURRENT) && message.contains(PREVIOUS) && message.contains("damaged"), "{message}");
        fs::remove_file(current).unwrap();
        fs::remove_file(previous).unwrap();
        assert!(matches!(shots_after_opening(folder.path()), Err(RunError::Missing(_))));
    }

    #[test]
    fn a_damaged_one_does_not_push_out_the_whole_one_before() {
        let (folder, _, [before, _]) = folder_of_two();
        fs::write(folder.path().join(CURRENT), b"damaged").unwrap();
        let (mut checkpoints, loaded) = Checkpoints::open(folder.path()).unwrap();
        checkpoints.write(b"the disk lies").unwrap();
        assert_eq!(loaded.learner.shots(), before);
        assert_eq!(shots_after_opening(folder.path()).unwrap(), (before, true));
    }

    #[test]
    fn one_that_cannot_be_written_leaves_both_and_nothing_else() {
        let (folder, mut checkpoints, [_, last]) = folder_of_two();
        let files = || {
            let mut names: Vec<_> = fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().path()).collect();
            names.sort();
            names.into_iter().map(|path| (fs::read(&path).unwrap_or_default(), path)).collect::<Vec<_>>()
        };
        // A folder that is not there stands for a disk that takes nothing: no right can be withdrawn from root.
        let before = files();
        checkpoints.folder = folder.path().join(CURRENT);
        assert!(checkpoints.write(b"no room").is_err());
        checkpoints.folder = folder.path().to_owned();
        assert_eq!(files(), before);
        assert_eq!(shots_after_opening(folder.path()).unwrap(), (last, false));
    }

    #[test]
    fn checkpoints_of_other_formats_are_refused_by_number() {
        let folder = tempfile::tempdir().unwrap();
        let learner = Trainer::new(small_task(), Table::default()).unwrap();
        let mut writer = Writer::default();
        let note = Note {
            checksum: UNSEALED.to_owned(),
            format: 99,
            agent: "ddpg".to_owned(),
            shots: 0,
            state: state(),
            learner: learner.save(&mut writer).unwrap(),
        };
        let mut bytes = writer.finish(&note).unwrap();
        assert!(seal(&mut bytes));
        fs::write(folder.path().join(CURRENT), bytes).unwrap();
        let message = shots_after_opening(folder.path()).unwrap_err().to_string();
        assert!(message.contains("format 99") && message.contains("format 2"), "{message}");
    }
}
