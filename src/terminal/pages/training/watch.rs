//! State of a watched training run, with a second run if they are compared.

use std::path::Path;

use crate::{
    game::Reward,
    learning::run::{
        follow::{Condition, Followed},
        status::Phase,
    },
    printing::shell_word,
    table::Table,
    terminal::pages::training::{
        charts::{Charts, Progress},
        replay::Replay,
    },
};

/// The name of a run: its path relative to the folder `runs`, if it is in there.
pub fn name_in(runs: &Path, run: &Path) -> String {
    run.strip_prefix(runs).unwrap_or(run).display().to_string()
}

/// A run and its name.
#[derive(Debug)]
pub struct NamedRun {
    /// The name of the run on the command line.
    pub name: String,
    /// The followed run.
    pub run: Followed,
    /// Number of this opening: a run that is opened again is read from its beginning.
    pub opening: u64,
}

impl NamedRun {
    /// Creates the entry of the run in `folder`, which has not been read yet. `runs` is the folder to which names are relative.
    pub fn new(folder: &Path, runs: &Path, opening: u64) -> Self {
        Self { name: name_in(runs, folder), run: Followed::new(folder), opening }
    }

    /// Whether its reward is success or failure, so that a mean is a success rate. `false` if its reward is not known yet.
    pub fn is_success_rate(&self) -> bool {
        self.run.config.as_ref().is_some_and(|config| config.plan.reward.rule().is_some())
    }
}

/// A watched run.
#[derive(Debug)]
pub struct Watch {
    /// The run.
    pub own: NamedRun,
    /// The run to compare with.
    pub other: Option<NamedRun>,
    /// The state of its charts.
    pub charts: Charts,
    /// The replay of its latest shots.
    pub replay: Replay,
    /// Whether the run has saved a policy that the coach can use.
    pub has_policy: bool,
    /// The reason why its training process failed, if it did.
    pub failure: Option<String>,
}

impl Watch {
    /// Creates the state for the run in `folder`, which has not been read yet. `runs` is the folder to which names are relative.
    pub fn new(folder: &Path, runs: &Path, opening: u64) -> Self {
        Self {
            own: NamedRun::new(folder, runs, opening),
            other: None,
            charts: Charts::default(),
            replay: Replay::default(),
            has_policy: false,
            failure: None,
        }
    }

    /// The folder of the run.
    pub fn folder(&self) -> &Path {
        &self.own.run.folder
    }

    /// The condition of the run.
    pub const fn condition(&self) -> Condition {
        self.own.run.condition
    }

    /// Whether the run is known to exist.
    pub const fn is_known(&self) -> bool {
        !matches!(self.condition(), Condition::Unknown | Condition::Missing)
    }

    /// Whether the run exists but its configuration cannot be read.
    pub const fn lacks_config(&self) -> bool {
        self.is_known() && self.own.run.config.is_none()
    }

    /// Planned shots, if known.
    pub fn planned_shots(&self) -> Option<u64> {
        self.own.run.config.as_ref().map(|config| config.plan.shots)
    }

    /// The reward function, if known.
    pub fn reward(&self) -> Option<Reward> {
        self.own.run.config.as_ref().map(|config| config.plan.reward)
    }

    /// The table, if known.
    pub fn table(&self) -> Option<&Table> {
        self.own.run.config.as_ref().map(|config| &config.table)
    }

    /// The progress of the run, or of the one to compare with if that has more shots: the charts show both.
    pub fn progress(&self) -> Progress {
        let runs = [Some(&self.own.run), self.other.as_ref().map(|other| &other.run)].into_iter().flatten();
        // The last iteration of a run may exceed the plan by a few shots.
        let planned = self.planned_shots().map(|planned| planned.max(self.own.run.shots()));
        Progress { shots: runs.map(Followed::shots).max().unwrap_or(0), planned }
    }

    /// Whether a process is training the run.
    pub const fn is_active(&self) -> bool {
        self.condition().is_at_work()
    }

    /// Whether the run is paused until a request to continue.
    pub fn is_paused(&self) -> bool {
        self.condition() == Condition::InPhase(Phase::Paused)
    }

    /// The reason why the run cannot be resumed; `None` if it can.
    pub const fn resume_refusal(&self) -> Option<&'static str> {
        match self.condition() {
            Condition::InPhase(Phase::Stopped | Phase::Failed) | Condition::Died | Condition::Interrupted => None,
            Condition::InPhase(Phase::Finished) => {
                Some("the run is finished; n in the list starts a new one with its networks")
            }
            Condition::InPhase(Phase::Paused) => Some("the run is paused; p lets it go on"),
            Condition::InPhase(_) | Condition::Stalled(_) => Some("the run is training"),
            Condition::Unknown | Condition::Missing => Some("there is no run yet"),
            Condition::Removed => Some("the run has been removed"),
        }
    }

    /// A sentence on the run's problem or on the possible next steps, and whether it is a problem.
    pub fn advice(&self) -> (String, bool) {
        let Self { own: NamedRun { name, run, .. }, .. } = self;
        let resume = format!("r goes on with it, or: carom train --resume {}", shell_word(name));
        let status = run.status.as_ref();
        let reason = status.and_then(|status| status.reason.as_deref());
        let warning = status.and_then(|status| status.warning.as_deref());
        match run.condition {
            Condition::InPhase(Phase::Failed) => {
                (format!("{}; {resume}", reason.unwrap_or("the training has broken down")), true)
            }
            Condition::Died => (format!("the training process ended without a message; {resume}"), true),
            Condition::Stalled(since) => {
                let seconds = since.as_secs();
                (format!("no news for {seconds} s; the process is still there and may be suspended"), true)
            }
            Condition::Removed => ("the folder of the run has been removed; Esc goes back".to_owned(), true),
            _ if !run.notices.is_empty() => (run.notices.join("; "), true),
            Condition::InPhase(Phase::Stopped) | Condition::Interrupted => {
                (format!("stopped before its end; {resume}"), false)
            }
            _ if warning.is_some() => (warning.unwrap_or_default().to_owned(), true),
            Condition::Unknown => ("looking for the run".to_owned(), false),
            Condition::Missing => match &self.failure {
                Some(sentence) => (format!("it could not be started: {sentence}"), true),
                None => ("waiting for the run to start".to_owned(), false),
            },
            Condition::InPhase(Phase::Paused) => ("paused and saved; p lets it go on".to_owned(), false),
            Condition::InPhase(Phase::Measuring) => ("plays the held-out layouts".to_owned(), false),
            Condition::InPhase(Phase::Stopping) => ("saved; it plays the held-out layouts and ends".to_owned(), false),
            Condition::InPhase(Phase::Training) => {
                (format!("it goes on without this screen: carom watch {}", shell_word(name)), false)
            }
            Condition::InPhase(Phase::Finished) if !self.has_policy => {
                ("finished; it has left no networks for the coach".to_owned(), false)
            }
            Condition::InPhase(Phase::Finished) => {
                ("finished; w uses these networks in the coach, k keeps them under a name".to_owned(), false)
            }
        }
    }
}
