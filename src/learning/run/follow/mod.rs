//! Following a run from outside, by its files alone: while it is at work, after it has ended, and whatever befalls them.

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

/// What is known of a run.
#[derive(Clone, Debug, Default)]
pub struct Followed {
    /// Its folder.
    pub folder: PathBuf,
    /// What it is; unknown where its configuration cannot be read.
    pub config: Option<Config>,
    /// What it has reported.
    pub history: History,
    /// What it says of itself; nothing where it has not started, or an earlier carom trained it.
    pub status: Option<RunStatus>,
    /// How it is, as far as one can see from outside.
    pub condition: Condition,
    /// Its latest shots on held-out layouts.
    pub examples: Option<Examples>,
    /// Sentences on what is wrong with its files now.
    pub notices: Vec<String>,
}

/// What has changed since the last look. Whatever is `None` is as it was.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Update {
    /// Its configuration.
    pub config: Option<Box<Config>>,
    /// Whether the lines that have come are all that it has reported: they were read from the beginning (again).
    pub begins: bool,
    /// Lines that have come.
    pub records: Vec<Record>,
    /// What it says of itself.
    pub status: Option<RunStatus>,
    /// How it is.
    pub condition: Option<Condition>,
    /// Its latest shots.
    pub examples: Option<Examples>,
    /// All sentences on its files.
    pub notices: Option<Vec<String>>,
}

impl Followed {
    /// A run of which nothing is known yet.
    pub fn new(folder: &Path) -> Self {
        Self { folder: folder.to_owned(), ..Self::default() }
    }

    /// Shots played, as far as is known.
    pub fn shots(&self) -> u64 {
        let told = self.status.as_ref().map_or(0, |status| status.shots);
        self.history.last().map_or(told, |record| record.shots.max(told))
    }

    /// What it earned at its last measurement on held-out layouts.
    pub fn held_out(&self) -> Option<f64> {
        let told = self.status.as_ref().and_then(|status| status.held_out_reward);
        told.or_else(|| self.history.last_of(Quantity::HeldOut))
    }

    /// The most that it has earned on held-out layouts.
    pub fn best(&self) -> Option<f64> {
        self.history.best().into_iter().chain(self.held_out()).max_by(f64::total_cmp)
    }

    /// Time until all shots have been played, if it goes on as on average so far; none while it does not train.
    pub fn time_left(&self) -> Option<Duration> {
        let status = self.status.as_ref().filter(|_| !self.condition.is_over())?;
        let left = self.config.as_ref()?.plan.shots.saturating_sub(status.shots);
        Duration::try_from_secs_f64(left as f64 * status.seconds / status.shots as f64).ok()
    }

    /// How it is, in a sentence that says what to do.
    pub fn sentence(&self) -> String {
        let folder = self.folder.display();
        let shots = self.shots();
        let after = if shots > 0 { format!(" after {shots} shots") } else { String::new() };
        let go_on = format!("go on with: carom train --resume {}", shell_word(&self.folder.to_string_lossy()));
        match self.condition {
            Condition::Unknown => format!("looking at {folder}"),
            Condition::Missing => format!("{folder} holds no run yet"),
            Condition::Is(Phase::Failed) => {
                let reason = self.status.as_ref().and_then(|status| status.reason.as_deref());
                format!("the run has failed{after}: {}", reason.unwrap_or("no reason was given"))
            }
            Condition::Is(Phase::Stopped) => {
                // What is measured at a stop has no line of metrics, which must not depend on where a run was stopped.
                // A second signal leaves that of the measurement before.
                let status = self.status.as_ref().filter(|status| status.phase == Phase::Stopped);
                let reward = status.and_then(|status| status.held_out_reward);
                let reward = reward.map_or_else(String::new, |reward| format!(", held-out reward {reward:.4}"));
                format!("the run was stopped{after}{reward}; {go_on}")
            }
            Condition::Is(phase) => format!("the run is {}{after}", phase.name()),
            Condition::Stalled(time) => format!(
                "the run is stalled{after}: its process is there and has written nothing for {} s; it may have been \
                 suspended, or its disk may be slow",
                time.as_secs()
            ),
            Condition::Died => {
                format!("the run died{after}: its process is gone without a word, killed or with the machine; {go_on}")
            }
            Condition::Interrupted => format!("the run was stopped{after}; {go_on}"),
            Condition::Removed => format!("{folder} has been removed"),
        }
    }

    /// Takes what has changed.
    pub fn apply(&mut self, update: Update) {
        let Update { config, begins, records, status, condition, examples, notices } = update;
        if let Some(config) = config {
            self.config = Some(*config);
        }
        if begins {
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
