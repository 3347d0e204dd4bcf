//! What each key of the settings' screen does, and why it may not be used now.

use crossterm::event::KeyEvent;

use crate::{
    storage::has_name,
    table::PRESETS,
    terminal::{
        Change, Effect, Settings, SettingsAction as Action, SettingsCondition, SettingsContext as Page,
        config::{ENTRIES, Entry},
        keymap::Chord,
        pages::{
            Page as _, around,
            settings::{LONGEST, Question, SettingsPage, TABLE},
        },
        ui::TextField,
    },
};

impl SettingsPage {
    /// Why a binding may not be used now; `None` where it may.
    pub fn disabled_reason(&self, when: SettingsCondition) -> Option<&'static str> {
        let is_changed = match self.page {
            Page::Keys => self.keys.is_changed(&self.settings.keys),
            _ => self.is_changed(self.marked()),
        };
        (when == SettingsCondition::Changed && !is_changed).then_some("this is as it is by default")
    }

    /// Does what an enabled binding asks for.
    pub fn update(&mut self, action: Action) -> Option<Effect> {
        match action {
            Action::Back => self.is_left = true,
            Action::Turn if self.page == Page::Keys => self.page = Page::Values,
            Action::Turn => self.page = Page::Keys,
            Action::Line(lines) if self.page == Page::Keys => self.keys.move_mark(lines),
            Action::Line(lines) => self.mark = self.mark.saturating_add_signed(lines).min(ENTRIES.len() - 1),
            Action::ChooseKeyPage(pages) => self.keys.choose_place(pages),
            Action::Value(step) => return self.step(step),
            Action::Type => self.question = Some(Question::Value(TextField::new(LONGEST))),
            Action::Press => self.question = Some(Question::Key),
            Action::Default if self.page == Page::Keys => {
                let change = self.keys.to_default(&mut self.settings.keys);
                return Some(self.task(Some(change)));
            }
            Action::Default => {
                let entry = self.marked();
                let default = (entry.get)(&Settings::default());
                return self.give_value(entry, &default, Change::Default);
            }
            Action::Answer(false) => self.question = None,
            Action::Answer(true) => return self.yes(),
        }
        None
    }

    fn yes(&mut self) -> Option<Effect> {
        match self.question.take()? {
            Question::Taken(pressed) => Some(self.give(pressed)),
            Question::Key => None,
            // Nothing was typed: what is in force is meant, where the file does not have it already.
            Question::Value(typed) if typed.text().trim().is_empty() => {
                let entry = self.marked();
                self.other_in_file(entry).and_then(|_| self.set(&(entry.get)(&self.settings)))
            }
            Question::Value(typed) => {
                let effect = self.set(typed.text().trim());
                if effect.is_none() {
                    // What was typed stays, to be mended.
                    self.question = Some(Question::Value(typed));
                }
                effect
            }
        }
    }

    /// The value before or after the present one: of numbers the next smaller or larger, of names around the end.
    fn step(&mut self, step: isize) -> Option<Effect> {
        let entry = self.marked();
        let (choices, now) = (self.choices(entry), (entry.get)(&self.settings));
        let number = |text: &String| text.parse::<f64>().ok();
        let next = match number(&now) {
            Some(now) if step > 0 => choices.iter().find(|choice| number(choice).is_some_and(|n| n > now)),
            Some(now) => choices.iter().rfind(|choice| number(choice).is_some_and(|n| n < now)),
            None => {
                let count = choices.len();
                let place = choices.iter().position(|choice| *choice == now);
                let mut others = (1..=count.cast_signed()).map(|steps| match place {
                    Some(place) => around(place, steps * step, count),
                    None => steps.cast_unsigned() - 1,
                });
                // A table of the player's own may not be readable.
                others.find(|other| self.settings.with(entry, &choices[*other]).is_ok()).map(|other| &choices[other])
            }
        };
        let Some(next) = next.cloned() else {
            return self.refuse(format!("{} = {now}; accepted is {}", entry.key, entry.accepted));
        };
        self.set(&next)
    }

    /// Gives the marked setting a value that was chosen or typed.
    fn set(&mut self, typed: &str) -> Option<Effect> {
        let entry = self.marked();
        let own =
            self.tables.iter().find(|path| entry.key == TABLE && !PRESETS.contains(&typed) && has_name(path, typed));
        let path = own.map(|path| path.to_string_lossy().into_owned());
        self.give_value(entry, path.as_deref().unwrap_or(typed), Change::Value)
    }

    /// Gives the setting `key` a value that was chosen elsewhere.
    pub fn choose(&mut self, key: &str, typed: &str) -> Option<Effect> {
        self.give_value(ENTRIES.iter().find(|entry| entry.key == key)?, typed, Change::Value)
    }

    /// Takes a value that is accepted, and makes a change of the file of it.
    fn give_value(&mut self, entry: &Entry, typed: &str, change: fn(&'static str, String) -> Change) -> Option<Effect> {
        match self.settings.with(entry, typed) {
            Ok(settings) => self.settings = settings,
            Err(sentence) => return self.refuse(sentence),
        }
        let value = (entry.get)(&self.settings);
        Some(self.task(Some(change(entry.key, value))))
    }

    /// A key was pressed that is to do what is marked.
    pub fn pressed(&mut self, key: &KeyEvent) -> Option<Effect> {
        match self.keys.check(Chord::of(key), &self.settings.keys) {
            Ok(chord) if self.keys.other_commands(chord, &self.settings.keys).is_empty() => {
                self.question = None;
                return Some(self.give(chord));
            }
            Ok(chord) => self.question = Some(Question::Taken(chord)),
            Err(sentence) => return self.refuse(sentence),
        }
        None
    }

    fn give(&mut self, pressed: Chord) -> Effect {
        let change = self.keys.give(pressed, &mut self.settings.keys);
        self.task(Some(change))
    }
}
