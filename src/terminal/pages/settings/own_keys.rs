//! State of the list of key bindings: the commands of each page of the program, and the change of their keys.

use crossterm::event::KeyCode::{Char, Down, Enter, Esc, F, Tab, Up};

use crate::terminal::{
    Change, Keys,
    keymap::{
        Chord, KeyEntry, KeyPage, commands_of,
        remap::{chord as chord_named, name},
    },
    pages::{moved_index, wrapping_index},
};

/// The list of key bindings, with its marked command.
#[derive(Debug)]
pub struct OwnKeys {
    pages: Vec<KeyPage>,
    /// Index in `pages` of the page whose keys are listed.
    page: usize,
    /// Index of the marked command.
    pub mark: usize,
}

impl OwnKeys {
    /// Creates the list of the keys of `pages`, sorted like the help.
    pub fn new(mut pages: Vec<KeyPage>) -> Self {
        for page in &mut pages {
            page.entries.sort_by_key(|entry| entry.section as usize);
        }
        Self { pages, page: 0, mark: 0 }
    }

    /// The page whose keys are listed.
    pub fn page(&self) -> &KeyPage {
        &self.pages[self.page]
    }

    /// The marked command.
    pub fn marked(&self) -> Option<&KeyEntry> {
        self.page().entries.get(self.mark)
    }

    /// Moves the mark by `lines`, downwards if positive.
    pub fn move_mark(&mut self, lines: isize) {
        self.mark = moved_index(self.mark, lines, self.page().entries.len());
    }

    /// Cycles through the pages whose keys are listed, forwards if positive.
    pub fn choose_page(&mut self, pages: isize) {
        self.page = wrapping_index(self.page, pages, self.pages.len());
        self.mark = 0;
    }

    /// The default keys of the marked command.
    fn chords(&self) -> &[Chord] {
        self.marked().map_or(&[], |entry| &entry.chords)
    }

    /// Whether the keys of the marked command differ from the default.
    pub fn is_changed(&self, keys: &Keys) -> bool {
        !keys.about(self.chords()).is_empty()
    }

    /// All commands of the marked command's first key, on all pages. A key that replaces it gets all of them.
    pub fn commands(&self) -> Vec<(&'static str, &'static str)> {
        self.chords().first().map_or_else(Vec::new, |chord| commands_of(&self.pages, *chord))
    }

    /// The commands of the key `pressed` that it would lose as a new key of the marked command.
    pub fn other_commands(&self, pressed: Chord, keys: &Keys) -> Vec<(&'static str, &'static str)> {
        let own = self.commands();
        let commands = commands_of(&self.pages, keys.target_of(pressed).unwrap_or(pressed));
        commands.into_iter().filter(|command| !own.contains(command)).collect()
    }

    /// Checks whether `pressed` can become a key of the marked command, and returns it.
    ///
    /// # Errors
    /// Returns a message with the reason if it cannot.
    pub fn check(&self, pressed: Chord, keys: &Keys) -> Result<Chord, String> {
        let written = name(pressed);
        let event = pressed.event();
        let is_needed = event.modifiers.is_empty() && matches!(event.code, Enter | Esc | Up | Down | Tab | F(5));
        if chord_named(&written) != Some(pressed) {
            return Err(
                "this key has no name in the settings; accepted are letters, signs, named keys like Home, F1 to \
                        F12, also with Ctrl or Shift"
                    .to_owned(),
            );
        }
        if is_needed || matches!(event.code, Char('c' | 'z')) && pressed == Chord::ctrl(event.code) {
            return Err(format!("{written} cannot be changed: it may be the only way back; press another key"));
        }
        let chords = self.chords();
        let Some(first) = chords.first() else { return Err("nothing is marked".to_owned()) };
        let does_it = keys.target_of(pressed).map_or(chords.contains(&pressed), |meant| meant == *first);
        if does_it { Err(format!("{written} does this already")) } else { Ok(pressed) }
    }

    /// Makes `pressed` a key of the marked command.
    pub fn assign(&self, pressed: Chord, keys: &mut Keys) -> Change {
        keys.remove(pressed);
        let chords = self.chords();
        let added = chords.first().filter(|_| !chords.contains(&pressed)).map(|meant| (pressed, *meant));
        if let Some((pressed, meant)) = added {
            keys.add(pressed, meant);
        }
        Change::Keys(vec![pressed], added)
    }

    /// Restores the default keys of the marked command.
    pub fn reset(&self, keys: &mut Keys) -> Change {
        let gone = keys.about(self.chords());
        for pressed in &gone {
            keys.remove(*pressed);
        }
        Change::Keys(gone, None)
    }
}
