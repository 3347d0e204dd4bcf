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
    /// The folder contains other files, such as this one.
    #[error("{0} is not empty and contains no run: \"{1}\" is in it; choose a new folder with --run")]
    Foreign(String, String),
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
    #[error("{0} cannot be used: {1}")]
    File(String, std::io::Error),
    /// No checkpoint in the folder is usable, for these reasons.
    #[error("no checkpoint in {0} can be used to resume: {1}")]
    Checkpoints(String, String),
    /// The agent is unknown.
    #[error(transparent)]
    Agent(#[from] UnknownAgent),
    /// The agent refuses its settings.
    #[error(transparent)]
    Start(#[from] StartError),
    /// The weights of this file or run do not fit the run that shall start from them, for this reason.
    #[error("{0} has no weights for this run: {1}")]
    Origin(String, String),
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
    /// The progress since the last checkpoint could not be saved: the shots played, the reason, and the run's folder.
    #[error(
        "the run could not be saved after {0} shots: {1}; the last checkpoint is intact: free some disk space, \
         then resume with: carom train --resume {call}",
        call = shell_word(.2)
    )]
    Unsaved(u64, Box<Self>, String),
}

/// Returns a converter of a file's error to a [`RunError`], for `map_err`.
pub fn file(path: &Path) -> impl FnOnce(std::io::Error) -> RunError {
    move |reason| RunError::File(path.display().to_string(), reason)
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
        let message = RunError::Unsaved(1, reason, "r $x".to_owned()).to_string();
        assert!(message.ends_with("carom train --resume 'r $x'"), "{message}");
    }
}
