//! What a key asks for, where it is pressed, and why not.

use crossterm::event::{KeyCode, KeyEvent, KeyEventKind, KeyModifiers};

use super::{App, Effect, Screen};
use crate::terminal::{
    keymap::{self, Action, Place, When},
    screens,
    settings::Input,
};

impl App {
    /// A key was pressed.
    pub fn handle(&mut self, key: &KeyEvent) -> Option<Effect> {
        if key.kind == KeyEventKind::Release {
            return None;
        }
        let effect = self.take_key(key);
        self.gather(true);
        effect
    }

    fn take_key(&mut self, key: &KeyEvent) -> Option<Effect> {
        // Everywhere, whatever lies over the screen.
        if (key.code, key.modifiers) == (KeyCode::Char('c'), KeyModifiers::CONTROL) {
            return self.update(Action::Quit);
        }
        if self.is_blind() {
            let refuse_help = |when| (when == When::Help).then_some("");
            return match keymap::find(&self.keys().translate(key), Place::Coach, refuse_help) {
                Some(Ok(action @ (Action::Quit | Action::Suspend))) => self.update(action),
                _ => None,
            };
        }
        if let Some(finder) = &mut self.finder {
            if finder.take_key(key) {
                *self.message_mut() = None;
                self.toasts.go_on();
                return None;
            }
        } else if self.help.is_none() {
            let typed = match self.screen {
                Screen::Coach => false,
                Screen::Training => self.training.typed(key),
                Screen::Drills => self.drills.typed(key),
                Screen::Settings => self.settings.typed(key),
            };
            if typed {
                self.toasts.go_on();
                return None;
            }
        }
        // Where a key is asked for, each is an answer that means nothing else.
        let is_answer = self.is_asked_for_a_key();
        let meant = if is_answer { *key } else { self.keys().translate(key) };
        let found = keymap::find(&meant, self.place(), |when| self.refusal(when));
        if is_answer && !matches!(found, Some(Ok(Action::Quit | Action::Suspend | Action::Settings(_)))) {
            self.toasts.go_on();
            let effect = self.settings.pressed(key);
            return self.set(effect);
        }
        let found = found?;
        *self.message_mut() = None;
        self.toasts.go_on();
        if meant.code == KeyCode::Esc {
            self.toasts.clear();
        }
        match found {
            Ok(action) => self.update(action),
            Err(reason) => {
                self.toasts.push(reason.to_owned(), true);
                None
            }
        }
    }

    /// Whether nothing could be seen of what a key does, for want of room.
    pub(super) fn is_blind(&self) -> bool {
        !self.area.get().is_empty() && screens::is_too_small(self.area.get())
    }

    const fn is_asked_for_a_key(&self) -> bool {
        matches!((self.screen, &self.settings.input), (Screen::Settings, Some(Input::Key)))
            && self.help.is_none()
            && self.finder.is_none()
    }

    /// Text was pasted.
    pub fn paste(&mut self, text: &str) {
        if let Some(finder) = &mut self.finder {
            finder.take_text(text);
        } else if self.help.is_none() {
            match self.screen {
                Screen::Drills => self.drills.pasted(text),
                Screen::Settings => drop(self.settings.pasted(text)),
                Screen::Coach | Screen::Training => {}
            }
        }
    }

    /// Why a binding may not be used now; `None` where it may.
    pub fn refusal(&self, when: When) -> Option<&'static str> {
        match when {
            When::Help => self.help.is_none().then_some("the help is not open"),
            When::Tabs => self.stands_alone().then_some("carom watch has no other screens; carom has them all"),
            _ if self.help.is_some() => Some("close the help first: Esc"),
            When::Always => None,
            When::Coach(when) => self.coach.refusal(when),
            When::Training(when) => self.training.refusal(when),
            When::Drill(when) => self.drills.refusal(when),
            When::Settings(when) => self.settings.refusal(when),
        }
    }

    /// What is on the screen. The help is that of what lies below it.
    pub fn place(&self) -> Place {
        if self.finder.is_some() { Place::Finder } else { self.place_below() }
    }

    /// The same without the command palette.
    pub(super) fn place_below(&self) -> Place {
        match self.screen {
            Screen::Coach => Place::Coach,
            Screen::Training if self.help.is_some() => self.training.page().place(),
            Screen::Training => self.training.place(),
            Screen::Drills if self.help.is_some() => Place::Drill(self.drills.page_place()),
            Screen::Drills => Place::Drill(self.drills.place()),
            Screen::Settings if self.help.is_some() => Place::Settings(self.settings.page_place()),
            Screen::Settings => Place::Settings(self.settings.place()),
        }
    }
}
