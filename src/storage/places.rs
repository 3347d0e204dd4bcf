//! The folders of this user, as the platform wants them.

use std::{
    io,
    path::{Path, PathBuf},
};

use directories::ProjectDirs;

use super::Player;

/// What the file of the settings is called.
const SETTINGS: &str = "config.toml";

/// The folder of the players' own, among the account's data.
const PLAYERS: &str = "players";

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
    /// The stroke of a calibration that was typed in part when the program ended.
    pub draft: PathBuf,
    /// The folder of what others may see, while the player allows it.
    pub shown: PathBuf,
    /// What happened, line by line.
    pub log: PathBuf,
    /// Which notices have been given.
    pub notices: PathBuf,
    /// The file of the settings.
    pub settings: PathBuf,
    /// The folder of most of it.
    pub own: PathBuf,
}

impl Places {
    /// The folders under the platform's data directory, and those of its state directory where the platform has one; where
    /// the user has no home, under the working directory.
    pub fn of_this_user() -> Self {
        let Some(dirs) = ProjectDirs::from("", "", "carom") else {
            let data = Path::new("./carom-data");
            return Self::in_folders(data, data, PathBuf::from("./carom-config.toml"));
        };
        let state = dirs.state_dir().unwrap_or_else(|| dirs.data_local_dir());
        Self::in_folders(dirs.data_dir(), state, dirs.config_dir().join(SETTINGS))
    }

    /// Those of a player of this account: a folder for each among the account's data, and the account's own runs to look at.
    ///
    /// # Errors
    /// Where the account has no home.
    pub fn of_player(player: &Player) -> io::Result<Self> {
        let players = Self::players().ok_or_else(|| {
            io::Error::new(io::ErrorKind::NotFound, "this account has no home to keep players' files in")
        })?;
        let account = Self::of_this_user();
        Ok(Self { runs: account.runs, ..Self::under(&players.join(player.folder())) })
    }

    /// Where the players of this account have their folders; none where it has no home.
    pub fn players() -> Option<PathBuf> {
        Some(ProjectDirs::from("", "", "carom")?.data_dir().join(PLAYERS))
    }

    /// All of it in one folder.
    pub fn under(folder: &Path) -> Self {
        Self::in_folders(folder, folder, folder.join(SETTINGS))
    }

    /// The files of the player's own tables, in the order of their names.
    pub fn own_tables(&self) -> Vec<PathBuf> {
        let entries = std::fs::read_dir(&self.tables).into_iter().flatten().flatten().map(|entry| entry.path());
        let mut files: Vec<_> =
            entries.filter(|path| path.extension().is_some_and(|extension| extension == "toml")).collect();
        files.sort();
        files
    }

    /// The file of the player's own table that is called `name`, with or without `.toml`, if there is one.
    pub fn own_table(&self, name: &str) -> Option<PathBuf> {
        self.own_tables().into_iter().find(|path| is_called(path, name))
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
            last: state.join("last.json"),
            draft: state.join("draft.json"),
            shown: data.join("shown"),
            log: state.join("carom.log"),
            notices: state.join("notices"),
            settings,
            own: data.to_owned(),
        }
    }
}

/// Whether the file at `path` has this name, with or without its extension.
pub fn is_called(path: &Path, name: &str) -> bool {
    [path.file_stem(), path.file_name()].into_iter().flatten().any(|own| own == name)
}
