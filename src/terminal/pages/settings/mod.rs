//! The settings page: the settings and key bindings, the mark, and the open question.
//!
//! The page shows the current values. A change takes effect immediately, and a [`SettingsTask`] writes it to the file. The file may
//! differ from the current values until the user asks to write them. [`own_keys`] is the list of key bindings.

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

/// The key of the setting that names the table.
const TABLE: &str = "table";

/// Maximum length of a typed value, bytes. The longest are paths of tables.
const MAX_TEXT_LENGTH: usize = 1000;

/// An open question.
#[derive(Clone, Debug, PartialEq)]
pub enum Question {
    /// A value, with the text typed so far.
    Value(TextField),
    /// The new key, which the user must press.
    Key,
    /// Whether to use this key although it has another command.
    ReplaceKey(Chord),
}

/// The state of the settings page.
#[derive(Debug)]
pub struct SettingsPage {
    /// The locations of the player's files, including the settings file.
    pub places: DataPaths,
    /// The files of the player's custom tables, as last read.
    pub tables: Vec<PathBuf>,
    /// The current settings.
    pub settings: Settings,
    /// The settings in the file; `None` until it has been read, or if it cannot be read.
    pub file: Option<Settings>,
    /// Whether the file can be read and written, as last reported.
    pub is_writable: bool,
    /// The open screen: the settings or the keys.
    pub page: SettingsContext,
    /// The open question.
    pub question: Option<Question>,
    /// The list of key bindings.
    pub keys: OwnKeys,
    /// The message of the status line.
    pub message: Option<Message>,
    /// Index of the marked setting.
    pub mark: usize,
    /// The numbers of the last sent task and of the last received result.
    sent: u64,
    received: u64,
    /// Whether the user has left the page.
    pub is_closed: bool,
}

impl SettingsPage {
    /// Creates the page, closed.
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
            is_closed: false,
        }
    }

    /// Opens the page at the last open screen. The file is read again; the current settings stay.
    pub fn open(&mut self) -> Effect {
        self.message = None;
        self.is_closed = false;
        self.task(None)
    }

    /// The marked setting.
    pub fn marked(&self) -> &'static Entry {
        &ENTRIES[self.mark.min(ENTRIES.len() - 1)]
    }

    /// Whether a setting differs from its default, now or in the file.
    pub fn is_changed(&self, entry: &Entry) -> bool {
        (entry.get)(&self.settings) != (entry.get)(&Settings::default())
            || self.different_value_in_file(entry).is_some()
    }

    /// The value of a setting in the file, if it differs from the current one.
    pub fn different_value_in_file(&self, entry: &Entry) -> Option<String> {
        // The content of the file is unknown while it is being changed.
        let file = self.file.as_ref().filter(|_| self.received == self.sent)?;
        Some((entry.get)(file)).filter(|value| *value != (entry.get)(&self.settings))
    }

    /// The files of the player's custom tables, if `entry` is the setting of the table; otherwise none.
    pub fn own_tables_of(&self, entry: &Entry) -> impl Iterator<Item = &PathBuf> {
        self.tables.iter().filter(move |_| entry.key == TABLE)
    }

    /// The values of a setting that the keys step through, as TOML.
    fn choices(&self, entry: &Entry) -> Vec<String> {
        let own = self.own_tables_of(entry).map(|path| quoted(path.to_string_lossy()));
        (entry.choices)().into_iter().chain(own).collect()
    }

    /// Formats a value for display: without the quotes of TOML, and a custom table by its name instead of its path.
    pub fn display_value(&self, value: &str) -> String {
        let value = value.trim_matches(['"', '\'']);
        let own = self.tables.iter().find(|path| path.as_os_str() == value).and_then(|path| path.file_stem());
        own.map_or_else(|| value.to_owned(), |name| name.to_string_lossy().into_owned())
    }

    /// The key context.
    pub const fn key_context(&self) -> SettingsContext {
        if let Some(Question::Key) = self.question { SettingsContext::Pressing } else { self.page }
    }

    fn task(&mut self, change: Option<Change>) -> Effect {
        self.sent += 1;
        Effect::Settings(Box::new(SettingsTask { number: self.sent, paths: self.places.clone(), change }))
    }

    /// Handles the result of a task. Returns messages on problems with the file.
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
