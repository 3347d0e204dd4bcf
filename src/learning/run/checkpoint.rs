//! Checkpoints: the last one and the one before, each whole and verified, so that one of them can always be gone on
//! from.

use std::{
    io,
    path::{Path, PathBuf},
};

use super::{
    contents::{self, State, restore},
    error::{Damage, DamageReason, RunError},
};
use crate::{
    learning::learner::Learner,
    storage::{self, Staged},
};

/// The last checkpoint.
pub const CURRENT: &str = "checkpoint.safetensors";

/// The one before.
pub const PREVIOUS: &str = "checkpoint-previous.safetensors";

/// What the checkpoint with these bytes, read from `path`, holds.
pub fn load(path: &Path, bytes: Vec<u8>) -> Result<Loaded, RunError> {
    loaded(path, Ok(bytes)).map_err(|damage| RunError::Checkpoints {
        folder: path.parent().unwrap_or(path).display().to_string(),
        current: Box::new(damage),
        previous: None,
    })
}

fn loaded(path: &Path, bytes: io::Result<Vec<u8>>) -> Result<Loaded, Damage> {
    let load = || {
        let bytes = bytes?;
        let (learner, state) = restore(&bytes)?;
        Ok(Loaded { learner, state, bytes, fallback: None })
    };
    load().map_err(|reason| Damage { path: path.display().to_string(), reason })
}

/// Shots that the newer checkpoint in `folder` that says so has played.
pub fn shots_in(folder: &Path) -> Option<u64> {
    [CURRENT, PREVIOUS].iter().find_map(|name| contents::shots_in(&folder.join(name)))
}

/// What a run goes on from.
#[derive(Debug)]
pub struct Loaded {
    pub learner: Box<dyn Learner>,
    pub state: State,
    pub bytes: Vec<u8>,
    /// Why it is the one before the last, if it is.
    pub fallback: Option<Damage>,
}

impl Loaded {
    /// What is told of a damaged last checkpoint.
    pub fn notice(&self) -> Option<String> {
        let damage = self.fallback.as_ref()?;
        Some(format!("{damage}; going on from {PREVIOUS}, after {} shots", self.learner.shots()))
    }
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
        let read = |name: &str| loaded(&folder.join(name), storage::read(&folder.join(name), storage::LARGE));
        let is_missing = |damage: &Damage| match &damage.reason {
            DamageReason::File(error) => error.kind() == io::ErrorKind::NotFound,
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
    pub fn write(&mut self, bytes: &[u8]) -> io::Result<()> {
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
        learning::{
            ddpg::trainer::{Trainer, tests::small_task},
            run::{
                config::Schedule,
                contents::{Accumulator, bytes},
            },
        },
        table::Table,
    };
    use std::fs;

    fn state() -> State {
        State { schedule: Schedule::for_shots(100), from: None, accumulator: Accumulator::default() }
    }

    /// A folder with two checkpoints, and the shots that each has played.
    fn folder_of_two() -> (tempfile::TempDir, [u64; 2]) {
        let folder = tempfile::tempdir().unwrap();
        let mut learner = Trainer::new(small_task(), Table::default()).unwrap();
        let mut checkpoints = Checkpoints::new(folder.path());
        let shots = [(); 2].map(|()| {
            learner.iterate().unwrap();
            checkpoints.write(&bytes(&learner, &state()).unwrap()).unwrap();
            learner.shots()
        });
        (folder, shots)
    }

    fn shots_after_opening(folder: &Path) -> Result<(u64, bool), RunError> {
        Checkpoints::open(folder).map(|(_, loaded)| (loaded.learner.shots(), loaded.fallback.is_some()))
    }

    #[test]
    fn the_last_one_is_used_and_the_one_before_where_it_is_missing() {
        let (folder, [before, last]) = folder_of_two();
        assert_eq!(shots_after_opening(folder.path()).unwrap(), (last, false));
        assert_eq!(shots_in(folder.path()), Some(last));
        fs::remove_file(folder.path().join(CURRENT)).unwrap();
        assert_eq!(shots_after_opening(folder.path()).unwrap(), (before, true));
        fs::remove_file(folder.path().join(PREVIOUS)).unwrap();
        assert!(matches!(shots_after_opening(folder.path()), Err(RunError::Missing(_))));
    }

    #[test]
    fn a_damaged_one_does_not_push_out_the_whole_one_before() {
        let (folder, [before, _]) = folder_of_two();
        fs::write(folder.path().join(CURRENT), b"damaged").unwrap();
        let (mut checkpoints, loaded) = Checkpoints::open(folder.path()).unwrap();
        checkpoints.write(b"the disk lies").unwrap();
        assert_eq!(loaded.learner.shots(), before);
        assert_eq!(shots_after_opening(folder.path()).unwrap(), (before, true));
    }
}
