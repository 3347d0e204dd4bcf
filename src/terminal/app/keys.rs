//! What a key asks for, where it is pressed, and why not.

use crossterm::event::{KeyCode, KeyEvent, KeyEventKind, KeyModifiers};

use crate::{
    platform,
    terminal::{
        Action, App, CalibrationContext, CoachCondition, Condition, Effect, KeyContext, PageId,
        app::{bindings, view},
        pages::settings::Question,
        ui::Typed,
    },
};

impl App {
    /// A key was pressed.
    pub fn handle(&mut self, key: &KeyEvent) -> Option<Effect> {
        if key.kind == KeyEventKind::Release {
            return None;
        }
        let effect = self.take_key(key);
        self.collect_toasts(true);
        effect.or_else(|| self.study())
    }

    /// A closer look at the coach's shot, where that is on the screen and none was taken yet: settings that were changed elsewhere may
    /// have brought it back.
    pub(super) fn study(&mut self) -> Option<Effect> {
        if self.screen == PageId::Coach { self.coach.study() } else { None }
    }

    /// A key whose byte has come in one piece with that of an Esc pressed just before, which is how terminals send a key with Alt: where
    /// Alt means nothing, these are two keys.
    fn take_both(&mut self, key: &KeyEvent) -> Option<Effect> {
        let bare = KeyEvent { modifiers: key.modifiers - KeyModifiers::ALT, ..*key };
        let effect = self.take_key(&KeyEvent::from(KeyCode::Esc));
        effect.or_else(|| self.take_key(&bare))
    }

    fn take_key(&mut self, key: &KeyEvent) -> Option<Effect> {
        // Everywhere, whatever lies over the screen.
        if (key.code, key.modifiers) == (KeyCode::Char('c'), KeyModifiers::CONTROL) {
            return self.update(Action::Quit);
        }
        if self.is_too_small() {
            let refuse = |when| match when {
                Condition::Overlay => Some(""),
                Condition::Shell => self.no_shell(),
                _ => None,
            };
            return match bindings::find(&self.keys().translate(key), KeyContext::Coach, refuse) {
                Some(Ok(action @ (Action::Quit | Action::Suspend))) => self.update(action),
                _ => None,
            };
        }
        if self.input(Typed::Key(key)) {
            self.toasts.go_on();
            return None;
        }
        // Where a key is asked for, each is an answer that means nothing else.
        let is_asked_for_a_key = self.is_asked_for_a_key();
        let find = |key: &KeyEvent| bindings::find(key, self.place(), |when| self.disabled_reason(when));
        // The letters that a question asks for are its answers, even where the user gave them other work.
        let is_answer = matches!(find(key), Some(Ok(Action::Answer(_))));
        let meant = if is_asked_for_a_key || is_answer { *key } else { self.keys().translate(key) };
        let found = find(&meant);
        if is_asked_for_a_key && !matches!(found, Some(Ok(Action::Quit | Action::Suspend | Action::Settings(_)))) {
            self.toasts.go_on();
            let effect = self.settings.pressed(key);
            self.take_changes();
            return effect;
        }
        if found.is_none() && key.modifiers.contains(KeyModifiers::ALT) {
            return self.take_both(key);
        }
        let found = found?;
        if meant.code == KeyCode::Esc {
            self.toasts.clear();
            if found.is_err() {
                // Where there is nothing to leave, nothing is to be said.
                *self.page_mut().message_mut() = None;
                return None;
            }
        }
        self.perform(found)
    }

    /// Does what a key or the mouse has asked for, or says why not.
    pub(super) fn perform(&mut self, asked: Result<Action, &'static str>) -> Option<Effect> {
        *self.page_mut().message_mut() = None;
        self.toasts.go_on();
        match asked {
            Ok(action) => self.update(action),
            Err(reason) => {
                if self.overlay.is_some() {
                    // The page that is read may be that of the messages.
                    self.toasts.push_for_now(reason.to_owned());
                } else {
                    self.toasts.push(reason.to_owned(), true);
                }
                None
            }
        }
    }

