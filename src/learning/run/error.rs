//! Why a run cannot start, go on or be saved.

use std::path::Path;

use crate::{
    learning::{
        PolicyError,
        agents::UnknownAgent,
        learner::StartError,
        nn::{first_line, weights::WeightsError},
    },
    printing::shell_word,
};

/// Why a run cannot start, go on or be saved.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// The folder already holds a run.
    #[error("{0} already holds a run; go on with it by --resume {call}, or choose another folder by --run", call = shell_word(.0))]
    Occupied(String),
    /// The folder holds something else.
    #[error("{folder} is not empty and holds no run: \"{entry}\" is in it; choose a new folder by --run")]
    Foreign {
        /// The folder.
        folder: String,
        /// Something in it.
        entry: String,
    },
    /// There is a file in the folder's place.
    #[error("{0} is a file, and a run needs a folder of its own; choose one that is new or empty by --run")]
    NoFolder(String),
    /// The folder holds no run.
    #[error(
        "{0} holds no run to go on with: it has no checkpoint.safetensors; carom train --list shows the runs there are"
    )]
    Missing(String),
    /// Another process works in the folder.
    #[error("another process is training in {0}; wait until it ends or stop it, or choose another folder by --run")]
    Busy(String),
    /// A file of the run cannot be read or written.
    #[error("{path} cannot be used: {reason}")]
    File {
        /// The file.
        path: String,
        /// What the system says.
        reason: std::io::Error,
    },
    /// No checkpoint is fit for use.
    #[error(
        "no checkpoint in {folder} can be gone on from: {current}{}",
        previous.as_ref().map_or_else(String::new, |previous| format!("; {previous}"))
    )]
    Checkpoints {
        /// The run's folder.
        folder: String,
        /// What is wrong with the last one.
        current: Box<Damage>,
        /// What is wrong with the one before, if there is one.
        previous: Option<Box<Damage>>,
    },
    /// The agent is not known.
    #[error(transparent)]
    Agent(#[from] UnknownAgent),
    /// The agent refuses its settings.
    #[error(transparent)]
    Start(#[from] StartError),
    /// The weights to start from do not suit.
    #[error("{path} has no weights for this run: {reason}")]
    Origin {
        /// The file or the run.
        path: String,
        /// What is wrong.
        reason: String,
    },
    /// The policy to start from cannot be used.
    #[error(transparent)]
    Policy(#[from] PolicyError),
    /// The state cannot be turned into a file.
    #[error("the state cannot be saved: {0}")]
    Save(#[from] WeightsError),
    /// The networks no longer give finite numbers.
    #[error("training stopped: {}", first_line(.0))]
    Training(#[from] candle_core::Error),
    /// The networks no longer give finite losses, after so many shots.
    #[error("training stopped after {0} shots: the loss is not a finite number any more; try a lower learning rate")]
    NotFinite(u64),
    /// The work since the last checkpoint could not be saved.
    #[error(
        "the run could not be saved after {shots} shots: {reason}; the last checkpoint is whole: make room, then go on \
         with: carom train --resume {call}",
        call = shell_word(folder)
    )]
    Unsaved {
        /// Shots played.
        shots: u64,
        /// What went wrong.
        reason: Box<Self>,
        /// The run's folder.
        folder: String,
    },
}

/// Version of what a checkpoint holds.
pub const FORMAT: u32 = 2;

/// Why a checkpoint cannot be gone on from.
#[derive(Debug, thiserror::Error)]
#[error("{path}: {reason}")]
pub struct Damage {
    pub(super) path: String,
    pub(super) reason: DamageReason,
}

/// Why the bytes of a checkpoint cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum DamageReason {
    #[error("{0}")]
    File(#[from] std::io::Error),
    #[error("it is damaged: its content does not fit its checksum")]
    Checksum,
    #[error("it has no checksum: it is damaged, or not a checkpoint of this version of carom")]
    NoChecksum,
    #[error("it has format {0}, and this version of carom reads format {FORMAT}")]
    Format(u32),
    #[error("its agent \"{0}\" is not known to this version of carom")]
    Agent(String),
    #[error("{0}")]
    Content(#[from] WeightsError),
}

/// The error of a file, for `map_err`.
pub fn file(path: &Path) -> impl FnOnce(std::io::Error) -> RunError {
    move |reason| RunError::File { path: path.display().to_string(), reason }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_that_goes_on_with_a_run_can_be_pasted() {
        let said = RunError::Occupied("d b/my run".to_owned()).to_string();
        assert!(said.starts_with("d b/my run already") && said.contains("--resume 'd b/my run', or"), "{said}");
        let reason = Box::new(RunError::NotFinite(1));
        let said = RunError::Unsaved { shots: 1, reason, folder: "r $x".to_owned() }.to_string();
        assert!(said.ends_with("carom train --resume 'r $x'"), "{said}");
    }
}
