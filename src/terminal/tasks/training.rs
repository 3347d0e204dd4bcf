//! Background tasks of the training page, and their reports.

use std::{
    ffi::OsString,
    path::{Path, PathBuf},
    sync::Arc,
};

use crate::{
    learning::{
        Policy,
        policy::library::{self, SavePolicyError},
        run::{POLICY, follow::Update, list::Listing, request::Request},
    },
    terminal::Reel,
};

/// Why the coach cannot use a run's networks.
pub const NO_POLICY: &str = "the run has no networks for the coach: they come with the first measurement, and the \
                             thesis' agents have none";

/// One of the two runs that can be followed at once.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FollowSlot {
    /// The run on the screen.
    Main,
    /// The run compared with it.
    Compared,
}

impl FollowSlot {
    /// Both slots.
    pub const ALL: [Self; 2] = [Self::Main, Self::Compared];
}

/// What is polled, for as long as a page needs it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Subscriptions {
    /// The folder whose runs are listed.
    pub runs: Option<PathBuf>,
    /// The folders of the followed runs, each with the number of its opening, in the order of [`FollowSlot::ALL`].
    pub followed: [Option<(PathBuf, u64)>; 2],
    /// The folder in which another player shares their table.
    pub followed_table: Option<PathBuf>,
}

/// A training process to be started.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Launch {
    /// Its command-line arguments.
    pub arguments: Vec<OsString>,
    /// The run's folder.
    pub folder: PathBuf,
}

impl Launch {
    /// Resumes the run in `folder`.
    pub fn resume(folder: &Path) -> Self {
        let arguments = vec!["train".into(), "--resume".into(), folder.into()];
        Self { arguments, folder: folder.to_owned() }
    }
}

/// Failure of a training process.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TrainerFailure {
    /// The process ID, if it could be started.
    pub process: Option<u32>,
    /// The reason, in a sentence.
    pub sentence: String,
}

/// A policy to be saved under a name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SavePolicyTask {
    /// The policy's file.
    pub from: PathBuf,
    /// Folder of the saved policies.
    pub folder: PathBuf,
    /// The name.
    pub name: String,
    /// Whether an existing policy of this name may be replaced.
    pub replace: bool,
}

impl SavePolicyTask {
    /// Saves the policy; `false` if its name is taken.
    ///
    /// # Errors
    /// A message if there is no policy, or the copy cannot be written.
    pub fn save(&self) -> Result<bool, String> {
        if !self.from.exists() {
            return Err(NO_POLICY.to_owned());
        }
        match library::save(&self.folder, &self.from, &self.name, self.replace) {
            Ok(_) => Ok(true),
            Err(SavePolicyError::Exists(_)) => Ok(false),
            Err(error) => Err(error.to_string()),
        }
    }
}

/// Loads the policy of the run in `folder` for the coach.
///
/// # Errors
/// A message if there is none, or it cannot be used.
pub fn load_policy(folder: &Path) -> Result<Arc<Policy>, String> {
    let path = folder.join(POLICY);
    if !path.exists() {
        return Err(NO_POLICY.to_owned());
    }
    Policy::load(&path).map(Arc::new).map_err(|error| error.to_string())
}

/// A report from the training page's background tasks. Errors are sentences.
#[derive(Debug)]
pub enum TrainingReport {
    /// The list of runs.
    Runs(Result<Listing, String>),
    /// News of the followed run in a folder.
    Followed(FollowSlot, PathBuf, Box<Update>),
    /// The latest shots of the run in a folder, recorded.
    Recorded(PathBuf, Reel),
    /// The training process for a folder has failed.
    TrainerFailed(PathBuf, TrainerFailure),
    /// Whether the followed run in a folder has a policy by now.
    HasPolicy(PathBuf, bool),
    /// A request was sent to a run.
    Sent(Request, Result<(), String>),
    /// Result of saving a policy: `true` if saved, `false` if its name is taken.
    PolicySaved(SavePolicyTask, Result<bool, String>),
    /// The policy of the run in a folder.
    Policy(PathBuf, Result<Arc<Policy>, String>),
}
