//! Groups of runs that differ only in their seed, and the spread of their rewards.

use std::{
    fmt::Write as _,
    path::{Path, PathBuf},
};

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::{
    METRICS, Run, RunError,
    config::{Provenance, Schedule},
    contains_run,
    error::file,
    json, metrics,
    origin::Weights,
};
use crate::{
    learning::learner::{AgentKind, Learner, TrainingPlan},
    statistics::mean_and_deviation,
    storage::{self, Lock, write_atomic},
    table::Table,
};

/// File name of the group's description, which marks a folder as a group.
const FILE: &str = "seeds.json";

/// File name of the spread in the group's folder.
const SPREAD: &str = "seeds.csv";

/// File name, in the group's folder, of the weights from which all its runs start.
const WEIGHTS: &str = "from.safetensors";

/// Specification of a training: agent, plan, settings, schedule and table.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TrainingSpec {
    pub agent: String,
    /// Reward, number of shots, and the first seed.
    #[serde(flatten)]
    pub plan: TrainingPlan,
    /// The agent's settings that differ from its defaults.
    pub settings: Value,
    pub schedule: Schedule,
    pub table: Table,
}

impl TrainingSpec {
    pub fn start(&self, folder: &Path, seed: u64, weights: Option<&Weights>) -> Result<Run, RunError> {
        let learner = self.untrained(seed, weights)?;
        Run::create(folder, learner, self.schedule, weights.map(|weights| weights.start.clone()))
    }

    /// Returns all settings of the agent, with the defaults for those that are not given.
    pub fn all_settings(&self) -> Result<Value, RunError> {
        Ok((AgentKind::named(&self.agent)?.settings)(&self.settings)?)
    }

    fn untrained(&self, seed: u64, weights: Option<&Weights>) -> Result<Box<dyn Learner>, RunError> {
        let agent = AgentKind::named(&self.agent)?;
        let mut learner = (agent.start)(TrainingPlan { seed, ..self.plan }, self.table.clone(), &self.settings)?;
        if let Some(weights) = weights {
            weights.load_into(learner.as_mut())?;
        }
        Ok(learner)
    }
}

/// The description of a group: number of seeds, origin of the weights, and what is trained.
#[derive(Debug, Serialize, Deserialize)]
pub struct GroupFile {
    pub seeds: u64,
    pub from: Option<Provenance>,
    #[serde(flatten)]
    pub spec: TrainingSpec,
}

/// Reads the description of the group in `folder`.
pub fn read_description(folder: &Path) -> Result<GroupFile, RunError> {
    let path = folder.join(FILE);
    json::read(&path, storage::MAX_SMALL_FILE).map_err(file(&path))
}

/// A group of runs that differ only in their seed, in subfolders of one folder.
#[derive(Debug)]
pub struct Group {
    folder: PathBuf,
    file: GroupFile,
    _lock: Lock,
}

impl Group {
    /// Creates a group with `seeds` seeds in `folder`, and the folder if it is missing.
    ///
    /// # Errors
    /// [`RunError::Occupied`] if the folder already contains runs, and the errors of [`TrainingSpec::start`].
    pub fn create(folder: &Path, spec: TrainingSpec, seeds: u64, weights: Option<&Weights>) -> Result<Self, RunError> {
        // Fails before anything is written if the specification is not valid.
        spec.untrained(spec.plan.seed, weights)?;
        super::make_folder(folder)?;
        let lock = super::lock(folder)?;
        // Accepts an existing weights file: the same command was killed after writing it and is repeated now.
        super::check_unoccupied(folder, weights.map(|_| WEIGHTS))?;
        if let Some(weights) = weights {
            let path = folder.join(WEIGHTS);
            write_atomic(&path, &weights.bytes).map_err(file(&path))?;
        }
        let file = GroupFile { seeds, from: weights.map(|weights| weights.start.clone()), spec };
        json::write(&folder.join(FILE), &file)?;
        Ok(Self { folder: folder.to_owned(), file, _lock: lock })
    }

