//! Key input: finds the action of a key in the present context, or the reason why it is disabled.

use crossterm::event::{KeyCode, KeyEvent, KeyEventKind, KeyModifiers};

use crate::{
    platform,
    terminal::{
        Action, App, CalibrationContext, CoachCondition, Condition, Effect, KeyContext, PageId, SettingsContext,
        app::{bindings, view},
        ui::Typed,
    },
};

impl App {
    /// Handles a key press.
    pub fn handle(&mut self, key: &KeyEvent) -> Option<Effect> {
        if key.kind == KeyEventKind::Release {
            return None;
        }
        let effect = self.handle_key(key);
        self.collect_toasts(true);
        effect.or_else(|| self.study())
    }

    /// Requests an analysis of the coach's shot if the shot is visible and has none yet: settings changed elsewhere may have brought it
    /// back.
    pub(super) fn study(&mut self) -> Option<Effect> {
        if self.screen == PageId::Coach { self.coach.study() } else { None }
    }

    /// Handles a key with Alt as Esc followed by the key, for contexts in which Alt has no meaning. Terminals send both in the same way:
    /// Esc pressed just before a key can arrive in one piece with it.
    fn handle_as_escape_and_key(&mut self, key: &KeyEvent) -> Option<Effect> {
        let bare = KeyEvent { modifiers: key.modifiers - KeyModifiers::ALT, ..*key };
        let effect = self.handle_key(&KeyEvent::from(KeyCode::Esc));
        effect.or_else(|| self.handle_key(&bare))
    }

    fn handle_key(&mut self, key: &KeyEvent) -> Option<Effect> {
        // Works everywhere, even under an overlay.
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
            self.toasts.dismiss_answers();
            return None;
        }
        // While the page waits for a key to bind, every key is an answer and nothing else.
        let is_recording_key = self.key_context() == KeyContext::Settings(SettingsContext::Pressing);
        let find = |key: &KeyEvent| bindings::find(key, self.key_context(), |when| self.disabled_reason(when));
        // The letters that answer a question always answer it, even if the user has bound them to something else.
        let is_answer = matches!(find(key), Some(Ok(Action::Answer(_))));
        let translated = if is_recording_key || is_answer { *key } else { self.keys().translate(key) };
        let found = find(&translated);
        if is_recording_key && !matches!(found, Some(Ok(Action::Quit | Action::Suspend | Action::Settings(_)))) {
            self.toasts.dismiss_answers();
            let effect = self.settings.on_key_pressed(key);
            self.apply_changed_settings();
            return effect;
        }
        if found.is_none() && key.modifiers.contains(KeyModifiers::ALT) {
            return self.handle_as_escape_and_key(key);
        }
        let is_hidden = || {
            self.key_context() == KeyContext::OwnStroke
                && bindings::find(&translated, KeyContext::Coach, |_| None).is_some()
        };
        let found = found.or_else(|| is_hidden().then_some(Err("Esc leaves your stroke first")))?;
        if translated.code == KeyCode::Esc {
            self.toasts.clear();
            if found.is_err() {
                // If there is nothing to leave, Esc is silent.
                *self.page_mut().message_mut() = None;
                return None;
            }
        }
        self.perform(found)
    }

    /// Performs the action of a key or the mouse, or shows why it is disabled.
    pub(super) fn perform(&mut self, requested: Result<Action, &'static str>) -> Option<Effect> {
        *self.page_mut().message_mut() = None;
        self.toasts.dismiss_answers();
        match requested {
            Ok(action) => self.update(action),
            Err(reason) => {
                if self.overlay.is_some() {
                    // The open overlay may be the list of messages.
                    self.toasts.push_unlisted(reason.to_owned());
                } else {
                    self.toasts.push(reason.to_owned(), true);
                }
                None
            }
        }
    }

    /// Whether the screen is too small to show the effect of a key.
    pub(super) const fn is_too_small(&self) -> bool {
        !self.area.is_empty() && view::is_too_small(self.area)
    }

    /// Handles pasted text.
    pub fn paste(&mut self, text: &str) {
        if self.is_too_small() {
            return;
        }
        if self.input(Typed::Paste(text)) {
            self.toasts.dismiss_answers();
        } else {
            self.toasts.push("pasted text not used: nothing here asks for text".to_owned(), true);
        }
        self.collect_toasts(true);
    }

    /// Passes typed or pasted input to the open text field. Returns `false` if none is open, or if the key has another meaning.
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

    /// Returns why a binding is disabled; `None` if it is enabled.
    pub fn disabled_reason(&self, when: Condition) -> Option<&'static str> {
        match when {
            Condition::Overlay => self.overlay.is_none().then_some("no page lies over the screen"),
            Condition::Tabs => self.is_only_screen().then_some("no other screens here; start carom for all of them"),
            _ if self.overlay.is_some() => Some("close this first: Esc"),
            Condition::Always => None,
            Condition::Shell => self.no_shell(),
            Condition::Coach(CoachCondition::Resumable) if self.exam_to_show().is_some() => {
                self.coach.disabled_reason(CoachCondition::Idle)
            }
            Condition::Coach(when) => self.coach.disabled_reason(when),
            Condition::Training(when) => self.training.disabled_reason(when),
            Condition::Drill(when) => self.drills.disabled_reason(when),
            Condition::Settings(when) => self.settings.disabled_reason(when),
            Condition::Calibration(when) => self.calibration.disabled_reason(when),
        }
    }

    /// Returns why the program cannot be suspended.
    fn no_shell(&self) -> Option<&'static str> {
        if self.is_guest {
            return Some("guests have no shell to go back to; q quits");
        }
        (!platform::CAN_SUSPEND).then_some("programs cannot be suspended here; q quits")
    }

    /// The key context of the screen. The help lists the keys of the context below it.
    pub fn key_context(&self) -> KeyContext {
        if self.command_palette.is_some() { KeyContext::CommandPalette } else { self.page_key_context() }
    }

    /// Like [`Self::key_context`], but ignoring the command palette.
    pub(super) fn page_key_context(&self) -> KeyContext {
        let asked = self.page().open_question(self.caps).filter(|asked| self.overlay.is_none() && !asked.has_own_keys);
        if let Some(asked) = asked {
            return KeyContext::Question { is_typed: asked.field.is_some() };
        }
        match self.screen {
            PageId::Coach if self.coach.followed().is_some() => KeyContext::Follow,
            PageId::Coach if self.coach.what_if().is_some() => KeyContext::OwnStroke,
            PageId::Coach => KeyContext::Coach,
            PageId::Training => KeyContext::Training(self.training.page()),
            PageId::Drills if self.overlay.is_some() => KeyContext::Drill(self.drills.page()),
            PageId::Drills => KeyContext::Drill(self.drills.key_context()),
            PageId::Settings if self.overlay.is_some() => KeyContext::Settings(self.settings.page),
            PageId::Settings => KeyContext::Settings(self.settings.key_context()),
            PageId::Calibration if self.overlay.is_some() => KeyContext::Calibration(CalibrationContext::Tests),
            PageId::Calibration => KeyContext::Calibration(self.calibration.key_context()),
        }
    }
}
