//! Follows a run from outside by its files alone: during training, after its end, and even if files are damaged or removed.

mod condition;
mod follower;
mod stamp;
mod tail;

use std::{
    path::{Path, PathBuf},
    time::Duration,
};

pub use self::{condition::Condition, follower::Follower};
use super::{
    config::Config,
    examples::Examples,
    history::History,
    metrics::Record,
    quantity::Quantity,
    status::{Phase, RunStatus},
};
use crate::printing::shell_word;

/// The known state of a followed run.
#[derive(Clone, Debug, Default)]
pub struct Followed {
    /// The run's folder.
    pub folder: PathBuf,
    /// The configuration; `None` if it cannot be read.
    pub config: Option<Config>,
    /// The metrics.
    pub history: History,
    /// The run's own status; `None` if the run has not started or was trained by an early version.
    pub status: Option<RunStatus>,
    /// The condition as seen from outside.
    pub condition: Condition,
    /// The latest example shots on held-out layouts.
    pub examples: Option<Examples>,
    /// Sentences about current problems with its files.
    pub notices: Vec<String>,
}

/// Changes of a run since the last look. A field that is `None` has not changed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Update {
    /// The configuration.
    pub config: Option<Box<Config>>,
    /// Whether `records` are all lines of the run, because the file was read from its beginning (again).
    pub replaces_records: bool,
    /// New lines of metrics.
    pub records: Vec<Record>,
    /// The run's own status.
    pub status: Option<RunStatus>,
    /// The condition as seen from outside.
    pub condition: Option<Condition>,
    /// The latest example shots.
    pub examples: Option<Examples>,
    /// All sentences about problems with its files.
    pub notices: Option<Vec<String>>,
}

impl Followed {
    /// Creates the state of a run of which nothing is known yet.
    pub fn new(folder: &Path) -> Self {
        Self { folder: folder.to_owned(), ..Self::default() }
    }

    /// Returns the shots played, as far as is known.
    pub fn shots(&self) -> u64 {
        let in_status = self.status.as_ref().map_or(0, |status| status.shots);
        self.history.last().map_or(in_status, |record| record.shots.max(in_status))
    }

    /// Returns the mean reward of the last evaluation on held-out layouts.
    pub fn held_out(&self) -> Option<f64> {
        let in_status = self.status.as_ref().and_then(|status| status.held_out_reward);
        in_status.or_else(|| self.history.last_of(Quantity::HeldOut))
    }

    /// Returns the highest mean reward on held-out layouts so far.
    pub fn best(&self) -> Option<f64> {
        self.history.best().into_iter().chain(self.held_out()).max_by(f64::total_cmp)
    }

    /// Estimates the time until all shots are played, from the mean speed so far; `None` if the run is over or has played no shot.
    pub fn time_left(&self) -> Option<Duration> {
        let status = self.status.as_ref().filter(|_| !self.condition.is_over())?;
        let left = self.config.as_ref()?.plan.shots.saturating_sub(status.shots);
        Duration::try_from_secs_f64(left as f64 * status.seconds / status.shots as f64).ok()
    }

    /// Describes the condition in a sentence that also states what to do.
    pub fn sentence(&self) -> String {
        let folder = self.folder.display();
        let shots = self.shots();
        let after = if shots > 0 { format!(" after {shots} shots") } else { String::new() };
        let go_on = format!("resume with: carom train --resume {}", shell_word(&self.folder.to_string_lossy()));
        match self.condition {
            Condition::Unknown => format!("looking at {folder}"),
            Condition::Missing => format!("{folder} contains no run yet"),
            Condition::InPhase(Phase::Failed) => {
                let reason = self.status.as_ref().and_then(|status| status.reason.as_deref());
                format!("the run has failed{after}: {}", reason.unwrap_or("no reason was given"))
            }
            Condition::InPhase(Phase::Stopped) => {
                // The evaluation at a stop has no line of metrics, because the lines must not depend on where a run was stopped.
                // After a second signal, the status contains the reward of the evaluation before.
                let status = self.status.as_ref().filter(|status| status.phase == Phase::Stopped);
                let reward = status.and_then(|status| status.held_out_reward);
                let reward = reward.map_or_else(String::new, |reward| format!(", held-out reward {reward:.4}"));
                format!("the run was stopped{after}{reward}; {go_on}")
            }
            Condition::InPhase(phase) => format!("the run is {}{after}", phase.name()),
            Condition::Stalled(time) => format!(
                "the run is stalled{after}: its process exists but has written nothing for {} s; it may have been \
                 suspended, or its disk may be slow",
                time.as_secs()
            ),
            Condition::Died => {
                format!("the run died{after}: its process was killed, or the machine stopped; {go_on}")
            }
            Condition::Interrupted => format!("the run was stopped{after}; {go_on}"),
            Condition::Removed => format!("{folder} has been removed"),
        }
    }

    /// Applies an update.
    pub fn apply(&mut self, update: Update) {
        let Update { config, replaces_records, records, status, condition, examples, notices } = update;
        if let Some(config) = config {
            self.config = Some(*config);
        }
        if replaces_records {
            self.history = History::default();
        }
        for record in &records {
            self.history.push(record);
        }
        self.status = status.or(self.status.take());
        self.condition = condition.unwrap_or(self.condition);
        self.examples = examples.or(self.examples.take());
        self.notices = notices.unwrap_or(std::mem::take(&mut self.notices));
    }
}
