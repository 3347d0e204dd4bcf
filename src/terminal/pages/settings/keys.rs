//! The keys of the settings, a table for each page, and for a key that is asked for.

use crossterm::event::KeyCode::{Backspace, Delete, Enter, Esc, Left, Right, Tab};

use crate::terminal::keymap::{
    Binding,
    Section::{OwnKeys, Program, Settings},
    bind, key, letter, lines, marks,
};

use SettingsAction as A;
use SettingsCondition as W;

/// What a key does on the settings' screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SettingsAction {
    /// Goes back to the screen before.
    Back,
    /// Moves the mark by lines, down where positive.
    Line(isize),
    /// Takes the next value of the marked setting, or the one before.
    Value(isize),
    /// Begins to type a value.
    Type,
    /// Goes back to the default of what is marked.
    Default,
    /// Goes to the other page.
    Turn,
    /// Lists the keys of another place, the next where positive.
    ChooseKeyPage(isize),
    /// Asks for another key for what is marked.
    Press,
    /// Answers what is asked: yes, or what was typed; or no.
    Answer(bool),
}

/// When a binding of the settings may be used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SettingsCondition {
    /// On its page.
    Always,
    /// Where what is marked is not as by default.
    Changed,
}

/// What is on the screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SettingsContext {
    /// The settings with their values.
    Values,
    /// What can be done, and the keys that do it.
    Keys,
    /// A key that is to be pressed.
    Pressing,
}

impl SettingsContext {
    /// Its keys.
    pub const fn bindings(self) -> &'static [Binding<A, W>] {
        match self {
            Self::Values => VALUES,
            Self::Keys => KEYS,
            Self::Pressing => PRESSING,
        }
    }
}

const BACK: Binding<A, W> =
    bind(Program, W::Always, &[key(Esc, A::Back)], Some(("back", 1)), "back to the screen before");

/// The settings.
#[rustfmt::skip]
pub const VALUES: &[Binding<A, W>] = &[
    bind(Settings, W::Always, &[key(Left, A::Value(-1)), key(Right, A::Value(1)), letter('h', A::Value(-1)), letter('l', A::Value(1))],
        Some(("change", 2)), "take the value before, the next value")
        .each(&["take the value before", "take the next value"]),
    bind(Settings, W::Always, &[key(Enter, A::Type)], Some(("type", 1)), "type a value"),
    bind(Settings, W::Always, lines!(A::Line), Some(("choose", 2)), "mark another setting").each(marks!("setting")),
    bind(Settings, W::Changed, &[key(Delete, A::Default), key(Backspace, A::Default)], Some(("default", 1)), "back to the default"),
    bind(Settings, W::Always, &[key(Tab, A::Turn)], Some(("keys", 1)), "to the keys"),
    BACK,
];

/// The keys.
#[rustfmt::skip]
pub const KEYS: &[Binding<A, W>] = &[
    bind(OwnKeys, W::Always, &[key(Enter, A::Press)], Some(("new key", 1)), "choose a key for what is marked"),
    bind(OwnKeys, W::Always, &[key(Left, A::ChooseKeyPage(-1)), key(Right, A::ChooseKeyPage(1)), letter('h', A::ChooseKeyPage(-1)), letter('l', A::ChooseKeyPage(1))],
        Some(("page", 2)), "list the keys of another page")
        .each(&["list the keys of the page before", "list the keys of the next page"]),
    bind(OwnKeys, W::Always, lines!(A::Line), Some(("choose", 2)), "mark something else").each(marks!("line")),
    bind(OwnKeys, W::Changed, &[key(Delete, A::Default), key(Backspace, A::Default)], Some(("default", 1)), "back to the keys that it has by default"),
    bind(OwnKeys, W::Always, &[key(Tab, A::Turn)], Some(("settings", 1)), "to the settings"),
    BACK,
];

/// A key that is to be pressed.
#[rustfmt::skip]
pub const PRESSING: &[Binding<A, W>] = &[
    bind(OwnKeys, W::Always, &[key(Esc, A::Answer(false))], Some(("cancel", 1)), "leave all as it is"),
];
