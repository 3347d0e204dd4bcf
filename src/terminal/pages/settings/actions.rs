//! Implementation of the settings page's key actions, and their conditions.

use crossterm::event::KeyEvent;

use crate::{
    storage::has_name,
    table::PRESETS,
    terminal::{
        Change, Effect, Settings, SettingsAction as Action, SettingsCondition, SettingsContext as Page,
        config::{ENTRIES, Entry},
        keymap::Chord,
        pages::{
            Page as _, moved_index,
            settings::{MAX_TEXT_LENGTH, Question, SettingsPage, TABLE},
            wrapping_index,
        },
        ui::TextField,
    },
};

impl SettingsPage {
    /// Returns the reason why a key binding is disabled now; `None` if it is enabled.
    pub fn disabled_reason(&self, when: SettingsCondition) -> Option<&'static str> {
        let is_changed = match self.page {
            Page::Keys => self.keys.is_changed(&self.settings.keys),
            _ => self.is_changed(self.marked()),
        };
        (when == SettingsCondition::Changed && !is_changed).then_some("this is the default already")
    }

    /// Performs the action of an enabled key binding.
    pub fn update(&mut self, action: Action) -> Option<Effect> {
        match action {
            Action::Back => self.is_closed = true,
            Action::ToggleKeys if self.page == Page::Keys => self.page = Page::Values,
            Action::ToggleKeys => self.page = Page::Keys,
            Action::MoveMark(lines) if self.page == Page::Keys => self.keys.move_mark(lines),
            Action::MoveMark(lines) => self.mark = moved_index(self.mark, lines, ENTRIES.len()),
            Action::ChooseKeyPage(pages) => self.keys.choose_page(pages),
            Action::ChangeValue(step) => return self.step(step),
            Action::TypeValue => self.question = Some(Question::Value(TextField::new(MAX_TEXT_LENGTH))),
            Action::AskForKey => self.question = Some(Question::Key),
            Action::ResetToDefault if self.page == Page::Keys => {
                let change = self.keys.reset(&mut self.settings.keys);
                return Some(self.task(Some(change)));
            }
            Action::ResetToDefault => {
                let entry = self.marked();
                let default = (entry.get)(&Settings::default());
                return self.assign_value(entry, &default, Change::Default);
            }
            Action::Answer(false) => self.question = None,
            Action::Answer(true) => return self.accept_answer(),
        }
        None
    }

    fn accept_answer(&mut self) -> Option<Effect> {
        match self.question.take()? {
            Question::ReplaceKey(pressed) => Some(self.assign(pressed)),
            Question::Key => None,
            // Nothing was typed: write the current value to the file if the file has another one.
            Question::Value(typed) if typed.text().trim().is_empty() => {
                let entry = self.marked();
                self.different_value_in_file(entry).and_then(|_| self.set(&(entry.get)(&self.settings)))
            }
            Question::Value(typed) => {
                let effect = self.set(typed.text().trim());
                if effect.is_none() {
                    // The typed text stays for a correction.
                    self.question = Some(Question::Value(typed));
                }
                effect
            }
        }
    }

    /// Chooses the previous or next value: the next smaller or larger number, or the neighbouring name with wrap-around.
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
                    Some(place) => wrapping_index(place, steps * step, count),
                    None => steps.cast_unsigned() - 1,
                });
                // A custom table may be unreadable, so skip choices that are not accepted.
                others.find(|other| self.settings.with(entry, &choices[*other]).is_ok()).map(|other| &choices[other])
            }
        };
        let Some(next) = next.cloned() else {
            return self.refuse(format!("{} = {now}; accepted is {}", entry.key, entry.accepted));
        };
        self.set(&next)
    }

    /// Sets the marked setting to a chosen or typed value.
    fn set(&mut self, typed: &str) -> Option<Effect> {
        let entry = self.marked();
        let own =
            self.tables.iter().find(|path| entry.key == TABLE && !PRESETS.contains(&typed) && has_name(path, typed));
        let path = own.map(|path| path.to_string_lossy().into_owned());
        self.assign_value(entry, path.as_deref().unwrap_or(typed), Change::Value)
    }

    /// Sets the setting `key` to a value that was chosen on another page.
    pub fn choose(&mut self, key: &str, typed: &str) -> Option<Effect> {
        self.assign_value(ENTRIES.iter().find(|entry| entry.key == key)?, typed, Change::Value)
    }

    /// Applies a value if it is accepted, and requests the change of the file.
    fn assign_value(
        &mut self,
        entry: &Entry,
        typed: &str,
        change: fn(&'static str, String) -> Change,
    ) -> Option<Effect> {
        match self.settings.with(entry, typed) {
            Ok(settings) => self.settings = settings,
            Err(sentence) => return self.refuse(sentence),
        }
        let value = (entry.get)(&self.settings);
        Some(self.task(Some(change(entry.key, value))))
    }

    /// Handles the key that the user pressed as the new key of the marked command.
    pub fn on_key_pressed(&mut self, key: &KeyEvent) -> Option<Effect> {
        match self.keys.check(Chord::of(key), &self.settings.keys) {
            Ok(chord) if self.keys.other_commands(chord, &self.settings.keys).is_empty() => {
                self.question = None;
                return Some(self.assign(chord));
            }
            Ok(chord) => self.question = Some(Question::ReplaceKey(chord)),
            Err(sentence) => return self.refuse(sentence),
        }
        None
    }

    fn assign(&mut self, pressed: Chord) -> Effect {
        let change = self.keys.assign(pressed, &mut self.settings.keys);
        self.task(Some(change))
    }
}
