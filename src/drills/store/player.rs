//! The player's own skill, stored in a file of its own.

use std::io;

use serde::{Deserialize, Serialize};

use super::{Store, StoreError};
use crate::{
    coach::Skill,
    drills::{header, session::now},
    storage::{self, write_atomic},
};

/// The format's name in the file.
const PLAYER: &str = "carom-player";

/// A skill that the player has saved as their own.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct OwnSkill {
    /// The skill.
    pub skill: Skill,
    /// When it was saved, Unix time in seconds.
    pub since: u64,
}

impl Store {
    /// Reads the player's own skill; `None` if none is saved.
    ///
    /// # Errors
    /// Fails if the file cannot be read.
    pub fn own_skill(&self) -> Result<Option<OwnSkill>, StoreError> {
        let text = storage::read_if_exists(&self.player, storage::MAX_SMALL_FILE);
        let Some(text) = text.map_err(|error| StoreError::file(&self.player, error))? else { return Ok(None) };
        let refuse = |error| StoreError::Header { path: self.player.clone(), error };
        header::read(PLAYER, &text).map(Some).map_err(refuse)
    }

    /// Saves a skill as the player's own.
    ///
    /// # Errors
    /// Fails if the file cannot be written, or an existing one cannot be read, for example because its version is
    /// newer. It is then unchanged.
    pub fn save_skill(&self, skill: Skill) -> Result<(), StoreError> {
        self.own_skill()?;
        self.write_own_skill(&OwnSkill { skill, since: now() })
    }

    pub(super) fn write_own_skill(&self, own: &OwnSkill) -> Result<(), StoreError> {
        let written = header::write(PLAYER, own).map_err(io::Error::from);
        let written = written.and_then(|bytes| write_atomic(&self.player, &bytes));
        written.map_err(|error| StoreError::unwritten(&self.player, error))
    }
}
