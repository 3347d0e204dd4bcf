//! Checkpoints: the current and the previous one, each complete and checksummed, so that a run can always be resumed from one of them.
//! Each contains the learner, the run's own state, and a checksum of both.

use std::{
    io,
    path::{Path, PathBuf},
};

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::{
    config::{Provenance, Schedule},
    error::{Damage, DamageReason, FORMAT, RunError},
};
use crate::{
    learning::{
        checksum::{CHECKPOINT_FIELD, CHECKSUM_PLACEHOLDER, is_intact, write_checksum},
        learner::{AgentKind, Iteration, Learner},
        nn::weights::{Reader, WeightsError, Writer},
    },
    storage::{self, StagedFile},
};

/// File name of the current checkpoint.
pub const CURRENT: &str = "checkpoint.safetensors";

/// File name of the previous checkpoint.
pub const PREVIOUS: &str = "checkpoint-previous.safetensors";

/// Parses a checkpoint's `bytes`, which were read from `path`.
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

/// Returns the shots played at the current checkpoint in `folder`, or at the previous one if the current one cannot be read.
pub fn shots_in(folder: &Path) -> Option<u64> {
    [CURRENT, PREVIOUS].iter().find_map(|name| note_entry(&folder.join(name), "shots")?.as_u64())
}

/// A loaded checkpoint, from which a run resumes.
#[derive(Debug)]
pub struct Loaded {
    pub learner: Box<dyn Learner>,
    pub state: State,
    pub bytes: Vec<u8>,
    /// Damage of the current checkpoint, if this is the previous one.
    pub fallback: Option<Damage>,
}

impl Loaded {
    /// Returns the warning about a damaged current checkpoint.
    pub fn notice(&self) -> Option<String> {
        let damage = self.fallback.as_ref()?;
        Some(format!("{damage}; going on from {PREVIOUS}, after {} shots", self.learner.shots()))
    }
}

/// The checkpoints of a folder.
#[derive(Debug)]
pub struct Checkpoints {
    folder: PathBuf,
    /// Whether the current checkpoint is intact and may become the previous one. A damaged one must not replace an intact one.
    current_is_intact: bool,
}

impl Checkpoints {
    /// Creates the checkpoints of a run that has none yet.
    pub fn new(folder: &Path) -> Self {
        Self { folder: folder.to_owned(), current_is_intact: false }
    }

    /// Opens the checkpoints in `folder` and loads the newest intact one.
    ///
    /// # Errors
    /// [`RunError::Missing`] or [`RunError::Checkpoints`].
    pub fn open(folder: &Path) -> Result<(Self, Loaded), RunError> {
        let read = |name: &str| loaded(&folder.join(name), storage::read(&folder.join(name), storage::MAX_LARGE_FILE));
        let is_missing = |damage: &Damage| match &damage.reason {
            DamageReason::File(error) => error.kind() == io::ErrorKind::NotFound,
            _ => false,
        };
        let current = match read(CURRENT) {
            Ok(loaded) => return Ok((Self { folder: folder.to_owned(), current_is_intact: true }, loaded)),
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

    /// Writes a new checkpoint; the current one becomes the previous one.
    ///
    /// # Errors
    /// The errors of the file system. Existing intact checkpoints are kept.
    pub fn write(&mut self, bytes: &[u8]) -> io::Result<()> {
        let current = self.folder.join(CURRENT);
        let staged = StagedFile::new(&current, bytes)?;
        // If the process is killed between the two renames, the run resumes from the previous one.
        if std::mem::take(&mut self.current_is_intact) {
            std::fs::rename(&current, self.folder.join(PREVIOUS))?;
        }
        staged.publish()?;
        self.current_is_intact = true;
        Ok(())
    }
}

/// The JSON note of a checkpoint, next to the learner's arrays. It contains no time of day, so equal states give equal files.
#[derive(Serialize, Deserialize)]
struct Header {
    /// Must be the first field, because [`write_checksum`] finds it by the opening brace.
    checksum: String,
    format: u32,
    agent: String,
    /// Shots played, for programs that read only the header.
    shots: u64,
    #[serde(flatten)]
    state: State,
    learner: Value,
}

/// The run's own state, next to that of its learner.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct State {
    pub schedule: Schedule,
    pub from: Option<Provenance>,
    /// Sums for the next line of metrics.
    #[serde(rename = "tally")]
    pub accumulator: Accumulator,
}

/// Sums over shots and updates. They are part of a checkpoint, so that a line's means do not depend on where a run was interrupted. Sums of
/// older versions, which weighted iterations of different lengths equally, are ignored.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Accumulator {
    shots: u64,
    updates: u64,
    reward_sum: f64,
    value_sum: f64,
    critic_loss_sum: f64,
    actor_loss_sum: Option<f64>,
}

impl Accumulator {
    /// Adds an iteration of `shots` shots and `updates` updates. Returns `false` if a sum is no longer finite.
    #[must_use]
    pub fn add(&mut self, iteration: &Iteration, shots: u64, updates: u64) -> bool {
        let Iteration { mean_reward, q_value, critic_loss, actor_loss } = *iteration;
        self.shots += shots;
        self.updates += updates;
        self.reward_sum += shots as f64 * mean_reward;
        self.value_sum += updates as f64 * q_value;
        self.critic_loss_sum += updates as f64 * critic_loss;
        if let Some(loss) = actor_loss {
            *self.actor_loss_sum.get_or_insert_default() += updates as f64 * loss;
        }
        let sums = [self.reward_sum, self.value_sum, self.critic_loss_sum, self.actor_loss_sum.unwrap_or_default()];
        sums.iter().all(|sum| sum.is_finite())
    }

