//! Background tasks of the training page, and their reports.

use std::{
    ffi::OsString,
    path::{Path, PathBuf},
    sync::Arc,
};

use crate::{
    learning::{
        Policy,
        policy::kept::{self, KeepError},
        run::{POLICY, follow::Update, list::Listing, request::Request},
    },
    terminal::Reel,
};

/// Why a run's networks are of no use to the coach.
pub const NO_POLICY: &str = "the run has no networks for the coach: they come with the first measurement, and the \
                             thesis' agents have none";

/// Which of the two runs that can be followed at once.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FollowSlot {
    /// The one that is watched.
    Main,
    /// The one that it is compared with.
    Compared,
}

impl FollowSlot {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Main, Self::Compared];
}

/// What is to be found out again and again, as long as it is wanted.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Subscriptions {
    /// The folder whose runs are listed.
    pub runs: Option<PathBuf>,
    /// The runs that are followed, in the order of [`FollowSlot::ALL`].
    pub followed: [Option<PathBuf>; 2],
    /// The folder in which somebody else shows their table.
    pub shown: Option<PathBuf>,
}

/// A process that trains, to be started.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Launch {
    /// What follows the program's name on its command line.
    pub arguments: Vec<OsString>,
    /// The run's folder.
    pub folder: PathBuf,
}

impl Launch {
    /// Going on with the run in `folder`.
    pub fn resume(folder: &Path) -> Self {
        let arguments = vec!["train".into(), "--resume".into(), folder.into()];
        Self { arguments, folder: folder.to_owned() }
    }
}

/// How a process that trains has failed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TrainerFailure {
    /// The process, where it could be started.
    pub process: Option<u32>,
    /// Why it has failed, in a sentence.
    pub sentence: String,
}

/// A policy to be kept under a name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Keeping {
    /// The policy's file.
    pub from: PathBuf,
    /// Where policies are kept.
    pub folder: PathBuf,
    /// The name.
    pub name: String,
    /// Whether a policy that has the name already may be replaced.
    pub replace: bool,
}

impl Keeping {
    /// Keeps it; `false` where its name is taken.
    ///
    /// # Errors
    /// A sentence where there is none, or the copy cannot be written.
    pub fn keep(&self) -> Result<bool, String> {
        if !self.from.exists() {
            return Err(NO_POLICY.to_owned());
        }
        match kept::keep(&self.folder, &self.from, &self.name, self.replace) {
            Ok(_) => Ok(true),
            Err(KeepError::Taken(_)) => Ok(false),
            Err(error) => Err(error.to_string()),
        }
    }
}

/// The policy of the run in `folder`, for the coach.
///
/// # Errors
/// A sentence where there is none, or none that can be used.
pub fn load_policy(folder: &Path) -> Result<Arc<Policy>, String> {
    let path = folder.join(POLICY);
    if !path.exists() {
        return Err(NO_POLICY.to_owned());
    }
    Policy::load(&path).map(Arc::new).map_err(|error| error.to_string())
}

/// A report from the training page's background tasks. Where it failed, a sentence says why.
#[derive(Debug)]
pub enum TrainingReport {
    /// The runs there are.
    Runs(Result<Listing, String>),
    /// News of the run in a folder that is followed.
    Followed(FollowSlot, PathBuf, Box<Update>),
    /// The latest shots of the run in a folder, recorded.
    Recorded(PathBuf, Reel),
    /// The process that was to train in a folder has failed.
    TrainerFailed(PathBuf, TrainerFailure),
    /// Whether the run in a folder that is followed has a policy by now.
    HasPolicy(PathBuf, bool),
    /// A run was asked for something.
    Sent(Request, Result<(), String>),
    /// A policy was to be kept: whether it is, or its name is taken.
    Kept(Keeping, Result<bool, String>),
    /// The policy of the run in a folder.
    Policy(PathBuf, Result<Arc<Policy>, String>),
}
