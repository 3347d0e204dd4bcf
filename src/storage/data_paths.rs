//! The user's folders, following the conventions of the platform.

use std::{
    io,
    path::{Path, PathBuf},
};

use directories::ProjectDirs;

use super::Player;

/// Name of the settings file.
const SETTINGS: &str = "config.toml";

/// Folder of the players' own folders, inside the account's data folder.
const PLAYERS: &str = "players";

/// Paths of everything that the program writes.
#[derive(Clone, Debug)]
pub struct DataPaths {
    /// Training runs, one folder each.
    pub runs: PathBuf,
    /// Policies that the user has saved under a name.
    pub policies: PathBuf,
    /// Practice sessions, one file each.
    pub sessions: PathBuf,
    /// The user's own positions, one file each.
    pub positions: PathBuf,
    /// File of the user's own skill.
    pub player: PathBuf,
    /// Data entered for the calibration of a table.
    pub calibration: PathBuf,
    /// Data entered for a daily check.
    pub daily_check: PathBuf,
    /// The user's own tables, one file each.
    pub tables: PathBuf,
    /// State of the last session of the full-screen program.
    pub last_session: PathBuf,
    /// The partly typed calibration stroke at the time when the program ended.
    pub draft: PathBuf,
    /// Folder of the state that spectators may read while the player allows it.
    pub spectator_folder: PathBuf,
    /// The log file.
    pub log: PathBuf,
    /// Record of the notices that were already shown.
    pub notices: PathBuf,
    /// The settings file.
    pub settings: PathBuf,
    /// The folder that contains most of these paths.
    pub root: PathBuf,
}

impl DataPaths {
    /// Returns the paths of this account: in the platform's data directory, and in its state directory if the platform has one. If the user
    /// has no home directory, they are in the working directory.
    pub fn of_this_user() -> Self {
        let Some(dirs) = ProjectDirs::from("", "", "carom") else {
            let data = Path::new("./carom-data");
            return Self::in_folders(data, data, PathBuf::from("./carom-config.toml"));
        };
        let state = dirs.state_dir().unwrap_or_else(|| dirs.data_local_dir());
        Self::in_folders(dirs.data_dir(), state, dirs.config_dir().join(SETTINGS))
    }

    /// Returns the paths of a player of this account: the player's own folder inside the account's data, and the account's training runs
    /// for viewing.
    ///
    /// # Errors
    /// Fails if the account has no home directory.
    pub fn of_player(player: &Player) -> io::Result<Self> {
        let players = Self::players().ok_or_else(|| {
            io::Error::new(io::ErrorKind::NotFound, "this account has no home folder for players' files")
        })?;
        let account = Self::of_this_user();
        Ok(Self { runs: account.runs, ..Self::under(&players.join(player.folder())) })
    }

    /// Returns the folder that contains the players' folders; `None` if the account has no home directory.
    pub fn players() -> Option<PathBuf> {
        Some(ProjectDirs::from("", "", "carom")?.data_dir().join(PLAYERS))
    }

    /// Returns paths that are all inside `folder`.
    pub fn under(folder: &Path) -> Self {
        Self::in_folders(folder, folder, folder.join(SETTINGS))
    }

    /// Returns the files of the player's own tables, sorted by name.
    pub fn own_tables(&self) -> Vec<PathBuf> {
        let entries = std::fs::read_dir(&self.tables).into_iter().flatten().flatten().map(|entry| entry.path());
        let mut files: Vec<_> =
            entries.filter(|path| path.extension().is_some_and(|extension| extension == "toml")).collect();
        files.sort();
        files
    }

    /// Returns the file of the player's own table called `name` (with or without `.toml`), if it exists.
    pub fn own_table(&self, name: &str) -> Option<PathBuf> {
        self.own_tables().into_iter().find(|path| has_name(path, name))
    }

    fn in_folders(data: &Path, state: &Path, settings: PathBuf) -> Self {
        Self {
            runs: data.join("runs"),
            policies: data.join("policies"),
            sessions: data.join("sessions"),
            positions: data.join("positions"),
            player: data.join("player.json"),
            calibration: data.join("calibration.toml"),
            daily_check: data.join("calibration-daily.toml"),
            tables: data.join("tables"),
            last_session: state.join("last.json"),
            draft: state.join("draft.json"),
            spectator_folder: data.join("shown"),
            log: state.join("carom.log"),
            notices: state.join("notices"),
            settings,
            root: data.to_owned(),
        }
    }
}

/// Whether the file at `path` has this name, with or without its extension.
pub fn has_name(path: &Path, name: &str) -> bool {
    [path.file_stem(), path.file_name()].into_iter().flatten().any(|own| own == name)
}