    /// Resumes the group in `folder`.
    pub fn resume(folder: &Path) -> Result<Self, RunError> {
        Ok(Self { folder: folder.to_owned(), file: read_description(folder)?, _lock: super::lock(folder)? })
    }

    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Returns the seeds, in order.
    pub fn seeds(&self) -> impl Iterator<Item = u64> {
        let first = self.file.spec.plan.seed;
        (0..self.file.seeds).map(move |index| first.wrapping_add(index))
    }

    /// Creates the run with this seed, or resumes it if it exists, with the warnings of [`Run::resume`].
    pub fn run(&self, seed: u64) -> Result<(Run, Vec<String>), RunError> {
        let folder = self.member(seed);
        if contains_run(&folder) {
            return Run::resume(&folder);
        }
        // Loads the weights only for a new run; a resumed one does not need them.
        let mut weights = None;
        if let Some(start) = &self.file.from {
            // Restores the provenance from when the weights were copied.
            weights.insert(Weights::load(&self.folder.join(WEIGHTS))?).start = start.clone();
        }
        Ok((self.file.spec.start(&folder, seed, weights.as_ref())?, Vec::new()))
    }

    fn member(&self, seed: u64) -> PathBuf {
        self.folder.join(format!("seed-{seed}"))
    }

    /// Writes the spread between the seeds at every evaluation as CSV and returns its last line, if there is one.
    pub fn write_spread(&self) -> Result<Option<Spread>, RunError> {
        let mut rewards = std::collections::BTreeMap::<u64, Vec<f64>>::new();
        for seed in self.seeds() {
            let path = self.member(seed).join(METRICS);
            for line in metrics::read(&path).map_err(file(&path))? {
                if let Some(reward) = line.held_out_reward {
                    rewards.entry(line.shots).or_default().push(reward);
                }
            }
        }
        let mut last = None;
        let mut text = "shots,seeds,mean,sd,min,max\n".to_owned();
        for (shots, rewards) in rewards {
            let spread = Spread::of(shots, &rewards);
            let Spread { seeds, mean, sd, min, max, .. } = spread;
            let sd = sd.map(|sd| sd.to_string()).unwrap_or_default();
            // Writing to a string cannot fail.
            let _ = writeln!(text, "{shots},{seeds},{mean},{sd},{min},{max}");
            last = Some(spread);
        }
        let path = self.folder.join(SPREAD);
        write_atomic(&path, text.as_bytes()).map_err(file(&path))?;
        Ok(last)
    }
}

/// Whether `folder` contains a group of runs.
pub fn is_group(folder: &Path) -> bool {
    folder.join(FILE).exists()
}

/// Statistics of the mean rewards on held-out layouts of several seeds after the same number of shots.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread {
    pub shots: u64,
    /// Number of seeds that have reached these shots.
    pub seeds: usize,
    pub mean: f64,
    /// Sample standard deviation; `None` for a single seed.
    pub sd: Option<f64>,
    pub min: f64,
    pub max: f64,
}

impl Spread {
    fn of(shots: u64, rewards: &[f64]) -> Self {
        let min = rewards.iter().copied().fold(f64::INFINITY, f64::min);
        let max = rewards.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let (mean, sd) = mean_and_deviation(rewards);
        Self { shots, seeds: rewards.len(), mean, sd, min, max }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_spread_uses_the_sample_formula() {
        let spread = Spread::of(10, &[0.1, 0.2, 0.6]);
        assert!((spread.mean - 0.3).abs() < 1e-15 && (spread.sd.unwrap() - 0.07f64.sqrt()).abs() < 1e-15);
        assert_eq!((spread.seeds, spread.min, spread.max), (3, 0.1, 0.6));
        assert_eq!(Spread::of(10, &[0.5]).sd, None);
    }
}
