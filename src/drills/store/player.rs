//! The player's own skill, kept in a file of its own.

use std::io;

use serde::{Deserialize, Serialize};

use super::{Store, StoreError};
use crate::{
    coach::Skill,
    drills::{marked, session::now},
    storage::{self, write_atomic},
};

/// What the file says that it is.
const PLAYER: &str = "carom-player";

/// A skill that a player has taken for his own.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct OwnSkill {
    /// The errors.
    pub skill: Skill,
    /// When it was kept, Unix time in seconds.
    pub since: u64,
}

impl Store {
    /// The player's own skill; `None` where none was kept.
    ///
    /// # Errors
    /// Where the file cannot be read.
    pub fn own_skill(&self) -> Result<Option<OwnSkill>, StoreError> {
        let text = storage::read_if_there(&self.player, storage::SMALL);
        let Some(text) = text.map_err(|error| StoreError::file(&self.player, error))? else { return Ok(None) };
        let refuse = |error| StoreError::Mark { path: self.player.clone(), error };
        marked::read(PLAYER, &text).map(Some).map_err(refuse)
    }

    /// Keeps a skill as the player's own.
    ///
    /// # Errors
    /// Where the file cannot be written, or the one that is there cannot be read, as one of a newer version; it is then what
    /// it was.
    pub fn keep_skill(&self, skill: Skill) -> Result<(), StoreError> {
        self.own_skill()?;
        self.write_own(&OwnSkill { skill, since: now() })
    }

    pub(super) fn write_own(&self, own: &OwnSkill) -> Result<(), StoreError> {
        let written = marked::write(PLAYER, own).map_err(io::Error::from);
        let written = written.and_then(|bytes| write_atomic(&self.player, &bytes));
        written.map_err(|error| StoreError::unwritten(&self.player, error))
    }
}
