//! Key bindings of the settings page: one table for each of its screens, and one for the choice of a new key.

use crossterm::event::KeyCode::{Backspace, Delete, Enter, Esc, Left, Right, Tab};

use crate::terminal::keymap::{
    Binding,
    Section::{OwnKeys, Program, Settings},
    bind, key, letter, lines, marks,
};

use SettingsAction as A;
use SettingsCondition as W;

/// Action of a key on the settings page.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SettingsAction {
    /// Returns to the previous page.
    Back,
    /// Moves the mark by lines, downwards if positive.
    MoveMark(isize),
    /// Chooses the next value of the marked setting, or the one before if negative.
    ChangeValue(isize),
    /// Opens the text field for a value.
    TypeValue,
    /// Resets the marked setting or key to its default.
    ResetToDefault,
    /// Switches between settings and keys.
    ToggleKeys,
    /// Lists the keys of another page of the program: the next one if positive, the one before if negative.
    ChooseKeyPage(isize),
    /// Asks for a new key for the marked command.
    AskForKey,
    /// Answers the open question: `true` for yes or the typed text, `false` for no.
    Answer(bool),
}

/// Condition under which a key binding of the settings page is enabled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SettingsCondition {
    /// Always, on the binding's screen.
    Always,
    /// If the marked setting or key differs from its default.
    Changed,
}

/// The key contexts of the settings page.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SettingsContext {
    /// The settings with their values.
    Values,
    /// The commands of the program with their keys.
    Keys,
    /// Waiting for the user to press a new key.
    Pressing,
}

impl SettingsContext {
    /// The key bindings of the context.
    pub const fn bindings(self) -> &'static [Binding<A, W>] {
        match self {
            Self::Values => VALUES,
            Self::Keys => KEYS,
            Self::Pressing => PRESSING,
        }
    }
}

const BACK: Binding<A, W> =
    bind(Program, W::Always, &[key(Esc, A::Back)], Some(("back", 1)), "back to the previous screen");

/// Key bindings of the settings.
#[rustfmt::skip]
pub const VALUES: &[Binding<A, W>] = &[
    bind(Settings, W::Always, &[key(Left, A::ChangeValue(-1)), key(Right, A::ChangeValue(1)), letter('h', A::ChangeValue(-1)), letter('l', A::ChangeValue(1))],
        Some(("change", 2)), "take the previous value, the next value")
        .each(&["take the previous value", "take the next value"]),
    bind(Settings, W::Always, &[key(Enter, A::TypeValue)], Some(("type", 1)), "type a value"),
    bind(Settings, W::Always, lines!(A::MoveMark), Some(("choose", 2)), "mark another setting").each(marks!("setting")),
    bind(Settings, W::Changed, &[key(Delete, A::ResetToDefault), key(Backspace, A::ResetToDefault)], Some(("default", 1)), "back to the default"),
    bind(Settings, W::Always, &[key(Tab, A::ToggleKeys)], Some(("keys", 1)), "to the keys"),
    BACK,
];

/// Key bindings of the list of keys.
#[rustfmt::skip]
pub const KEYS: &[Binding<A, W>] = &[
    bind(OwnKeys, W::Always, &[key(Enter, A::AskForKey)], Some(("new key", 1)), "choose a key for what is marked"),
    bind(OwnKeys, W::Always, &[key(Left, A::ChooseKeyPage(-1)), key(Right, A::ChooseKeyPage(1)), letter('h', A::ChooseKeyPage(-1)), letter('l', A::ChooseKeyPage(1))],
        Some(("page", 2)), "list the keys of another page")
        .each(&["list the keys of the previous page", "list the keys of the next page"]),
    bind(OwnKeys, W::Always, lines!(A::MoveMark), Some(("choose", 2)), "mark something else").each(marks!("line")),
    bind(OwnKeys, W::Changed, &[key(Delete, A::ResetToDefault), key(Backspace, A::ResetToDefault)], Some(("default", 1)), "back to the default keys"),
    bind(OwnKeys, W::Always, &[key(Tab, A::ToggleKeys)], Some(("settings", 1)), "to the settings"),
    BACK,
];

/// Key bindings while the user chooses a new key.
#[rustfmt::skip]
pub const PRESSING: &[Binding<A, W>] = &[
    bind(OwnKeys, W::Always, &[key(Esc, A::Answer(false))], Some(("cancel", 1)), "leave all as it is"),
];
