//! The weights that a run starts from: those of another run or of a policy.

use std::path::Path;

use serde_json::Value;

use super::{
    checkpoint::{self, Checkpoints, Loaded},
    config::Provenance,
    error::{RunError, file},
};
use crate::{
    learning::{
        Policy,
        checksum::{CHECKPOINT_FIELD, is_intact},
        learner::{AgentKind, Learner, settings_as_object},
        nn::weights::{Reader, WeightsError},
        policy::bundled_bytes,
    },
    storage,
    table::Table,
};

/// Weights to start from, with their provenance.
#[derive(Clone, Debug)]
pub struct Weights {
    pub start: Provenance,
    /// The settings of the agent with these weights.
    pub settings: Value,
    /// The agent's table; `None` for a policy, whose file contains only the table's name.
    pub table: Option<Table>,
    /// Warning if the weights are those of the previous checkpoint, because the current one is damaged.
    pub notice: Option<String>,
    /// The whole file.
    pub(super) bytes: Vec<u8>,
}

impl Weights {
    /// Loads the weights from a run's folder, a checkpoint or a policy file.
    pub fn load(path: &Path) -> Result<Self, RunError> {
        if path.is_dir() {
            return Ok(Self::of_checkpoint(path, Checkpoints::open(path)?.1));
        }
        let bytes = storage::read(path, storage::MAX_LARGE_FILE).map_err(file(path))?;
        // A file with a checkpoint's checksum, right or wrong, is treated as a checkpoint.
        if is_intact(CHECKPOINT_FIELD, &bytes).is_some() {
            return Ok(Self::of_checkpoint(path, checkpoint::load(path, bytes)?));
        }
        // Parses the same bytes, because a run may replace the file at any moment.
        Self::of_policy(path.display().to_string(), bytes)
    }

    /// Returns the weights of the bundled policy called `name`, if there is one.
    pub fn bundled(name: &str) -> Option<Result<Self, RunError>> {
        bundled_bytes(name).map(|bytes| Self::of_policy(name.to_owned(), bytes.to_vec()))
    }

    fn of_policy(path: String, bytes: Vec<u8>) -> Result<Self, RunError> {
        let policy = Policy::of_file(&bytes, &path)?;
        let origin = policy.origin();
        let start = Provenance {
            path,
            // The only agent with policy files.
            agent: "ddpg".to_owned(),
            table: origin.table.clone(),
            reward: origin.reward,
            seed: origin.seed,
            shots: origin.shots,
        };
        let settings = settings_as_object(&origin.hyperparameters);
        Ok(Self { start, settings, table: None, notice: None, bytes })
    }

    fn of_checkpoint(path: &Path, loaded: Loaded) -> Self {
        let notice = loaded.notice();
        let Loaded { learner, bytes, .. } = loaded;
        let plan = learner.plan();
        let start = Provenance {
            path: path.display().to_string(),
            agent: learner.agent().to_owned(),
            table: learner.table().name.clone(),
            reward: plan.reward,
            seed: plan.seed,
            shots: learner.shots(),
        };
        Self { start, settings: learner.settings(), table: Some(learner.table().clone()), notice, bytes }
    }

    /// Loads the weights into an untrained agent.
    ///
    /// # Errors
    /// [`RunError::Origin`] if the agents, the meaning of the networks' inputs and outputs, or the sizes differ.
    pub fn load_into(&self, learner: &mut dyn Learner) -> Result<(), RunError> {
        let refuse = |reason| RunError::Origin { path: self.start.path.clone(), reason };
        let (found, expected) = (&self.start.agent, learner.agent());
        if found != expected {
            return Err(refuse(format!(
                "they are of the agent {found}, and the run's agent is {expected}; leave out --agent, or choose other weights"
            )));
        }
        let own = learner.settings();
        for name in AgentKind::named(found)?.must_match {
            let [theirs, ours] = [&self.settings, &own].map(|settings| &settings[*name]);
            if theirs != ours {
                return Err(refuse(format!("they were trained with {name} = {theirs}, and the run has {ours}")));
            }
        }
        let loaded = Reader::new(&self.bytes).and_then(|weights| learner.load_weights(&weights));
        loaded.map_err(|error| match error {
            WeightsError::Shape { .. } => refuse(format!(
                "{error}; leave out the settings that give the networks other sizes, or start without --from"
            )),
            error => refuse(error.to_string()),
        })
    }
}
