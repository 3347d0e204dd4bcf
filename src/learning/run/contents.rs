//! What is in a checkpoint: the learner, the run's own state, and a checksum of it all.

use std::path::Path;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::{
    accumulator::Accumulator,
    checksum::{NO_CHECKSUM, is_whole, write_checksum},
    config::{Schedule, Start},
    error::{DamageReason, FORMAT},
};
use crate::{
    learning::{
        learner::{AgentKind, Learner},
        nn::weights::{Reader, WeightsError, Writer},
    },
    storage,
};

/// What a checkpoint says beside the learner's arrays. No clock goes in: equal states give equal files.
#[derive(Serialize, Deserialize)]
struct Header {
    /// First, so that it is found ([`write_checksum`]).
    checksum: String,
    format: u32,
    agent: String,
    /// Shots played, for programs that read only the header.
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
    #[serde(rename = "tally")]
    pub accumulator: Accumulator,
}

/// The bytes of a checkpoint.
///
/// # Errors
/// Whatever candle or safetensors reports.
pub fn bytes(learner: &dyn Learner, state: &State) -> Result<Vec<u8>, WeightsError> {
    let mut writer = Writer::default();
    let note = Header {
        checksum: NO_CHECKSUM.to_owned(),
        format: FORMAT,
        agent: learner.agent().to_owned(),
        shots: learner.shots(),
        state: state.clone(),
        learner: learner.save(&mut writer)?,
    };
    let mut bytes = writer.finish(&note)?;
    if write_checksum(&mut bytes) { Ok(bytes) } else { Err(WeightsError::Foreign) }
}

/// The learner and the run's state in a checkpoint's bytes.
///
/// # Errors
/// Where they are damaged or of another version.
pub fn restore(bytes: &[u8]) -> Result<(Box<dyn Learner>, State), DamageReason> {
    match is_whole(bytes) {
        Some(true) => {}
        Some(false) => return Err(DamageReason::Checksum),
        None => return Err(DamageReason::NoChecksum),
    }
    let reader = Reader::new(bytes)?;
    let Version { format } = reader.note()?;
    if format != FORMAT {
        return Err(DamageReason::Format(format));
    }
    let Header { agent, state, learner, .. } = reader.note()?;
    let agent = AgentKind::named(&agent).map_err(|_| DamageReason::Agent(agent))?;
    Ok(((agent.restore)(&reader, learner)?, state))
}

/// Whether the bytes claim to be a checkpoint, whole or not.
pub fn is_checkpoint(bytes: &[u8]) -> bool {
    is_whole(bytes).is_some()
}

/// The agent whose run wrote the checkpoint at `path`; `None` where that is no checkpoint, or cannot be read.
pub fn agent_of_checkpoint(path: &Path) -> Option<String> {
    #[derive(Deserialize)]
    struct Whose {
        agent: String,
    }
    let bytes = storage::read(path, storage::LARGE).ok().filter(|bytes| is_checkpoint(bytes))?;
    Some(Reader::new(&bytes).ok()?.note::<Whose>().ok()?.agent)
}

/// The part of a note that every version has.
#[derive(Deserialize)]
struct Version {
    format: u32,
}

/// Shots that the checkpoint at `path` has played; `None` where that cannot be read.
pub fn shots_in(path: &Path) -> Option<u64> {
    #[derive(Deserialize)]
    struct Progress {
        shots: u64,
    }
    let bytes = storage::read(path, storage::LARGE).ok()?;
    Some(Reader::new(&bytes).ok()?.note::<Progress>().ok()?.shots)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        learning::ddpg::trainer::{Trainer, tests::small_task},
        table::Table,
    };

    #[test]
    fn contents_of_other_formats_are_refused_by_number() {
        let learner = Trainer::new(small_task(), Table::default()).unwrap();
        let mut writer = Writer::default();
        let note = Header {
            checksum: NO_CHECKSUM.to_owned(),
            format: 99,
            agent: "ddpg".to_owned(),
            shots: 0,
            state: State { schedule: Schedule::for_shots(100), from: None, accumulator: Accumulator::default() },
            learner: learner.save(&mut writer).unwrap(),
        };
        let mut bytes = writer.finish(&note).unwrap();
        assert!(write_checksum(&mut bytes));
        let message = restore(&bytes).unwrap_err().to_string();
        assert!(message.contains("format 99") && message.contains("format 2"), "{message}");
    }
}
