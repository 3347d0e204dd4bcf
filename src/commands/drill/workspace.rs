//! What every practice command starts from: the user's store and the library.

use crate::{
    coach::Skill,
    commands::{Failure, lookup::own_skill, output::tell},
    drills::{Exercise, Library, LibraryError, Session, Store},
    printing::OneLine,
    storage::{self, Places},
};

/// The user's store and the library with the user's own positions.
pub struct Workspace {
    pub store: Store,
    pub library: Library,
}

impl Workspace {
    /// Reads the library; files that cannot be read are named on the standard error.
    pub fn open() -> Self {
        let places = Places::of_this_user();
        note(storage::notice(&places).map(str::to_owned).as_slice());
        let store = Store::new(&places);
        let (library, notes) = store.library();
        note(&notes);
        Self { store, library }
    }

    /// The exercise that is meant by `text`: a name, a title, or the beginning of one.
    pub fn exercise(&self, text: &str) -> Result<&Exercise, Failure> {
        self.library.called(text).map_err(|error| match (&error, self.library.like(text)) {
            (LibraryError::Unknown(_), Some(name)) => Failure::failed(format_args!(
                "there is no exercise \"{text}\"; did you mean {name}? carom drill list shows all names"
            )),
            _ => Failure::failed(error),
        })
    }

    /// All sessions; files that cannot be read are named on the standard error.
    pub fn sessions(&self) -> Vec<Session> {
        let found = self.store.sessions();
        note(&found.notes);
        found.items
    }
}

/// The skill that was given, else the user's own, else an expert's: also where the user's own cannot be read, with a warning.
pub fn player(given: Option<Skill>) -> Skill {
    let own = || {
        own_skill().unwrap_or_else(|failure| {
            note(&[failure.to_string()]);
            None
        })
    };
    given.or_else(own).unwrap_or(Skill::EXPERT)
}

/// Tells what could not be read.
pub fn note(notes: &[String]) {
    for sentence in notes {
        tell(format_args!("note: {}", OneLine(sentence)));
    }
}
