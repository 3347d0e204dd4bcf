//! What is in a checkpoint: the learner, the run's own state, and a checksum of it all.

use std::path::Path;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::{
    config::{Provenance, Schedule},
    error::{DamageReason, FORMAT},
};
use crate::{
    learning::{
        checksum::{NO_CHECKSUM, OF_CHECKPOINT, is_whole, write_checksum},
        learner::{AgentKind, Iteration, Learner},
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
    pub schedule: Schedule,
    pub from: Option<Provenance>,
    /// What it has to report next.
    #[serde(rename = "tally")]
    pub accumulator: Accumulator,
}

/// Sums over shots and updates. They are part of a checkpoint: a line's means must not depend on where a run was interrupted. Those of
/// older versions, which summed iterations of unlike length, are not read.
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
    /// Adds an iteration of so many shots and updates. `false` where it has numbers that are not finite.
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

    /// The means over the shots and the updates added since the last call.
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

/// The bytes of a checkpoint.
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
    if write_checksum(OF_CHECKPOINT, &mut bytes) { Ok(bytes) } else { Err(WeightsError::Foreign) }
}

/// The learner and the run's state in a checkpoint's bytes.
pub fn restore(bytes: &[u8]) -> Result<(Box<dyn Learner>, State), DamageReason> {
    match is_whole(OF_CHECKPOINT, bytes) {
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

/// The agent whose run wrote the checkpoint at `path`; `None` where that is no checkpoint, or cannot be read.
pub fn agent_of_checkpoint(path: &Path) -> Option<String> {
    Some(told(path, "agent")?.as_str()?.to_owned())
}

/// Shots that the checkpoint at `path` has played; `None` where that cannot be read.
pub fn shots_in(path: &Path) -> Option<u64> {
    told(path, "shots")?.as_u64()
}

/// What the note of the checkpoint at `path` says under `name`; that of a policy names no agent.
fn told(path: &Path, name: &str) -> Option<Value> {
    let bytes = storage::read(path, storage::LARGE).ok()?;
    Reader::new(&bytes).ok()?.note::<Value>().ok()?.get(name).cloned()
}

/// The part of a note that every version has.
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
        assert!(write_checksum(OF_CHECKPOINT, &mut bytes));
        let message = restore(&bytes).unwrap_err().to_string();
        assert!(message.contains("format 99") && message.contains("format 2"), "{message}");
    }

    #[test]
    fn means_are_over_the_shots_and_updates_since_the_last_and_survive_a_file() {
        let iteration = |reward| Iteration { mean_reward: reward, q_value: 0.1, critic_loss: 0.7, actor_loss: None };
        let mut accumulator = Accumulator::default();
        // The second iteration is longer, and the first one, which made no update, says nothing of the loss.
        let first = Iteration { q_value: 0.0, critic_loss: 0.0, ..iteration(0.1) };
        assert!(accumulator.add(&first, 1, 0) && accumulator.add(&iteration(0.3), 3, 2));
        let text = serde_json::to_string(&accumulator).unwrap();
        let mut again: Accumulator = serde_json::from_str(&text).unwrap();
        assert_eq!(again, accumulator);
        let means = again.take();
        assert!((means.mean_reward - 0.25).abs() < 1e-15, "{means:?}");
        assert_eq!((means.q_value, means.critic_loss, again.take()), (0.1, 0.7, Iteration::default()));
        assert!(!accumulator.add(&Iteration { critic_loss: f64::INFINITY, ..iteration(0.0) }, 1, 1));
        // What an older version had summed is left out.
        let older = r#"{"turns":3,"mean_reward":0.5,"q_value":0.1,"critic_loss":0.2,"actor_loss":0.3}"#;
        assert_eq!(serde_json::from_str::<Accumulator>(older).unwrap(), Accumulator::default());
    }
}
