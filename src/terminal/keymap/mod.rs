//! Key tables: the keys, their actions, conditions and descriptions.
//!
//! Each page has its own tables. Key dispatch, the hint line, the help, the command palette and the documentation all read them, so that
//! they cannot disagree.

pub mod chord;
pub mod remap;
mod section;

use crossterm::event::KeyCode;

pub use self::{
    chord::{Chord, keys_text},
    section::Section,
};

/// One row of a key table: keys for actions `A`, enabled under the condition `W`.
#[derive(Debug)]
pub struct Binding<A: 'static, W> {
    /// The keys, each with its action.
    pub keys: &'static [(Chord, A)],
    /// The word in the hint line, and the number of keys shown before it there.
    pub hint: Option<(&'static str, usize)>,
    /// Description in the help.
    pub description: &'static str,
    /// Condition under which it is enabled.
    pub when: W,
    /// Section of the help.
    pub section: Section,
    /// Further search words for the command palette.
    pub search_words: &'static str,
    /// Descriptions of the single actions, in the order of their first keys; empty if the description fits each of them.
    pub each: &'static [&'static str],
}

impl<A, W: Copy> Binding<A, W> {
    /// Adds search `words` for the command palette.
    pub const fn known_as(self, search_words: &'static str) -> Self {
        Self { search_words, ..self }
    }

    /// Adds a description of each action, in the order of their first keys.
    pub const fn each(self, words: &'static [&'static str]) -> Self {
        Self { each: words, ..self }
    }
}

/// Creates a row of a key table.
pub const fn bind<A, W: Copy>(
    section: Section,
    when: W,
    keys: &'static [(Chord, A)],
    hint: Option<(&'static str, usize)>,
    description: &'static str,
) -> Binding<A, W> {
    Binding { keys, hint, description, when, section, search_words: "", each: &[] }
}

/// A key without modifiers.
pub const fn key<A: Copy>(code: KeyCode, action: A) -> (Chord, A) {
    (Chord::plain(code), action)
}

/// A letter or sign.
pub const fn letter<A: Copy>(letter: char, action: A) -> (Chord, A) {
    (Chord::char(letter), action)
}

/// A letter with Ctrl.
pub const fn ctrl<A: Copy>(letter: char, action: A) -> (Chord, A) {
    (Chord::ctrl(KeyCode::Char(letter)), action)
}

/// The first key of `table` that runs `action`.
pub fn chord_of<A: PartialEq, W>(table: &[Binding<A, W>], action: &A) -> Option<Chord> {
    table.iter().flat_map(|binding| binding.keys).find(|(_, known)| known == action).map(|(chord, _)| *chord)
}

/// One command of a page, for lists of keys.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct KeyEntry {
    /// Its default keys.
    pub chords: Vec<Chord>,
    /// Its description.
    pub words: &'static str,
    /// Its section of the help.
    pub section: Section,
}

/// All commands of a page.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct KeyPage {
    /// The page's name.
    pub name: &'static str,
    /// The commands, in the order of the page's tables.
    pub entries: Vec<KeyEntry>,
}

/// All commands that a key has by default on `pages`: the page's name and the description.
pub fn commands_of(pages: &[KeyPage], chord: Chord) -> Vec<(&'static str, &'static str)> {
    let mut commands = Vec::new();
    for page in pages {
        for entry in page.entries.iter().filter(|entry| entry.chords.contains(&chord)) {
            // A command that all pages have is listed once.
            if commands.iter().all(|(_, known)| *known != entry.words) {
                commands.push((page.name, entry.words));
            }
        }
    }
    commands
}

/// The keys that move the selection of a list; `$line` turns a number of lines into an action.
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

/// Descriptions of the actions of [`lines!`] in a list of `$what`.
macro_rules! marks {
    ($what:literal) => {
        &[
            concat!("mark the next ", $what),
            concat!("mark the previous ", $what),
            concat!("go down by ten ", $what, "s"),
            concat!("go up by ten ", $what, "s"),
            concat!("mark the last ", $what),
            concat!("mark the first ", $what),
        ]
    };
}
pub(in crate::terminal) use marks;