    /// Returns the means over the shots and the updates added since the last call, and resets the sums.
    pub fn take(&mut self) -> Iteration {
        let Self { shots, updates, reward_sum, value_sum, critic_loss_sum, actor_loss_sum } = std::mem::take(self);
        let [shots, updates] = [shots, updates].map(|count| count.max(1) as f64);
        Iteration {
            mean_reward: reward_sum / shots,
            q_value: value_sum / updates,
            critic_loss: critic_loss_sum / updates,
            actor_loss: actor_loss_sum.map(|sum| sum / updates),
        }
    }
}

/// Returns the bytes of a checkpoint.
pub fn bytes(learner: &dyn Learner, state: &State) -> Result<Vec<u8>, WeightsError> {
    let mut writer = Writer::default();
    let note = Header {
        checksum: CHECKSUM_PLACEHOLDER.to_owned(),
        format: FORMAT,
        agent: learner.agent().to_owned(),
        shots: learner.shots(),
        state: state.clone(),
        learner: learner.save(&mut writer)?,
    };
    let mut bytes = writer.finish(&note)?;
    if write_checksum(CHECKPOINT_FIELD, &mut bytes) { Ok(bytes) } else { Err(WeightsError::Metadata) }
}

/// Restores the learner and the run's state from a checkpoint's bytes.
fn restore(bytes: &[u8]) -> Result<(Box<dyn Learner>, State), DamageReason> {
    if !is_intact(CHECKPOINT_FIELD, bytes).ok_or(DamageReason::NoChecksum)? {
        return Err(DamageReason::Checksum);
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

/// Returns the agent of the checkpoint at `path`; `None` if the file is not a checkpoint or cannot be read.
pub fn agent_of_checkpoint(path: &Path) -> Option<String> {
    Some(note_entry(path, "agent")?.as_str()?.to_owned())
}

/// Returns the entry `name` in the note of the checkpoint at `path`. The note of a policy has no entry "agent".
fn note_entry(path: &Path, name: &str) -> Option<Value> {
    let bytes = storage::read(path, storage::MAX_LARGE_FILE).ok()?;
    Reader::new(&bytes).ok()?.note::<Value>().ok()?.get(name).cloned()
}

/// The part of the note that all versions have in common.
#[derive(Deserialize)]
struct Version {
    format: u32,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        learning::ddpg::trainer::{Trainer, tests::small_task},
        table::Table,
    };
    use std::fs;

    fn state() -> State {
        State { schedule: Schedule::new(10_000, 2_000), from: None, accumulator: Accumulator::default() }
    }

    /// A folder with two checkpoints, and the shots played at each.
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
    fn the_previous_checkpoint_replaces_a_missing_one() {
        let (folder, [before, last]) = folder_of_two();
        assert_eq!(shots_after_opening(folder.path()).unwrap(), (last, false));
        assert_eq!(shots_in(folder.path()), Some(last));
        fs::remove_file(folder.path().join(CURRENT)).unwrap();
        assert_eq!(shots_after_opening(folder.path()).unwrap(), (before, true));
        fs::remove_file(folder.path().join(PREVIOUS)).unwrap();
        assert!(matches!(shots_after_opening(folder.path()), Err(RunError::Missing(_))));
    }

    #[test]
    fn a_damaged_checkpoint_keeps_the_previous_one() {
        let (folder, [before, _]) = folder_of_two();
        fs::write(folder.path().join(CURRENT), b"damaged").unwrap();
        let (mut checkpoints, loaded) = Checkpoints::open(folder.path()).unwrap();
        checkpoints.write(b"the disk lies").unwrap();
        assert_eq!(loaded.learner.shots(), before);
        assert_eq!(shots_after_opening(folder.path()).unwrap(), (before, true));
    }

    #[test]
    fn contents_of_other_formats_are_refused_by_number() {
        let learner = Trainer::new(small_task(), Table::default()).unwrap();
        let mut bytes = bytes(&learner, &state()).unwrap();
        let format = br#"\"format\":2"#;
        let place = bytes.windows(format.len()).position(|window| window == format).unwrap();
        bytes[place + format.len() - 1] = b'9';
        assert!(write_checksum(CHECKPOINT_FIELD, &mut bytes));
        let message = restore(&bytes).unwrap_err().to_string();
        assert!(message.contains("format 9,") && message.contains("format 2"), "{message}");
    }

    #[test]
    fn means_since_the_last_line_survive_a_checkpoint() {
        let iteration = |reward| Iteration { mean_reward: reward, q_value: 0.1, critic_loss: 0.7, actor_loss: None };
        let mut accumulator = Accumulator::default();
        // The second iteration is longer. The first one made no update and must not count in the mean loss.
        let first = Iteration { q_value: 0.0, critic_loss: 0.0, ..iteration(0.1) };
        assert!(accumulator.add(&first, 1, 0) && accumulator.add(&iteration(0.3), 3, 2));
        let text = serde_json::to_string(&accumulator).unwrap();
        let mut again: Accumulator = serde_json::from_str(&text).unwrap();
        assert_eq!(again, accumulator);
        let means = again.take();
        assert!((means.mean_reward - 0.25).abs() < 1e-15, "{means:?}");
        assert_eq!((means.q_value, means.critic_loss, again.take()), (0.1, 0.7, Iteration::default()));
        assert!(!accumulator.add(&Iteration { critic_loss: f64::INFINITY, ..iteration(0.0) }, 1, 1));
        // The sums of an older version are ignored.
        let older = r#"{"turns":3,"mean_reward":0.5,"q_value":0.1,"critic_loss":0.2,"actor_loss":0.3}"#;
        assert_eq!(serde_json::from_str::<Accumulator>(older).unwrap(), Accumulator::default());
    }
}
