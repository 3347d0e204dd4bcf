//! The keys of the filmed shots: their list, and the one that is watched.

use crossterm::event::KeyCode::{Down, End, Enter, Esc, Home, Left, PageDown, PageUp, Right, Up};

use super::{
    Action, Binding, CoachWhen, DrillAction as A,
    DrillWhen::{self, Filmed, Here},
    Section::{self, Film, Program},
    When, entry,
};
use crate::terminal::chord::Chord;

const fn bind(
    section: Section,
    when: DrillWhen,
    keys: &'static [(Chord, Action)],
    hint: Option<(&'static str, usize)>,
    description: &'static str,
) -> Binding {
    entry(section, When::Drill(when), keys, hint, description)
}

const WATCH: &str = "filmed shots: watch real balls beside simulated ones";

/// Opens the list from the coach.
pub const OPEN: Binding =
    entry(Program, When::Coach(CoachWhen::Anytime), &[(Chord::char('f'), Action::OpenFilms)], None, WATCH);

/// Opens it from the library.
pub const OPEN_HERE: Binding = bind(Film, Here, &[(Chord::char('f'), Action::OpenFilms)], Some(("film", 1)), WATCH);

const fn key(code: crossterm::event::KeyCode, action: A) -> (Chord, Action) {
    (Chord::plain(code), Action::Drill(action))
}

const fn letter(letter: char, action: A) -> (Chord, Action) {
    (Chord::char(letter), Action::Drill(action))
}

const BACK: Binding = bind(Program, Here, &[key(Esc, A::Back)], Some(("back", 1)), "back to the page before");

/// The list.
#[rustfmt::skip]
pub const FILMS: &[Binding] = &[
    bind(Film, Here, &[key(Enter, A::Open)], Some(("watch", 1)), "watch the marked shot"),
    bind(Film, Here, &[
        key(Down, A::Line(1)), key(Up, A::Line(-1)), letter('j', A::Line(1)), letter('k', A::Line(-1)),
        key(PageDown, A::Line(10)), key(PageUp, A::Line(-10)), key(End, A::Line(isize::MAX)), key(Home, A::Line(isize::MIN)),
        ], Some(("choose", 2)), "mark another shot"),
    BACK,
];

/// A shot.
#[rustfmt::skip]
pub const FILM: &[Binding] = &[
    bind(Film, Filmed, &[letter(' ', A::PlayPause)], Some(("play", 1)), "play and pause the shot"),
    bind(Film, Filmed, &[letter(',', A::Event(-1)), letter('.', A::Event(1)), key(Left, A::Event(-1)),
        key(Right, A::Event(1))], Some(("event", 2)), "step from event to event"),
    bind(Film, Filmed, &[letter('-', A::Pace(-1)), letter('+', A::Pace(1)), letter('=', A::Pace(1)),
        key(Down, A::Pace(-1)), key(Up, A::Pace(1))], Some(("speed", 2)), "play slower or faster"),
    bind(Film, Here, &[letter('[', A::Filmed(-1)), letter(']', A::Filmed(1))], Some(("other shot", 2)),
        "watch the shot before, the next shot"),
    BACK,
];
