//! The errors of training runs.

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

/// A run cannot start, resume or be saved.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// The folder already contains a run.
    #[error("{0} already contains a run; resume it with --resume {call}, or choose another folder with --run", call = shell_word(.0))]
    Occupied(String),
    /// The folder contains other files.
    #[error("{folder} is not empty and contains no run: \"{entry}\" is in it; choose a new folder with --run")]
    Foreign {
        /// The folder.
        folder: String,
        /// One of its entries.
        entry: String,
    },
    /// The path is a file, not a folder.
    #[error("{0} is a file, and a run needs a folder of its own; choose a new or empty one with --run")]
    NoFolder(String),
    /// The folder contains no run.
    #[error(
        "{0} contains no run to resume: it has no checkpoint.safetensors; carom train --list shows the existing runs"
    )]
    Missing(String),
    /// Another process works in the folder.
    #[error("another process is training in {0}; wait until it ends or stop it, or choose another folder with --run")]
    Busy(String),
    /// A file of the run cannot be read or written.
    #[error("{path} cannot be {}: {reason}", participle(reason))]
    File {
        /// Path of the file.
        path: String,
        /// Error of the operating system.
        reason: std::io::Error,
    },
    /// No checkpoint is usable.
    #[error(
        "no checkpoint in {folder} can be used to resume: {current}{}",
        previous.as_ref().map_or_else(String::new, |previous| format!("; {previous}"))
    )]
    Checkpoints {
        /// The run's folder.
        folder: String,
        /// Damage of the current checkpoint.
        current: Box<Damage>,
        /// Damage of the previous checkpoint, if it exists.
        previous: Option<Box<Damage>>,
    },
    /// The agent is unknown.
    #[error(transparent)]
    Agent(#[from] UnknownAgent),
    /// The agent refuses its settings.
    #[error(transparent)]
    Start(#[from] StartError),
    /// The weights to start from do not fit the run.
    #[error("{path} has no weights for this run: {reason}")]
    Origin {
        /// The file or the run.
        path: String,
        /// Reason.
        reason: String,
    },
    /// The policy to start from cannot be used.
    #[error(transparent)]
    Policy(#[from] PolicyError),
    /// The state cannot be serialized.
    #[error("the state cannot be saved: {0}")]
    Save(#[from] WeightsError),
    /// The networks no longer return finite numbers.
    #[error("training stopped: {}", first_line(.0))]
    Training(#[from] candle_core::Error),
    /// The loss is no longer finite, after this number of shots.
    #[error("training stopped after {0} shots: the loss is not a finite number any more; try a lower learning rate")]
    NotFinite(u64),
    /// The progress since the last checkpoint could not be saved.
    #[error(
        "the run could not be saved after {shots} shots: {reason}; the last checkpoint is intact: free some disk space, \
         then resume with: carom train --resume {call}",
        call = shell_word(folder)
    )]
    Unsaved {
        /// Shots played.
        shots: u64,
        /// Reason.
        reason: Box<Self>,
        /// The run's folder.
        folder: String,
    },
}

/// Returns what cannot be done with a file: a full or read-only disk only refuses writing.
fn participle(reason: &std::io::Error) -> &'static str {
    use std::io::ErrorKind::{QuotaExceeded, ReadOnlyFilesystem, StorageFull};
    match reason.kind() {
        QuotaExceeded | ReadOnlyFilesystem | StorageFull => "written",
        _ => "used",
    }
}

/// Version of the checkpoint format.
pub const FORMAT: u32 = 2;

/// A checkpoint cannot be used to resume.
#[derive(Debug, thiserror::Error)]
#[error("{path}: {reason}")]
pub struct Damage {
    pub(super) path: String,
    pub(super) reason: DamageReason,
}

/// Reason why the bytes of a checkpoint cannot be used.
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

/// Returns a converter of a file's error to a [`RunError`], for `map_err`.
pub fn file(path: &Path) -> impl FnOnce(std::io::Error) -> RunError {
    move |reason| RunError::File { path: path.display().to_string(), reason }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_resume_command_can_be_pasted() {
        let message = RunError::Occupied("d b/my run".to_owned()).to_string();
        assert!(
            message.starts_with("d b/my run already") && message.contains("--resume 'd b/my run', or"),
            "{message}"
        );
        let reason = Box::new(RunError::NotFinite(1));
        let message = RunError::Unsaved { shots: 1, reason, folder: "r $x".to_owned() }.to_string();
        assert!(message.ends_with("carom train --resume 'r $x'"), "{message}");
    }
}
