//! A run that is watched, perhaps beside another one.

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

/// What a run is called among those in the folder `runs`.
pub fn name_in(runs: &Path, run: &Path) -> String {
    run.strip_prefix(runs).unwrap_or(run).display().to_string()
}

/// A run and its name.
#[derive(Debug)]
pub struct Named {
    /// How the command line calls it.
    pub name: String,
    /// What is known of it.
    pub run: Followed,
}

impl Named {
    /// The run in `folder`, of which nothing is known yet. Runs in `runs` are called by what follows.
    pub fn new(folder: &Path, runs: &Path) -> Self {
        Self { name: name_in(runs, folder), run: Followed::new(folder) }
    }

    /// Whether what its shots earn is a success or none; that is not known before its reward is.
    pub fn is_share(&self) -> bool {
        self.run.config.as_ref().is_some_and(|config| config.plan.reward.rule().is_some())
    }
}

/// A run that is watched.
#[derive(Debug)]
pub struct Watch {
    /// The run.
    pub own: Named,
    /// The run that it is compared with.
    pub other: Option<Named>,
    /// Which charts are shown, and how.
    pub charts: Charts,
    /// Its latest shots.
    pub replay: Replay,
    /// Whether it has left a policy that the coach can use.
    pub has_policy: bool,
    /// Why the process failed that was to train it, where one did.
    pub failure: Option<String>,
}

impl Watch {
    /// The run in `folder`, of which nothing is known yet. Runs in `runs` are called by what follows.
    pub fn new(folder: &Path, runs: &Path) -> Self {
        let (charts, replay) = (Charts::default(), Replay::default());
        Self { own: Named::new(folder, runs), other: None, charts, replay, has_policy: false, failure: None }
    }

    /// Where it is.
    pub fn folder(&self) -> &Path {
        &self.own.run.folder
    }

    /// How it is.
    pub const fn condition(&self) -> Condition {
        self.own.run.condition
    }

    /// Whether there is anything in its folder.
    pub const fn is_known(&self) -> bool {
        !matches!(self.condition(), Condition::Unknown | Condition::Missing)
    }

    /// Whether it is there and its configuration cannot be read.
    pub const fn lacks_config(&self) -> bool {
        self.is_known() && self.own.run.config.is_none()
    }

    /// Shots planned, where that is known.
    pub fn planned(&self) -> Option<u64> {
        self.own.run.config.as_ref().map(|config| config.plan.shots)
    }

    /// What it is rewarded for, where that is known.
    pub fn reward(&self) -> Option<Reward> {
        self.own.run.config.as_ref().map(|config| config.plan.reward)
    }

    /// Its table, where that is known.
    pub fn table(&self) -> Option<&Table> {
        self.own.run.config.as_ref().map(|config| &config.table)
    }

    /// How far it is, or the run that it is compared with: charts show both.
    pub fn progress(&self) -> Progress {
        let runs = [Some(&self.own.run), self.other.as_ref().map(|other| &other.run)].into_iter().flatten();
        // The last iteration of the run may end a few shots beyond the plan.
        let planned = self.planned().map(|planned| planned.max(self.own.run.shots()));
        Progress { shots: runs.map(Followed::shots).max().unwrap_or(0), planned }
    }

    /// Whether a process works on it.
    pub const fn is_at_work(&self) -> bool {
        self.condition().is_at_work()
    }

    /// Whether it is paused until a request to go on.
    pub fn is_paused(&self) -> bool {
        self.condition() == Condition::InPhase(Phase::Paused)
    }

    /// Why one cannot go on with it; `None` where one can.
    pub const fn refusal_to_go_on(&self) -> Option<&'static str> {
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

    /// What stands in the way of the run, or what can be done now, in a sentence; and whether that is bad news.
    pub fn advice(&self) -> (String, bool) {
        let Self { own: Named { name, run }, .. } = self;
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
