//! The common start of the practice commands: the user's store and the library.

use crate::{
    coach::Skill,
    commands::{Failure, lookup::own_skill, output::print_note},
    drills::{Exercise, Library, LibraryError, Session, Store},
    printing::OneLine,
    storage::{self, DataPaths},
};

/// The user's store, and the library with the user's own positions.
pub struct Workspace {
    pub store: Store,
    pub library: Library,
}

impl Workspace {
    /// Opens the store and reads the library. Unreadable files are reported on the standard error.
    pub fn open() -> Self {
        let paths = DataPaths::of_this_user();
        print_notes(storage::notice(&paths).map(str::to_owned).as_slice());
        let store = Store::new(&paths);
        let (library, notes) = store.library();
        print_notes(&notes);
        Self { store, library }
    }

    /// Returns the exercise that `text` identifies: a name, a title, or the beginning of one.
    pub fn exercise(&self, text: &str) -> Result<&Exercise, Failure> {
        self.library.resolve(text).map_err(|error| match (&error, self.library.most_similar(text)) {
            (LibraryError::Unknown(_), Some(name)) => Failure::failed(format_args!(
                "there is no exercise \"{text}\"; did you mean {name}? carom drill list shows all names"
            )),
            _ => Failure::failed(error),
        })
    }

    /// Returns all sessions. Unreadable files are reported on the standard error.
    pub fn sessions(&self) -> Vec<Session> {
        let found = self.store.sessions();
        print_notes(&found.notes);
        found.items
    }
}

/// Returns the given skill, otherwise the user's own, otherwise an expert's. An unreadable skill file gives a note and an expert's skill.
pub fn skill_or_default(given: Option<Skill>) -> Skill {
    let own = || {
        own_skill().unwrap_or_else(|failure| {
            print_notes(&[failure.to_string()]);
            None
        })
    };
    given.or_else(own).unwrap_or(Skill::EXPERT)
}

/// Prints notes about unreadable files.
pub fn print_notes(notes: &[String]) {
    for sentence in notes {
        print_note(format_args!("note: {}", OneLine(sentence)));
    }
}
