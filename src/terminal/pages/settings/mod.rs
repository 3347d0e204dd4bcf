//! The state of the settings' screen: which setting or key is marked, and what is typed, pressed or asked.
//!
//! It shows what is in force. Every change holds at once; [`SettingsTask`] brings it into the file, which may say
//! something else as long as that is not asked for. [`super::own_keys`] is the page of the keys.

mod actions;
pub mod keys;
mod own_keys;
mod view;

use std::path::PathBuf;

use crate::{
    storage::DataPaths,
    terminal::{
        Change, Effect, Settings, SettingsContext, SettingsReport, SettingsTask,
        config::{ENTRIES, Entry, quoted},
        keymap::{Chord, KeyPage},
        pages::{Page, settings::own_keys::OwnKeys},
        ui::{Message, TextField},
    },
};

/// The setting that names the table.
const TABLE: &str = "table";

/// Longest value that is typed, bytes: the path of a table is one.
const LONGEST: usize = 1000;

/// What is asked.
#[derive(Clone, Debug, PartialEq)]
pub enum Question {
    /// A value, as far as it is typed.
    Value(TextField),
    /// A key that is to be pressed.
    Key,
    /// Whether this key may give up what it does otherwise.
    Taken(Chord),
}

/// The state of the screen.
#[derive(Debug)]
pub struct SettingsPage {
    /// Where the player's files are, that of the settings among them.
    pub places: DataPaths,
    /// The files of the player's own tables, as far as is known.
    pub tables: Vec<PathBuf>,
    /// What is in force.
    pub settings: Settings,
    /// What the file says; `None` until it was read, and where it cannot be.
    pub file: Option<Settings>,
    /// Whether the file can be read and changed, as far as is known.
    pub is_writable: bool,
    /// The page that is open: the settings, or the keys.
    pub page: SettingsContext,
    /// What is asked.
    pub question: Option<Question>,
    /// The page of keys.
    pub keys: OwnKeys,
    /// What the status line says.
    pub message: Option<Message>,
    /// Place of the marked setting among all.
    pub mark: usize,
    /// The number of the last task, and of the last that came back.
    sent: u64,
    received: u64,
    /// Whether one has gone back.
    pub is_left: bool,
}

impl SettingsPage {
    /// The screen before it is opened.
    pub fn new(places: DataPaths, pages: Vec<KeyPage>) -> Self {
        Self {
            places,
            tables: Vec::new(),
            settings: Settings::default(),
            file: None,
            is_writable: true,
            page: SettingsContext::Values,
            question: None,
            keys: OwnKeys::new(pages),
            message: None,
            mark: 0,
            sent: 0,
            received: 0,
            is_left: false,
        }
    }

    /// Opens the page that was open last; the file is read again, and what is in force stays.
    pub fn open(&mut self) -> Effect {
        self.message = None;
        self.is_left = false;
        self.task(None)
    }

    /// The marked setting.
    pub fn marked(&self) -> &'static Entry {
        &ENTRIES[self.mark.min(ENTRIES.len() - 1)]
    }

    /// Whether a setting is not at its default, now or in the file.
    pub fn is_changed(&self, entry: &Entry) -> bool {
        (entry.get)(&self.settings) != (entry.get)(&Settings::default()) || self.other_in_file(entry).is_some()
    }

    /// The setting as the file has it, where that is not what is in force.
    pub fn other_in_file(&self, entry: &Entry) -> Option<String> {
        // What the file says is not known while it is being changed.
        let file = self.file.as_ref().filter(|_| self.received == self.sent)?;
        Some((entry.get)(file)).filter(|value| *value != (entry.get)(&self.settings))
    }

    /// The files of the player's own tables, if the setting is the table.
    pub fn own_tables_of(&self, entry: &Entry) -> impl Iterator<Item = &PathBuf> {
        self.tables.iter().filter(move |_| entry.key == TABLE)
    }

    /// Values of a setting to step through, as TOML.
    fn choices(&self, entry: &Entry) -> Vec<String> {
        let own = self.own_tables_of(entry).map(|path| quoted(path.to_string_lossy()));
        (entry.choices)().into_iter().chain(own).collect()
    }

    /// A value without the quotes that TOML wants; one of the player's own tables by its name.
    pub fn shown(&self, value: &str) -> String {
        let value = value.trim_matches(['"', '\'']);
        let own = self.tables.iter().find(|path| path.as_os_str() == value).and_then(|path| path.file_stem());
        own.map_or_else(|| value.to_owned(), |name| name.to_string_lossy().into_owned())
    }

    /// The key context.
    pub const fn place(&self) -> SettingsContext {
        if let Some(Question::Key) = self.question { SettingsContext::Pressing } else { self.page }
    }

    fn task(&mut self, change: Option<Change>) -> Effect {
        self.sent += 1;
        Effect::Settings(Box::new(SettingsTask { number: self.sent, places: self.places.clone(), change }))
    }

    /// Takes what has come of a task, and gives what is wrong.
    pub fn receive(&mut self, report: SettingsReport) -> Vec<String> {
        let SettingsReport { number, settings, is_writable, troubles, tables } = report;
        self.tables = tables;
        (self.received, self.file, self.is_writable) = (number, settings, is_writable);
        troubles
    }
}

impl Page for SettingsPage {
    fn message_mut(&mut self) -> &mut Option<Message> {
        &mut self.message
    }

    fn field_mut(&mut self) -> Option<&mut TextField> {
        if let Some(Question::Value(value)) = &mut self.question { Some(value) } else { None }
    }
}
