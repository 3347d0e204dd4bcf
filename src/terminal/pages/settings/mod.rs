//! The state of the settings' screen: which setting or key is marked, and what is typed, pressed or asked.
//!
//! It shows what is in force. Every change holds at once; [`SettingsTask`] brings it into the file, which may say
//! something else as long as that is not asked for. [`super::own_keys`] is the page of the keys.

pub mod keys;
mod own_keys;
mod page;
mod view;

use std::path::PathBuf;

use crossterm::event::KeyEvent;

use crate::terminal::{
    Change, Effect, Settings, SettingsAction as Action, SettingsCondition, SettingsContext, SettingsReport,
    SettingsTask,
    config::{ENTRIES, Entry},
    keymap::{Chord, KeyPage},
    pages::settings::own_keys::OwnKeys,
    ui::{Message, TextField},
};

/// Longest value that is typed, bytes: the path of a table is one.
const LONGEST: usize = 1000;

/// A page of the screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Screen {
    /// The settings.
    Values,
    /// The keys.
    Keys,
}

/// What is being put in.
#[derive(Clone, Debug, PartialEq)]
pub enum Input {
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
    /// The file.
    pub path: PathBuf,
    /// What is in force.
    pub settings: Settings,
    /// What the file says; `None` until it was read, and where it cannot be.
    pub file: Option<Settings>,
    /// Whether the file can be read and changed, as far as is known.
    pub is_writable: bool,
    /// The page that is open.
    pub page: Screen,
    /// What is being put in.
    pub input: Option<Input>,
    /// The page of keys.
    pub keys: OwnKeys,
    /// What the status line says.
    pub message: Option<Message>,
    mark: usize,
    /// What was in force before the last change.
    before: Settings,
    /// The number of the last task, and of the last that came back.
    sent: u64,
    received: u64,
    is_left: bool,
}

