//! The keys of the command palette.

use crossterm::event::KeyCode::{Down, Enter, Esc, PageDown, PageUp, Up};

use super::bindings::{Action, Condition};
use crate::terminal::keymap::{Binding, Chord, Section::Program, bind, ctrl, letter};

use PaletteAction as A;

/// What a key does in the command palette.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PaletteAction {
    /// Opens it.
    Open,
    /// Closes it.
    Close,
    /// Does what is marked.
    Choose,
    /// Moves the mark by lines, down where positive.
    Line(isize),
}

const fn key(code: crossterm::event::KeyCode, action: A) -> (Chord, Action) {
    (Chord::plain(code), Action::CommandPalette(action))
}

/// What opens it, wherever letters are not typed.
pub const OPEN: Binding<Action, Condition> = bind(
    Program,
    Condition::Always,
    &[letter(':', Action::CommandPalette(A::Open)), ctrl('p', Action::CommandPalette(A::Open))],
    Some(("commands", 1)),
    "open the command palette: find and run a command",
);

/// The keys while it is open.
#[rustfmt::skip]
pub const PALETTE: &[Binding<Action, Condition>] = &[
    bind(Program, Condition::Always, &[key(Enter, A::Choose)], Some(("do it", 1)), "do what is marked"),
    bind(Program, Condition::Always, &[key(Down, A::Line(1)), key(Up, A::Line(-1)), key(PageDown, A::Line(10)), key(PageUp, A::Line(-10))],
        Some(("choose", 2)), "mark another command")
        .each(&["mark the next command", "mark the command before", "go down by ten commands", "go up by ten commands"]),
    bind(Program, Condition::Always, &[key(Esc, A::Close)], Some(("close", 1)), "close the list"),
];
