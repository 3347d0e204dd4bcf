//! Export and import of all of a player's practice as one JSON file.

use serde::{Deserialize, Serialize};

use super::{OwnSkill, Store, StoreError, file, position_text, read_position, validate};
use crate::drills::{Attempt, Exercise, Library, LibraryFile, LibraryFileError, Session};

/// All of a player's practice. Its file is a file of exercises with additional fields, so that each can be read as the other.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Practice {
    /// The player's own positions, with the header of the file.
    #[serde(flatten)]
    pub library: LibraryFile,
    /// All sessions.
    #[serde(default)]
    pub sessions: Vec<Session>,
    /// The player's own skill.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub player: Option<OwnSkill>,
}

/// The result of an import.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Imported {
    /// New positions.
    pub positions: usize,
    /// New sessions.
    pub sessions: usize,
    /// Sessions that were replaced by ones with more attempts.
    pub longer: usize,
    /// Items that existed already.
    pub known: usize,
    /// A sentence for everything that was rejected.
    pub refused: Vec<String>,
}

impl Practice {
    /// Parses a text from [`Store::export`], or a file of exercises.
    ///
    /// # Errors
    /// Fails if the text is in another format or in an unsupported version.
    pub fn parse(text: &str) -> Result<Self, LibraryFileError> {
        LibraryFile::parse(text)?;
        Ok(serde_json::from_str(text)?)
    }

    /// Whether a text comes from [`Store::export`]. A mere file of exercises, which may be somebody's work, has no sessions.
    pub fn is_export(text: &str) -> bool {
        let keys: Option<serde_json::Value> = serde_json::from_str(text).ok();
        Self::parse(text).is_ok() && keys.is_some_and(|keys| keys.get("sessions").is_some())
    }
}

impl Store {
    /// Returns all stored data, and a sentence for every unreadable file that is missing from it.
    pub fn export(&self) -> (Practice, Vec<String>) {
        let (positions, mut sessions) = (self.positions(), self.sessions());
        // A session without attempts is not exported.
        sessions.items.retain(|session| !session.attempts.is_empty());
        let mut notes = [positions.notes, sessions.notes].concat();
        let player = self.own_skill().unwrap_or_else(|error| {
            notes.push(error.to_string());
            None
        });
        (Practice { library: LibraryFile::new(positions.items), sessions: sessions.items, player }, notes)
    }

    /// Imports what does not exist yet. An existing session is replaced by a longer one that continues it, and rejected
    /// if both have different new attempts. A position is rejected if another one has its name. The skill is imported
    /// if none is saved.
    /// Nothing is removed, and items that are rejected or cannot be written do not prevent the import of the others.
    pub fn import(&self, practice: &Practice) -> Imported {
        let mut imported = Imported::default();
        for position in &practice.library.exercises {
            let outcome = self.import_position(position);
            imported.note(outcome, |imported| imported.positions += 1);
        }
        for session in &practice.sessions {
            let outcome = self.import_session(session);
            let longer = matches!(outcome, Ok(ImportOutcome::Longer));
            imported.note(outcome, |imported| {
                *(if longer { &mut imported.longer } else { &mut imported.sessions }) += 1;
            });
        }
        if imported.sessions > 0 {
            // Done once: for each session, scanning the growing folder would take more and more time.
            self.remove_abandoned();
        }
        if let Some(own) = &practice.player {
            let kept =
                self.own_skill().and_then(|here| if here.is_none() { self.write_own_skill(own) } else { Ok(()) });
            imported.refused.extend(kept.err().map(|error| error.to_string()));
        }
        imported
    }

    fn import_position(&self, position: &Exercise) -> Result<ImportOutcome, StoreError> {
        match self.save_position(position, false) {
            Err(StoreError::NameTaken(name)) => {
                let here = read_position(&file(&self.positions, &name)?)?;
                // Compared as text, because a number that was written and read is rounded.
                let same =
                    matches!((position_text(&here), position_text(position)), (Ok(here), Ok(there)) if here == there);
                if same { Ok(ImportOutcome::Known) } else { Err(StoreError::NameTaken(name)) }
            }
            // Bundled exercises are already known.
            Err(StoreError::Bundled(name)) if Library::bundled().get(&name) == Ok(position) => Ok(ImportOutcome::Known),
            saved => saved.map(|()| ImportOutcome::New),
        }
    }

    fn import_session(&self, session: &Session) -> Result<ImportOutcome, StoreError> {
        validate(session)?;
        let lock = self.lock()?;
        let outcome = match self.session(&session.id)? {
            None => ImportOutcome::New,
            Some(here) if Attempt::is_prefix(&session.attempts, &here.attempts) => return Ok(ImportOutcome::Known),
            Some(here) if Attempt::is_prefix(&here.attempts, &session.attempts) => ImportOutcome::Longer,
            Some(_) => return Err(StoreError::Diverged(session.id.clone())),
        };
        self.write(&lock, session)?;
        Ok(outcome)
    }
}

/// The result for one item.
enum ImportOutcome {
    New,
    Longer,
    Known,
}

impl Imported {
    fn note(&mut self, outcome: Result<ImportOutcome, StoreError>, count: impl FnOnce(&mut Self)) {
        match outcome {
            Ok(ImportOutcome::Known) => self.known += 1,
            Ok(_) => count(self),
            Err(error) => self.refused.push(error.to_string()),
        }
    }
}