impl SettingsPage {
    /// The screen before it is opened.
    pub fn new(path: PathBuf, pages: Vec<KeyPage>) -> Self {
        Self {
            path,
            settings: Settings::default(),
            file: None,
            is_writable: true,
            page: Screen::Values,
            input: None,
            keys: OwnKeys::new(pages),
            message: None,
            mark: 0,
            before: Settings::default(),
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

    /// Whether one has gone back.
    pub const fn is_left(&self) -> bool {
        self.is_left
    }

    /// Place of the marked setting among all.
    pub const fn mark(&self) -> usize {
        self.mark
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

    /// Whose keys are in force.
    pub const fn place(&self) -> SettingsContext {
        match (&self.input, self.page) {
            (Some(Input::Value(_)), _) => SettingsContext::Typing,
            (Some(Input::Key), _) => SettingsContext::Pressing,
            (Some(Input::Taken(_)), _) => SettingsContext::Question,
            (None, page) => Self::place_of(page),
        }
    }

    /// The page's own keys, whatever is asked.
    pub const fn page_place(&self) -> SettingsContext {
        Self::place_of(self.page)
    }

    const fn place_of(page: Screen) -> SettingsContext {
        match page {
            Screen::Values => SettingsContext::Values,
            Screen::Keys => SettingsContext::Keys,
        }
    }

    /// Why a binding may not be used now; `None` where it may.
    pub fn disabled_reason(&self, when: SettingsCondition) -> Option<&'static str> {
        let is_changed = match self.page {
            Screen::Values => self.is_changed(self.marked()),
            Screen::Keys => self.keys.is_changed(&self.settings.keys),
        };
        (when == SettingsCondition::Changed && !is_changed).then_some("this is as it is by default")
    }

    /// Does what an enabled binding asks for.
    pub fn update(&mut self, action: Action) -> Option<Effect> {
        match action {
            Action::Back => self.is_left = true,
            Action::Turn => self.page = if self.page == Screen::Values { Screen::Keys } else { Screen::Values },
            Action::Line(lines) if self.page == Screen::Keys => self.keys.move_mark(lines),
            Action::Line(lines) => self.mark = self.mark.saturating_add_signed(lines).min(ENTRIES.len() - 1),
            Action::KeyContext(pages) => self.keys.choose_place(pages),
            Action::Value(step) => return self.step(step),
            Action::Type => self.input = Some(Input::Value(TextField::new(LONGEST))),
            Action::Press => self.input = Some(Input::Key),
            Action::Default if self.page == Screen::Keys => {
                self.before.clone_from(&self.settings);
                let change = self.keys.to_default(&mut self.settings.keys);
                return Some(self.task(Some(change)));
            }
            Action::Default => {
                let entry = self.marked();
                let default = (entry.get)(&Settings::default());
                return self.take(&default, Change::Default(entry.key, default.clone()));
            }
            Action::No => self.input = None,
            Action::Yes => return self.yes(),
        }
        None
    }

    fn yes(&mut self) -> Option<Effect> {
        match self.input.take()? {
            Input::Taken(pressed) => Some(self.give(pressed)),
            Input::Key => None,
            // Nothing was typed: what is in force is meant, where the file does not have it already.
            Input::Value(typed) if typed.text().trim().is_empty() => {
                let entry = self.marked();
                self.other_in_file(entry).and_then(|_| self.set(&(entry.get)(&self.settings)))
            }
            Input::Value(typed) => {
                let effect = self.set(typed.text().trim());
                if effect.is_none() {
                    // What was typed stays, to be mended.
                    self.input = Some(Input::Value(typed));
                }
                effect
            }
        }
    }

    /// The value before or after the present one: of numbers the next smaller or larger, of names around the end.
    fn step(&mut self, step: isize) -> Option<Effect> {
        let entry = self.marked();
        let (choices, now) = ((entry.choices)(), (entry.get)(&self.settings));
        let number = |text: &String| text.parse::<f64>().ok();
        let next = match number(&now) {
            Some(now) if step > 0 => choices.iter().find(|choice| number(choice).is_some_and(|n| n > now)),
            Some(now) => choices.iter().rfind(|choice| number(choice).is_some_and(|n| n < now)),
            None => {
                let count = choices.len();
                let place = choices.iter().position(|choice| *choice == now);
                let next = place.map_or(0, |place| (place + count).saturating_add_signed(step) % count);
                choices.get(next)
            }
        };
        let Some(next) = next.cloned() else {
            self.message = Some(Message::warning(format!("{} = {now}; accepted is {}", entry.key, entry.accepted)));
            return None;
        };
        self.set(&next)
    }

    /// Gives the marked setting a value that was chosen or typed.
    fn set(&mut self, typed: &str) -> Option<Effect> {
        let entry = self.marked();
        match self.settings.with(entry, typed) {
            Ok(settings) => {
                let value = (entry.get)(&settings);
                self.take(&value.clone(), Change::Value(entry.key, value))
            }
            Err(sentence) => {
                self.message = Some(Message::warning(sentence));
                None
            }
        }
    }

    /// Takes a value that is accepted.
    fn take(&mut self, value: &str, change: Change) -> Option<Effect> {
        match self.settings.with(self.marked(), value) {
            Ok(settings) => self.before = std::mem::replace(&mut self.settings, settings),
            Err(sentence) => {
                self.message = Some(Message::warning(sentence));
                return None;
            }
        }
        Some(self.task(Some(change)))
    }

    /// A key was pressed that is to do what is marked.
    pub fn pressed(&mut self, key: &KeyEvent) -> Option<Effect> {
        match self.keys.check(Chord::of(key), &self.settings.keys) {
            Ok(chord) if self.keys.other_works(chord, &self.settings.keys).is_empty() => {
                self.input = None;
                return Some(self.give(chord));
            }
            Ok(chord) => self.input = Some(Input::Taken(chord)),
            Err(sentence) => self.message = Some(Message::warning(sentence)),
        }
        None
    }

    fn give(&mut self, pressed: Chord) -> Effect {
        self.before.clone_from(&self.settings);
        let change = self.keys.give(pressed, &mut self.settings.keys);
        self.task(Some(change))
    }

    fn task(&mut self, change: Option<Change>) -> Effect {
        self.sent += 1;
        Effect::Settings(Box::new(SettingsTask { number: self.sent, path: self.path.clone(), change }))
    }

    /// Takes what has come of a task, and gives what is wrong. A change that was refused is taken back, as long as
    /// nothing has been changed since; then what somebody else has changed in the file comes into force.
    pub fn receive(&mut self, report: SettingsReport) -> Vec<String> {
        let SettingsReport { number, settings: file, is_writable, is_refused, troubles } = report;
        if is_refused && number == self.sent {
            self.settings = match (&self.file, &file) {
                (Some(known), Some(file)) => self.before.with_changes(known, file),
                _ => self.before.clone(),
            };
        }
        (self.received, self.file, self.is_writable) = (number, file, is_writable);
        troubles
    }
}
