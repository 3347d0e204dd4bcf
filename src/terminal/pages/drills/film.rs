//! The filmed shots: their list, and the playback of one of them next to its simulation.

use crate::{
    study::filmed::FilmedShot,
    terminal::{
        FilmReplay,
        pages::moved_index,
        shot::{
            Playback, PlaybackKey,
            film::{ListedShot, listed},
        },
    },
};

/// State of the screens with the filmed shots.
#[derive(Debug, Default)]
pub struct FilmsScreen {
    /// Index of the marked shot in the list.
    pub mark: usize,
    /// Result of fitting the marked shot; `None` until that has finished.
    played: Option<Result<Box<FilmReplay>, String>>,
    /// Playback position and speed of the watched shot.
    pub playback: Playback,
}

impl FilmsScreen {
    /// The marked shot, which is also the watched one.
    pub fn marked(&self) -> Option<&'static ListedShot> {
        listed().get(self.mark)
    }

    /// Moves the mark by `lines`, downwards if positive.
    pub fn move_mark(&mut self, lines: isize) {
        self.mark = moved_index(self.mark, lines, listed().len());
    }

    /// Marks the shot that is `shots` after the marked one, and returns it to be fitted and simulated. Returns `None` if there is no
    /// such shot. Playback starts when the result arrives.
    pub fn select(&mut self, shots: isize) -> Option<FilmedShot> {
        let before = self.mark;
        self.move_mark(shots);
        if shots != 0 && self.mark == before {
            return None;
        }
        self.played = None;
        self.playback.seek(0.0);
        self.marked().map(|listed| listed.filmed.clone())
    }

    /// Handles the result for the shot with this number; drops it if another shot is marked by now.
    ///
    /// # Errors
    /// Returns the message if the shot could not be fitted or simulated.
    pub fn receive(&mut self, number: u32, played: Result<Box<FilmReplay>, String>) -> Result<(), String> {
        if self.played.is_none() && self.marked().is_some_and(|listed| listed.filmed.number == number) {
            let played = self.played.insert(played).as_ref().map_err(String::clone)?;
            self.playback.toggle(played.replay.duration());
        }
        Ok(())
    }

    /// The message why the shot could not be fitted or simulated; `None` if there is no such failure.
    pub fn failure(&self) -> Option<&str> {
        self.played.as_ref()?.as_ref().err().map(String::as_str)
    }

    /// The watched shot; `None` while the stroke is being fitted, or if that has failed.
    pub fn played(&self) -> Option<&FilmReplay> {
        self.played.as_ref()?.as_ref().ok().map(Box::as_ref)
    }

    /// Applies a playback key to the watched shot.
    pub fn apply_playback_key(&mut self, key: PlaybackKey) {
        if let Some(Ok(played)) = &self.played {
            self.playback.apply(key, played.shot.recording.events(), played.replay.duration());
        }
    }

    /// Advances the playback by `seconds`.
    pub fn tick(&mut self, seconds: f64) {
        if let Some(Ok(played)) = &self.played {
            self.playback.tick(seconds, played.replay.duration());
        }
    }
}