    /// Whether nothing could be seen of what a key does, for want of room.
    pub(super) const fn is_too_small(&self) -> bool {
        !self.area.is_empty() && view::is_too_small(self.area)
    }

    const fn is_asked_for_a_key(&self) -> bool {
        matches!((self.screen, &self.settings.question), (PageId::Settings, Some(Question::Key)))
            && self.overlay.is_none()
            && self.command_palette.is_none()
    }

    /// Text was pasted.
    pub fn paste(&mut self, text: &str) {
        if self.is_too_small() {
            return;
        }
        self.input(Typed::Paste(text));
        self.collect_toasts(true);
    }

    /// Takes what was typed or pasted where text is typed; `false` where none is, or the key means something else.
    fn input(&mut self, typed: Typed) -> bool {
        if let Some(command_palette) = &mut self.command_palette {
            let taken = command_palette.input(typed);
            if taken {
                *self.page_mut().message_mut() = None;
            }
            return taken;
        }
        self.overlay.is_none() && self.page_mut().input(typed)
    }

    /// Why a binding may not be used now; `None` where it may.
    pub fn disabled_reason(&self, when: Condition) -> Option<&'static str> {
        match when {
            Condition::Overlay => self.overlay.is_none().then_some("no page lies over the screen"),
            Condition::Tabs => self.stands_alone().then_some("no other screens here; start carom for all of them"),
            _ if self.overlay.is_some() => Some("close this first: Esc"),
            Condition::Always => None,
            Condition::Shell => self.no_shell(),
            Condition::Coach(CoachCondition::Interrupted) if self.goes_on_with_open_exam() => {
                self.coach.disabled_reason(CoachCondition::Idle)
            }
            Condition::Coach(when) => self.coach.disabled_reason(when),
            Condition::Training(when) => self.training.disabled_reason(when),
            Condition::Drill(when) => self.drills.disabled_reason(when),
            Condition::Settings(when) => self.settings.disabled_reason(when),
            Condition::Calibration(when) => self.calibration.disabled_reason(when),
        }
    }

    /// Why the program cannot be suspended.
    fn no_shell(&self) -> Option<&'static str> {
        if self.is_guest {
            return Some("guests have no shell to go back to; q quits");
        }
        (!platform::CAN_SUSPEND).then_some("programs cannot be suspended here; q quits")
    }

    /// What is on the screen. The help is that of what lies below it.
    pub fn place(&self) -> KeyContext {
        if self.command_palette.is_some() { KeyContext::CommandPalette } else { self.place_below() }
    }

    /// The same without the command palette.
    pub(super) fn place_below(&self) -> KeyContext {
        let asked = self.page().asked(self.caps).filter(|asked| self.overlay.is_none() && !asked.has_own_keys);
        if let Some(asked) = asked {
            return KeyContext::Question { is_typed: asked.typed.is_some() };
        }
        match self.screen {
            PageId::Coach if self.coach.followed().is_some() => KeyContext::Follow,
            PageId::Coach if self.coach.what_if().is_some() => KeyContext::OwnStroke,
            PageId::Coach => KeyContext::Coach,
            PageId::Training => KeyContext::Training(self.training.page()),
            PageId::Drills if self.overlay.is_some() => KeyContext::Drill(self.drills.page()),
            PageId::Drills => KeyContext::Drill(self.drills.place()),
            PageId::Settings if self.overlay.is_some() => KeyContext::Settings(self.settings.page),
            PageId::Settings => KeyContext::Settings(self.settings.place()),
            PageId::Calibration if self.overlay.is_some() => KeyContext::Calibration(CalibrationContext::Tests),
            PageId::Calibration => KeyContext::Calibration(self.calibration.place()),
        }
    }
}
