//! Why a checkpoint cannot be used.

use crate::learning::nn::weights::WeightsError;

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
    /// The file cannot be read.
    #[error("{0}")]
    File(#[from] std::io::Error),
    /// A byte has changed.
    #[error("it is damaged: its content does not fit its checksum")]
    Checksum,
    /// There is no checksum.
    #[error("it has no checksum: it is damaged, or not a checkpoint of this version of carom")]
    NoChecksum,
    /// It is of another version.
    #[error("it has format {0}, and this version of carom reads format {FORMAT}")]
    Format(u32),
    /// Nobody can take it up.
    #[error("its agent \"{0}\" is not known to this version of carom")]
    Agent(String),
    /// The learner refuses it.
    #[error("{0}")]
    Content(#[from] WeightsError),
}
