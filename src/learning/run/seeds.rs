//! The same run with several seeds, and the spread between them.

use std::{
    fmt::Write as _,
    path::{Path, PathBuf},
};

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::{
    METRICS, Run, RunError,
    config::{Provenance, Schedule},
    error::file,
    holds_checkpoints, json, metrics,
    origin::Weights,
};
use crate::{
    learning::learner::{AgentKind, Learner, TrainingPlan},
    statistics::mean_and_deviation,
    storage::{self, Lock, write_atomic},
    table::Table,
};

/// The file that makes a folder a group.
const FILE: &str = "seeds.json";

/// The spread, in the group's folder.
const SPREAD: &str = "seeds.csv";

/// The weights that all runs of the group start from, in the group's folder.
const WEIGHTS: &str = "from.safetensors";

/// What to train.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TrainingSpec {
    pub agent: String,
    /// Reward, number of shots, and the first seed.
    #[serde(flatten)]
    pub plan: TrainingPlan,
    /// The agent's settings, as far as they differ from its defaults.
    pub settings: Value,
    pub schedule: Schedule,
    pub table: Table,
}

impl TrainingSpec {
    pub fn start(&self, folder: &Path, seed: u64, weights: Option<&Weights>) -> Result<Run, RunError> {
        let learner = self.untrained(seed, weights)?;
        Run::create(folder, learner, self.schedule, weights.map(|weights| weights.start.clone()))
    }

    /// All settings of the agent, with the defaults of those that are not given.
    pub fn all_settings(&self) -> Result<Value, RunError> {
        Ok((AgentKind::named(&self.agent)?.settings)(&self.settings)?)
    }

    fn untrained(&self, seed: u64, weights: Option<&Weights>) -> Result<Box<dyn Learner>, RunError> {
        let agent = AgentKind::named(&self.agent)?;
        let mut learner = (agent.start)(TrainingPlan { seed, ..self.plan }, self.table.clone(), &self.settings)?;
        if let Some(weights) = weights {
            weights.give_to(learner.as_mut())?;
        }
        Ok(learner)
    }
}

/// What a group trains, with how many seeds, and from whose weights.
#[derive(Debug, Serialize, Deserialize)]
pub struct GroupFile {
    pub seeds: u64,
    pub from: Option<Provenance>,
    #[serde(flatten)]
    pub spec: TrainingSpec,
}

/// What the group in `folder` was started with.
pub fn described(folder: &Path) -> Result<GroupFile, RunError> {
    let path = folder.join(FILE);
    json::read(&path, storage::SMALL).map_err(file(&path))
}

/// Runs that differ in their seed alone, in folders of one folder.
#[derive(Debug)]
pub struct Group {
    folder: PathBuf,
    file: GroupFile,
    _lock: Lock,
}

impl Group {
    /// A new group with `seeds` seeds in `folder`, which is made where it is missing.
    ///
    /// # Errors
    /// [`RunError::Occupied`] where it holds runs already, and whatever [`TrainingSpec::start`] would refuse.
    pub fn create(folder: &Path, spec: TrainingSpec, seeds: u64, weights: Option<&Weights>) -> Result<Self, RunError> {
        // What is refused is refused before anything is written.
        spec.untrained(spec.plan.seed, weights)?;
        super::make_folder(folder)?;
        let lock = super::lock(folder)?;
        // Killed before the next file was written, the same command writes this one again.
        super::refuse_taken(folder, weights.map(|_| WEIGHTS))?;
        if let Some(weights) = weights {
            weights.write(&folder.join(WEIGHTS))?;
        }
        let file = GroupFile { seeds, from: weights.map(|weights| weights.start.clone()), spec };
        json::write(&folder.join(FILE), &file)?;
        Ok(Self { folder: folder.to_owned(), file, _lock: lock })
    }

    /// The group in `folder`.
    pub fn resume(folder: &Path) -> Result<Self, RunError> {
        Ok(Self { folder: folder.to_owned(), file: described(folder)?, _lock: super::lock(folder)? })
    }

    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// The seeds, in order.
    pub fn seeds(&self) -> impl Iterator<Item = u64> {
        let first = self.file.spec.plan.seed;
        (0..self.file.seeds).map(move |index| first.wrapping_add(index))
    }

    /// The run with this seed: a new one, or the one that is there as it was left, with what [`Run::resume`]
    /// has to say.
    pub fn run(&self, seed: u64) -> Result<(Run, Vec<String>), RunError> {
        let folder = self.member(seed);
        if holds_checkpoints(&folder) {
            return Run::resume(&folder);
        }
        // Seeds that have begun need the weights no more.
        let mut weights = None;
        if let Some(start) = &self.file.from {
            // Under what was known of them when the file was copied.
            weights.insert(Weights::load(&self.folder.join(WEIGHTS))?).start = start.clone();
        }
        Ok((self.file.spec.start(&folder, seed, weights.as_ref())?, Vec::new()))
    }

    fn member(&self, seed: u64) -> PathBuf {
        self.folder.join(format!("seed-{seed}"))
    }

    /// Writes the spread between the seeds at every measurement as CSV and returns its last line, if there is one.
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

/// Whether `folder` holds runs with several seeds.
pub fn is_group(folder: &Path) -> bool {
    folder.join(FILE).exists()
}

/// The mean rewards on held-out layouts that several seeds had after as many shots.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Spread {
    pub shots: u64,
    /// Seeds that have come so far.
    pub seeds: usize,
    pub mean: f64,
    /// Their sample standard deviation; one alone has none.
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
    fn the_spread_is_that_of_a_sample() {
        let spread = Spread::of(10, &[0.1, 0.2, 0.6]);
        assert!((spread.mean - 0.3).abs() < 1e-15 && (spread.sd.unwrap() - 0.07f64.sqrt()).abs() < 1e-15);
        assert_eq!((spread.seeds, spread.min, spread.max), (3, 0.1, 0.6));
        assert_eq!(Spread::of(10, &[0.5]).sd, None);
    }
}
