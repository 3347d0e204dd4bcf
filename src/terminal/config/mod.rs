//! What the user has chosen once and for all: a file in TOML, every key of it optional.

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
    printing::typed_number,
    storage::{self, Places},
    table::{PRESETS, Table},
    terminal::{Depth, Glyphs, Keys, ThemeName, keymap::remap},
};

pub use change::Change;
pub use entries::{ENTRIES, Entry, quoted};
pub use file::{SettingsFile, SettingsReport, SettingsTask};
pub use read::Complaint;

/// What the program starts with.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// The colours.
    pub theme: ThemeName,
    /// How many colours the terminal has; `None` to find out.
    pub depth: Option<Depth>,
    /// What the table is drawn with; `None` to find out.
    pub glyphs: Option<Glyphs>,
    /// The table: a bundled one or the path of a TOML file.
    pub table: String,
    /// What counts as a point.
    pub rule: Rule,
    /// Who plays.
    pub skill: Skill,
    /// How much of the table and of the balls' places the coach takes to be unknown.
    pub doubt: Doubt,
    /// Whether the coach has the next point in mind.
    pub plan: bool,
    /// Whether the coach may advise jumps and massés.
    pub jumps: bool,
    /// How long the coach may think, ms. A quarter of the usual second finds an expert three-cushion shots that are made 98
    /// times of 100; the rest is for players who err more and for the next point, and no longer than a player looks at the
    /// table.
    pub think_ms: u64,
    /// The units in which lengths are told.
    pub units: Units,
    /// The step of the arrow keys, mm.
    pub step_mm: f64,
    /// Seconds of a shot in a second of the screen.
    pub speed: f64,
    /// Whether the program takes the mouse.
    pub mouse: bool,
    /// Keys that do what others do.
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
    /// The file of this user; where the user has no home, one in the working directory.
    pub fn path() -> PathBuf {
        Places::of_this_user().settings
    }

    /// What the file says, or the defaults where there is none or a key is wrong; and what is wrong.
    pub fn load(path: &Path) -> (Self, Vec<Complaint>) {
        match storage::read(path, storage::SMALL) {
            Ok(bytes) => read::read(&String::from_utf8_lossy(&bytes)),
            Err(error) if error.kind() == io::ErrorKind::NotFound => (Self::default(), Vec::new()),
            Err(error) => (Self::default(), vec![Complaint::of_file(&error)]),
        }
    }

    /// The same with the setting called `key` at the value that `typed` is: as TOML, or a text without its quotes.
    ///
    /// # Errors
    /// A sentence that names the value and what would be accepted.
    pub fn with(&self, entry: &Entry, typed: &str) -> Result<Self, String> {
        // A number with a decimal comma is none of TOML's.
        let number = typed_number(typed).filter(|_| typed.contains(',')).map(|number| number.to_string());
        let number = number.as_deref().unwrap_or(typed);
        for value in [typed, &quoted(typed), number] {
            let mut settings = self.clone();
            if read::take_value(&mut settings, entry, value).is_some() {
                if settings.table != self.table {
                    settings.table()?;
                }
                return Ok(settings);
            }
        }
        Err(format!("{} = {typed}; accepted is {}", entry.key, entry.accepted))
    }

    /// The table that is named.
    ///
    /// # Errors
    /// A sentence where its file cannot be read or holds no table.
    pub fn table(&self) -> Result<Table, String> {
        if PRESETS.contains(&self.table.as_str()) {
            return Table::preset(&self.table).map_err(|error| error.to_string());
        }
        let text = storage::read_text(self.table.as_ref(), storage::SMALL).map_err(|error| error.to_string());
        let table =
            text.and_then(|text| Table::from_file(self.table.as_ref(), &text).map_err(|error| error.to_string()));
        table.map_err(|sentence| format!("{}: {sentence}", self.table))
    }

    /// The settings as a file with everything that may stand in it, each key with what it means and accepts.
    pub fn document(&self) -> String {
        let mut text = String::from("# All settings of carom. A key that is left out has its default.\n");
        for entry in ENTRIES {
            // Writing into a text never fails.
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
