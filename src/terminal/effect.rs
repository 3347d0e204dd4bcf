//! What pages ask of the program around them, and the names of the pages.

use std::path::PathBuf;

use crate::{
    learning::run::request::Request,
    terminal::{CalibrationTask, CoachJob, DrillTask, Keeping, Launch, SettingsTask},
};

/// What the program around the app has to do.
#[derive(Clone, Debug)]
pub enum Effect {
    /// Ask the coach for a shot, or for a closer look at the job's own; the answers go to [`App::receive`](super::App::receive).
    Ask(Box<CoachJob>),
    /// Start a process that trains; how it ends goes to [`App::receive_training`](super::App::receive_training), as do the answers to what follows.
    Train(Box<Launch>),
    /// Ask a run for something.
    Send(Request, PathBuf),
    /// Keep a policy under a name.
    Keep(Box<Keeping>),
    /// Read the policy of the run in this folder.
    LoadPolicy(PathBuf),
    /// Do these, one after the other; what comes of them goes to [`App::receive_drill`](super::App::receive_drill).
    Drill(Vec<DrillTask>),
    /// Read or change the settings' file; what comes of it goes to [`App::receive_settings`](super::App::receive_settings).
    Settings(Box<SettingsTask>),
    /// Do these of the calibration's page; what comes of them goes to [`App::receive_calibration`](super::App::receive_calibration).
    Calibrate(Vec<CalibrationTask>),
    /// Put a text into the terminal's clipboard, where it allows that.
    Copy(String),
    /// Stop until the shell continues the program.
    Suspend,
    /// End.
    Quit,
}

impl Effect {
    /// Both, where both may be there; tasks of the drills are done one after the other, and of others the second is left out.
    pub fn both(first: Option<Self>, second: Option<Self>) -> Option<Self> {
        match (first, second) {
            (Some(Self::Drill(first)), Some(Self::Drill(second))) => Some(Self::Drill([first, second].concat())),
            (first, second) => first.or(second),
        }
    }
}

/// The screens.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PageId {
    /// The table, and what the coach recommends.
    Coach,
    /// Exercises, and the player at them.
    Drills,
    /// Runs, and how they learn.
    Training,
    /// What is set once and for all.
    Settings,
    /// What is measured at a table, and what follows from it.
    Calibration,
}

impl PageId {
    /// All of them, in the order of their tabs.
    pub const ALL: [Self; 5] = [Self::Coach, Self::Drills, Self::Training, Self::Settings, Self::Calibration];

    /// What stands on its tab.
    pub const fn title(self) -> &'static str {
        match self {
            Self::Coach => "Coach",
            Self::Drills => "Drills",
            Self::Training => "Training",
            Self::Settings => "Settings",
            Self::Calibration => "Calibration",
        }
    }
}
