//! The keys of the filmed shots: their list, and the one that is watched.

use crossterm::event::KeyCode::{Down, End, Enter, Esc, Home, Left, PageDown, PageUp, Right, Up};

use super::keys::{
    DrillAction as A,
    DrillCondition::{self, Filmed, Here},
};
use crate::terminal::keymap::{
    Binding,
    Section::{Film, Program},
    bind, key, letter,
};

const BACK: Binding<A, DrillCondition> =
    bind(Program, Here, &[key(Esc, A::Back)], Some(("back", 1)), "back to the page before");

/// The list.
#[rustfmt::skip]
pub const FILMS: &[Binding<A, DrillCondition>] = &[
    bind(Film, Here, &[key(Enter, A::Open)], Some(("watch", 1)), "watch the marked shot"),
    bind(Film, Here, &[
        key(Down, A::Line(1)), key(Up, A::Line(-1)), letter('j', A::Line(1)), letter('k', A::Line(-1)),
        key(PageDown, A::Line(10)), key(PageUp, A::Line(-10)), key(End, A::Line(isize::MAX)), key(Home, A::Line(isize::MIN)),
        ], Some(("choose", 2)), "mark another shot"),
    BACK,
];

/// A shot.
#[rustfmt::skip]
pub const FILM: &[Binding<A, DrillCondition>] = &[
    bind(Film, Filmed, &[letter(' ', A::PlayPause)], Some(("play", 1)), "play and pause the shot"),
    bind(Film, Filmed, &[letter(',', A::Event(-1)), letter('.', A::Event(1)), key(Left, A::Event(-1)),
        key(Right, A::Event(1))], Some(("event", 2)), "step from event to event"),
    bind(Film, Filmed, &[letter('-', A::Pace(-1)), letter('+', A::Pace(1)), letter('=', A::Pace(1)),
        key(Down, A::Pace(-1)), key(Up, A::Pace(1))], Some(("speed", 2)), "play slower or faster"),
    bind(Film, Here, &[letter('[', A::Filmed(-1)), letter(']', A::Filmed(1))], Some(("other shot", 2)),
        "watch the shot before, the next shot"),
    BACK,
];
