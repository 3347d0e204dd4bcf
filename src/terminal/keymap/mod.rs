//! Tables of keys: what each key does, when it may be used, and what is said of it.
//!
//! Each page has tables of its own. Dispatch, the hint line, the help, the command palette and the documentation all read
//! them, so that they cannot disagree.

pub mod chord;
pub mod remap;
mod section;

use crossterm::event::KeyCode;

pub use self::{
    chord::{Chord, keys_text},
    section::Section,
};

/// One line of a table: keys that do `A`, at times that `W` names.
#[derive(Debug)]
pub struct Binding<A: 'static, W> {
    /// The keys, each with what it does.
    pub keys: &'static [(Chord, A)],
    /// Its word in the hint line, and how many of the keys stand before it there.
    pub hint: Option<(&'static str, usize)>,
    /// What the help says.
    pub description: &'static str,
    /// When it may be used.
    pub when: W,
    /// Its heading in the help.
    pub section: Section,
    /// Other words under which the command palette finds it.
    pub also: &'static str,
    /// What its actions do one by one, in the order of their first keys; empty where the description says it of each.
    pub each: &'static [&'static str],
}

impl<A, W: Copy> Binding<A, W> {
    /// The same line, which the command palette finds by these `words` as well.
    pub const fn known_as(self, also: &'static str) -> Self {
        Self { also, ..self }
    }

    /// The same line with `words` for each of its actions, in the order of their first keys.
    pub const fn each(self, words: &'static [&'static str]) -> Self {
        Self { each: words, ..self }
    }
}

/// A line of a table.
pub const fn bind<A, W: Copy>(
    section: Section,
    when: W,
    keys: &'static [(Chord, A)],
    hint: Option<(&'static str, usize)>,
    description: &'static str,
) -> Binding<A, W> {
    Binding { keys, hint, description, when, section, also: "", each: &[] }
}

/// A key without modifiers.
pub const fn key<A: Copy>(code: KeyCode, action: A) -> (Chord, A) {
    (Chord::plain(code), action)
}

/// A letter or a sign.
pub const fn letter<A: Copy>(letter: char, action: A) -> (Chord, A) {
    (Chord::char(letter), action)
}

/// A letter with Ctrl.
pub const fn ctrl<A: Copy>(letter: char, action: A) -> (Chord, A) {
    (Chord::ctrl(KeyCode::Char(letter)), action)
}

/// The first key of `table` that does `action`.
pub fn chord_of<A: PartialEq, W>(table: &[Binding<A, W>], action: &A) -> Option<Chord> {
    table.iter().flat_map(|binding| binding.keys).find(|(_, known)| known == action).map(|(chord, _)| *chord)
}

/// One thing that keys do on a page, as lists of keys show it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct KeyEntry {
    /// The keys that it has by default.
    pub chords: Vec<Chord>,
    /// What it does.
    pub words: &'static str,
    /// Its heading in the help.
    pub section: Section,
}

/// All that keys do on a page of the program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct KeyPage {
    /// The page's name.
    pub name: &'static str,
    /// What they do, in the order of the page's table.
    pub entries: Vec<KeyEntry>,
}

/// Everything that a key does by default on any of `pages`: the page's name and what it does there.
pub fn commands_of(pages: &[KeyPage], chord: Chord) -> Vec<(&'static str, &'static str)> {
    let mut commands = Vec::new();
    for page in pages {
        for entry in page.entries.iter().filter(|entry| entry.chords.contains(&chord)) {
            // What all pages have is listed once.
            if commands.iter().all(|(_, known)| *known != entry.words) {
                commands.push((page.name, entry.words));
            }
        }
    }
    commands
}

/// The keys that mark another line of a list; `$line` makes the number of lines an action.
macro_rules! lines {
    ($line:path) => {{
        use crossterm::event::KeyCode::{Down, End, Home, PageDown, PageUp, Up};
        &[
            key(Down, $line(1)),
            key(Up, $line(-1)),
            letter('j', $line(1)),
            letter('k', $line(-1)),
            key(PageDown, $line(10)),
            key(PageUp, $line(-10)),
            key(End, $line(isize::MAX)),
            key(Home, $line(isize::MIN)),
        ]
    }};
}
pub(in crate::terminal) use lines;

/// What each of [`lines!`] does in a list of `$what`.
macro_rules! marks {
    ($what:literal) => {
        &[
            concat!("mark the next ", $what),
            concat!("mark the ", $what, " before"),
            concat!("go down by ten ", $what, "s"),
            concat!("go up by ten ", $what, "s"),
            concat!("mark the last ", $what),
            concat!("mark the first ", $what),
        ]
    };
}
pub(in crate::terminal) use marks;
