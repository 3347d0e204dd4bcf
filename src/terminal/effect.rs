//! Effects that pages request from the program around them, and the identifiers of the pages.

use std::path::PathBuf;

use crate::{
    learning::run::request::Request,
    terminal::{CalibrationTask, CoachJob, DrillTask, Launch, SavePolicyTask, SettingsTask},
};

/// An action that the program around the app has to carry out.
#[derive(Clone, Debug)]
pub enum Effect {
    /// Ask the coach for a shot, or for an analysis of the job's own shot; answers go to [`App::receive`](super::App::receive).
    AskCoach(Box<CoachJob>),
    /// Start a training process. Its end, and the answers to the next three, go to [`App::receive_training`](super::App::receive_training).
    Train(Box<Launch>),
    /// Send a request to a run.
    Send(Request, PathBuf),
    /// Save a policy under a name.
    SavePolicy(Box<SavePolicyTask>),
    /// Load the policy of the run in this folder.
    LoadPolicy(PathBuf),
    /// Run these tasks of the drills in order; reports go to [`App::receive_drill`](super::App::receive_drill).
    Drill(Vec<DrillTask>),
    /// Read or change the settings file; the report goes to [`App::receive_settings`](super::App::receive_settings).
    Settings(Box<SettingsTask>),
    /// Run these tasks of the calibration page; reports go to [`App::receive_calibration`](super::App::receive_calibration).
    Calibrate(Vec<CalibrationTask>),
    /// Copy a text to the terminal's clipboard, if the terminal allows it.
    Copy(String),
    /// Suspend the program until the shell continues it.
    Suspend,
    /// Quit.
    Quit,
}

impl Effect {
    /// Combines two effects. Drill tasks are concatenated; with other effects the second is dropped if there is a first.
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
    /// The table and the coach's recommendations.
    Coach,
    /// Exercises and the player's results.
    Drills,
    /// Training runs and their learning curves.
    Training,
    /// The settings.
    Settings,
    /// Measurements at a real table, and the parameters that follow from them.
    Calibration,
}

impl PageId {
    /// All pages, in the order of their tabs.
    pub const ALL: [Self; 5] = [Self::Coach, Self::Drills, Self::Training, Self::Settings, Self::Calibration];

    /// The title on the page's tab.
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
