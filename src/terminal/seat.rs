//! Who sits at the terminal: the user of this account, one of several players who share it, or a guest of a machine that is not
//! theirs.

use std::{io, path::Path};

use super::Settings;
use crate::{
    platform,
    storage::{self, Places, Player},
};

/// Longest time that the coach thinks for a guest, ms: what a player waits for anyway.
pub const LONGEST_FOR_GUESTS: u64 = 1000;

/// Room on the disk that a session needs, bytes: a few files of some kilobytes.
const LEAST_ROOM: u64 = 1 << 18;

/// Whose files are read and written, and what may be done.
#[derive(Clone, Debug)]
pub struct Seat {
    /// The player's name, where they have one.
    pub player: Option<Player>,
    /// Where this player's files are.
    pub places: Places,
    /// Guests start and steer no training, read and write no files but their own, think for a second at most and on one
    /// thread, and have no shell to go back to.
    pub is_guest: bool,
}

impl Seat {
    /// The user's own.
    pub fn of_this_user() -> Self {
        Self { player: None, places: Places::of_this_user(), is_guest: false }
    }

    /// That of a player with a folder of their own.
    ///
    /// # Errors
    /// Where the account has no home.
    pub fn of_player(player: &Player, is_guest: bool) -> io::Result<Self> {
        Ok(Self { player: Some(player.clone()), places: Places::of_player(player)?, is_guest })
    }

    /// Holds this process to what the player may do, for as long as it runs; what somebody else shows in the folder `seen` may
    /// be read too.
    ///
    /// # Errors
    /// Where a guest's folder cannot be made.
    pub fn take(&self, seen: Option<&Path>) -> io::Result<()> {
        if self.is_guest {
            let read: Vec<&Path> = seen.into_iter().chain([&*self.places.runs]).collect();
            storage::confine(&self.places.own, &read)?;
            platform::limit_threads(1);
        }
        Ok(())
    }

    /// The settings as far as the player may have them.
    #[must_use]
    pub fn allowed(&self, settings: Settings) -> Settings {
        if !self.is_guest {
            return settings;
        }
        Settings { think_ms: settings.think_ms.min(LONGEST_FOR_GUESTS), ..settings }
    }

    /// What the player should know before anything is lost: why nothing can be kept.
    pub fn warning(&self) -> Option<String> {
        let folder = &self.places.own;
        let state = storage::folder_state(folder);
        let is_full = state.free.is_some_and(|free| free < LEAST_ROOM);
        let refusal = state.refusal.map(|error| error.to_string());
        let refusal = refusal.or_else(|| is_full.then(|| "the disk is full".to_owned()))?;
        Some(format!("nothing can be kept in {}: {refusal}", folder.display()))
    }
}
