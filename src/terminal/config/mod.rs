//! The user's settings: a TOML file in which every key is optional.

mod change;
pub mod draft;
mod entries;
mod file;
mod read;
pub mod saved_session;

use std::{
    fmt::Write,
    io,
    path::{Path, PathBuf},
};

use crate::{
    coach::{Doubt, Skill, Units},
    game::Rule,
    printing::parse_number,
    storage::{self, DataPaths},
    table::{PRESETS, Table},
    terminal::{Depth, Glyphs, Keys, ThemeName, keymap::remap},
};

pub use change::Change;
pub use entries::{ENTRIES, Entry, quoted};
pub use file::{SettingsFile, SettingsReport, SettingsTask};
pub use read::Mistake;

/// The settings of the program.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Colour theme.
    pub theme: ThemeName,
    /// Number of colours of the terminal; `None` to detect it.
    pub depth: Option<Depth>,
    /// Characters for the table; `None` to detect them.
    pub glyphs: Option<Glyphs>,
    /// The table: a bundled one or the path of a TOML file.
    pub table: String,
    /// What counts as a point.
    pub rule: Rule,
    /// The player's skill.
    pub skill: Skill,
    /// How uncertain the table's parameters and the balls' positions are, for the coach.
    pub doubt: Doubt,
    /// Whether the coach plans for the next point.
    pub plan: bool,
    /// Whether the coach may advise jumps and massés.
    pub jumps: bool,
    /// Thinking time of the coach, ms. A quarter of the default second is enough to find an expert three-cushion shots with a success rate
    /// of 98 %. The rest is for players with larger errors and for the next point, and is no longer than a player looks at the table.
    pub think_ms: u64,
    /// Units of length for display.
    pub units: Units,
    /// The step of the arrow keys, mm.
    pub step_mm: f64,
    /// Playback speed, seconds of the shot per second.
    pub speed: f64,
    /// Whether the program captures the mouse.
    pub mouse: bool,
    /// User-defined keys.
    pub keys: Keys,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            theme: ThemeName::default(),
            depth: None,
            glyphs: None,
            table: "match".to_owned(),
            rule: Rule::default(),
            skill: Skill::EXPERT,
            doubt: Doubt::FULL,
            plan: true,
            jumps: true,
            think_ms: 1000,
            units: Units::default(),
            step_mm: 10.0,
            speed: 1.0,
            mouse: true,
            keys: Keys::default(),
        }
    }
}

impl Settings {
    /// The settings file of this user; if the user has no home directory, a file in the working directory.
    pub fn path() -> PathBuf {
        DataPaths::of_this_user().settings
    }

    /// Loads the settings, with the defaults for a missing file and for missing or wrong keys, and the list of mistakes.
    pub fn load(path: &Path) -> (Self, Vec<Mistake>) {
        match storage::read(path, storage::MAX_SMALL_FILE) {
            Ok(bytes) => read::read(&String::from_utf8_lossy(&bytes)),
            Err(error) if error.kind() == io::ErrorKind::NotFound => (Self::default(), Vec::new()),
            Err(error) => (Self::default(), vec![Mistake::of_file(&error)]),
        }
    }

    /// Returns the settings with `entry` set to the value `typed`, given in TOML or as text without quotes.
    ///
    /// # Errors
    /// A message that names the value and what would be accepted.
    pub fn with(&self, entry: &Entry, typed: &str) -> Result<Self, String> {
        // TOML has no decimal comma.
        let number = parse_number(typed).filter(|_| typed.contains(',')).map(|number| number.to_string());
        let number = number.as_deref().unwrap_or(typed);
        for value in [typed, &quoted(typed), number] {
            let mut settings = self.clone();
            if read::apply_value(&mut settings, entry, value).is_some() {
                if settings.table != self.table {
                    settings.table()?;
                }
                return Ok(settings);
            }
        }
        Err(format!("{} = {typed}; accepted is {}", entry.key, entry.accepted))
    }

    /// The table of the settings.
    ///
    /// # Errors
    /// A message if its file cannot be read or contains no table.
    pub fn table(&self) -> Result<Table, String> {
        if PRESETS.contains(&self.table.as_str()) {
            return Table::preset(&self.table).map_err(|error| error.to_string());
        }
        let text = storage::read_text(self.table.as_ref(), storage::MAX_SMALL_FILE).map_err(|error| error.to_string());
        let table =
            text.and_then(|text| Table::from_file(self.table.as_ref(), &text).map_err(|error| error.to_string()));
        table.map_err(|sentence| format!("{}: {sentence}", self.table))
    }

    /// Writes the settings as a complete file, with a comment on the meaning and the accepted values of each key.
    pub fn document(&self) -> String {
        let mut text = String::from("# All settings of carom. A key that is left out has its default.\n");
        for entry in ENTRIES {
            // Writing into a string never fails.
            let _ = write!(
                text,
                "\n# {}\n# Accepted: {}. Default: {}.\n{} = {}\n",
                entry.about,
                entry.accepted,
                (entry.get)(&Self::default()),
                entry.key,
                (entry.get)(self)
            );
        }
        text.push_str(remap::ABOUT);
        text.push_str(&self.keys.document());
        text
    }
}
