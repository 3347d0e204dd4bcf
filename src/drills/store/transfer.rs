//! All of a player's practice as one JSON file, and back.

use serde::{Deserialize, Serialize};

use super::{OwnSkill, Store, StoreError, file, position_text, read_position, validate};
use crate::drills::{Attempt, Exercise, Library, LibraryFile, LibraryFileError, Session};

/// All of a player's practice. Its file is one of exercises that holds more, so that one takes the other's place.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Practice {
    /// The player's own positions, with the marks of the file.
    #[serde(flatten)]
    pub library: LibraryFile,
    /// All sessions.
    #[serde(default)]
    pub sessions: Vec<Session>,
    /// The player's own skill.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub player: Option<OwnSkill>,
}

/// What became of a file that was imported.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Imported {
    /// Positions that are new.
    pub positions: usize,
    /// Sessions that are new.
    pub sessions: usize,
    /// Sessions that were there with the first of their attempts.
    pub longer: usize,
    /// What was there already.
    pub known: usize,
    /// A sentence for everything that was refused.
    pub refused: Vec<String>,
}

impl Practice {
    /// Reads a file's text: that of [`Store::export`], or a file of exercises.
    ///
    /// # Errors
    /// Where it is something else or of a version that is not understood.
    pub fn parse(text: &str) -> Result<Self, LibraryFileError> {
        LibraryFile::parse(text)?;
        Ok(serde_json::from_str(text)?)
    }

    /// Whether a file's text is what [`Store::export`] gave: a library of exercises, which may be somebody's work, has no sessions.
    pub fn is_export(text: &str) -> bool {
        let keys: Option<serde_json::Value> = serde_json::from_str(text).ok();
        Self::parse(text).is_ok() && keys.is_some_and(|keys| keys.get("sessions").is_some())
    }
}

impl Store {
    /// All that is kept, and a sentence for every file that cannot be read and is missing.
    pub fn export(&self) -> (Practice, Vec<String>) {
        let (positions, mut sessions) = (self.positions(), self.sessions());
        // One whose attempts were all taken back is none.
        sessions.items.retain(|session| !session.attempts.is_empty());
        let mut notes = [positions.notes, sessions.notes].concat();
        let player = self.own_skill().unwrap_or_else(|error| {
            notes.push(error.to_string());
            None
        });
        (Practice { library: LibraryFile::new(positions.items), sessions: sessions.items, player }, notes)
    }

    /// Takes in what is not here yet. A session that is on both sides is replaced by one that goes on with it, and refused where
    /// both have attempts that the other has not; a position whose name is that of another is refused; a skill is taken where
    /// there is none. Nothing is removed, and what is refused or cannot be written does not keep the rest out.
    pub fn import(&self, practice: &Practice) -> Imported {
        let mut imported = Imported::default();
        for position in &practice.library.exercises {
            let taken = self.import_position(position);
            imported.note(taken, |imported| imported.positions += 1);
        }
        for session in &practice.sessions {
            let taken = self.import_session(session);
            let longer = matches!(taken, Ok(Taken::Longer));
            imported.note(taken, |imported| {
                *(if longer { &mut imported.longer } else { &mut imported.sessions }) += 1;
            });
        }
        if imported.sessions > 0 {
            // Once: a look at the folder for each session would take ever longer.
            self.remove_leavings();
        }
        if let Some(own) = &practice.player {
            let kept = self.own_skill().and_then(|here| if here.is_none() { self.write_own(own) } else { Ok(()) });
            imported.refused.extend(kept.err().map(|error| error.to_string()));
        }
        imported
    }

    fn import_position(&self, position: &Exercise) -> Result<Taken, StoreError> {
        match self.save_position(position, false) {
            Err(StoreError::Taken(name)) => {
                let here = read_position(&file(&self.positions, &name)?)?;
                // As text: a number that was written and read has been rounded.
                let same =
                    matches!((position_text(&here), position_text(position)), (Ok(here), Ok(there)) if here == there);
                if same { Ok(Taken::Known) } else { Err(StoreError::Taken(name)) }
            }
            // A library that comes with the program brings nothing new.
            Err(StoreError::Bundled(name)) if Self::is_bundled_as(&name, position) => Ok(Taken::Known),
            saved => saved.map(|()| Taken::New),
        }
    }

    fn is_bundled_as(name: &str, position: &Exercise) -> bool {
        Library::bundled().get(name) == Ok(position)
    }

    fn import_session(&self, session: &Session) -> Result<Taken, StoreError> {
        validate(session)?;
        let lock = self.lock()?;
        let taken = match self.session(&session.id)? {
            None => Taken::New,
            Some(here) if Attempt::is_prefix(&session.attempts, &here.attempts) => return Ok(Taken::Known),
            Some(here) if Attempt::is_prefix(&here.attempts, &session.attempts) => Taken::Longer,
            Some(_) => return Err(StoreError::Diverged(session.id.clone())),
        };
        self.write(&lock, session)?;
        Ok(taken)
    }
}

/// What became of one thing.
enum Taken {
    New,
    Longer,
    Known,
}

impl Imported {
    fn note(&mut self, taken: Result<Taken, StoreError>, count: impl FnOnce(&mut Self)) {
        match taken {
            Ok(Taken::Known) => self.known += 1,
            Ok(_) => count(self),
            Err(error) => self.refused.push(error.to_string()),
        }
    }
}
