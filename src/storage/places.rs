//! The folders of this user, as the platform wants them.

use std::path::{Path, PathBuf};

use directories::ProjectDirs;

/// Where the program keeps what it writes.
#[derive(Clone, Debug)]
pub struct Places {
    /// Training runs, one folder each.
    pub runs: PathBuf,
    /// Policies that the user has kept under a name.
    pub policies: PathBuf,
    /// Sessions of practice, one file each.
    pub sessions: PathBuf,
    /// The user's own positions, one file each.
    pub positions: PathBuf,
    /// The file of the user's own skill.
    pub player: PathBuf,
    /// What was entered of the calibration of a table.
    pub calibration: PathBuf,
    /// What was entered of a check of the day.
    pub daily_check: PathBuf,
    /// Tables of the user's own, one file each.
    pub tables: PathBuf,
    /// What the last session of the screen left.
    pub last: PathBuf,
    /// What happened, line by line.
    pub log: PathBuf,
    /// Which notices have been given.
    pub notices: PathBuf,
}

impl Places {
    /// The folders under the platform's data directory, and those of its state directory where the platform has one; where
    /// the user has no home, under the working directory.
    pub fn of_this_user() -> Self {
        let [data, state] = ProjectDirs::from("", "", "carom").map_or_else(
            || [PathBuf::from("carom-data"), PathBuf::from("carom-data")],
            |dirs| [dirs.data_dir(), dirs.state_dir().unwrap_or_else(|| dirs.data_local_dir())].map(Path::to_owned),
        );
        Self::in_folders(&data, &state)
    }

    /// All of it in one folder.
    pub fn under(folder: &Path) -> Self {
        Self::in_folders(folder, folder)
    }

    fn in_folders(data: &Path, state: &Path) -> Self {
        Self {
            runs: data.join("runs"),
            policies: data.join("policies"),
            sessions: data.join("sessions"),
            positions: data.join("positions"),
            player: data.join("player.json"),
            calibration: data.join("calibration.toml"),
            daily_check: data.join("calibration-daily.toml"),
            tables: data.join("tables"),
            last: state.join("last.json"),
            log: state.join("carom.log"),
            notices: state.join("notices"),
        }
    }
}
