//! The player at the terminal: the user of this account, one of several players who share it, or a guest.

use std::{io, path::Path};

use super::Settings;
use crate::{
    platform,
    storage::{self, DataPaths, Player},
};

/// Longest thinking time of the coach for a guest, ms: short enough that nobody minds the wait.
pub const MAX_GUEST_THINK_MS: u64 = 1000;

/// Disk space that a session needs, bytes: a few files of some kilobytes.
const MIN_FREE_SPACE: u64 = 1 << 18;

/// The player, the location of their files, and what they may do.
#[derive(Clone, Debug)]
pub struct Seat {
    /// The player's name, or `None` for the user of the account.
    pub player: Option<Player>,
    /// Where this player's files are.
    pub paths: DataPaths,
    /// Whether the player is a guest. Guests cannot start or control training, read and write only their own files, are limited to one
    /// second of thinking on one thread, and cannot suspend the program to a shell.
    pub is_guest: bool,
}

impl Seat {
    /// The seat of the account's user.
    pub fn of_this_user() -> Self {
        Self { player: None, paths: DataPaths::of_this_user(), is_guest: false }
    }

    /// The seat of a player with their own folder.
    ///
    /// # Errors
    /// Fails if the account has no home directory.
    pub fn of_player(player: &Player, is_guest: bool) -> io::Result<Self> {
        Ok(Self { player: Some(player.clone()), paths: DataPaths::of_player(player)?, is_guest })
    }

    /// Restricts this process to what the player may do, until it ends. The folder `followed`, where another player shares a table, may be
    /// read too.
    ///
    /// # Errors
    /// Fails if a guest's folder cannot be created.
    pub fn confine_process(&self, followed: Option<&Path>) -> io::Result<()> {
        if self.is_guest {
            let read: Vec<&Path> = followed.into_iter().chain([&*self.paths.runs]).collect();
            storage::confine(&self.paths.root, &read)?;
            platform::limit_threads(1);
        }
        Ok(())
    }

    /// Returns the settings, reduced to what the player may use.
    #[must_use]
    pub fn restrict_settings(&self, settings: Settings) -> Settings {
        if !self.is_guest {
            return settings;
        }
        Settings { think_ms: settings.think_ms.min(MAX_GUEST_THINK_MS), ..settings }
    }

    /// Returns a warning if nothing can be saved in the player's folder, with the reason.
    pub fn warning(&self) -> Option<String> {
        let folder = &self.paths.root;
        let state = storage::folder_state(folder);
        let is_full = state.free.is_some_and(|free| free < MIN_FREE_SPACE);
        let refusal = state.refusal.map(|error| error.to_string());
        let refusal = refusal.or_else(|| is_full.then(|| "the disk is nearly full".to_owned()))?;
        Some(format!("nothing can be saved in {}: {refusal}", folder.display()))
    }
}
