//! The keys of the command palette.

use crossterm::event::KeyCode::{self, Backspace, Down, End, Enter, Esc, Home, PageDown, PageUp, Up};

use super::{Action, Binding, Section::Program, When, entry};
use crate::terminal::chord::Chord;

/// What a key does in the command palette.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FinderAction {
    /// Opens it.
    Open,
    /// Closes it.
    Close,
    /// Does what is marked.
    Choose,
    /// Moves the mark by lines, down where positive.
    Line(isize),
    /// Takes the last letter back.
    Erase,
}

const fn bind(
    keys: &'static [(Chord, Action)],
    hint: Option<(&'static str, usize)>,
    description: &'static str,
) -> Binding {
    entry(Program, When::Always, keys, hint, description)
}

const fn key(code: KeyCode, action: FinderAction) -> (Chord, Action) {
    (Chord::plain(code), Action::Finder(action))
}

use FinderAction as A;

/// What opens it, wherever letters are not typed.
pub const OPEN: Binding = bind(
    &[(Chord::char(':'), Action::Finder(A::Open)), (Chord::ctrl(KeyCode::Char('p')), Action::Finder(A::Open))],
    Some(("commands", 1)),
    "find what can be done here by its words, and do it",
);

/// The keys while it is open.
#[rustfmt::skip]
pub const FINDER: &[Binding] = &[
    bind(&[key(Enter, A::Choose)], Some(("do it", 1)), "do what is marked"),
    bind(&[key(Down, A::Line(1)), key(Up, A::Line(-1)), key(PageDown, A::Line(10)), key(PageUp, A::Line(-10)),
        key(End, A::Line(isize::MAX)), key(Home, A::Line(isize::MIN))], Some(("choose", 2)), "mark another command"),
    bind(&[key(Backspace, A::Erase)], None, "take a letter back"),
    bind(&[key(Esc, A::Close)], Some(("close", 1)), "close the list"),
];
