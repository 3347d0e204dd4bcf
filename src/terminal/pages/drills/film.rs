//! The filmed shots: their list, and the one that is watched beside its simulation.

use crate::{
    study::filmed::FilmedShot,
    terminal::{
        FilmReplay,
        shot::{
            Playback, PlaybackKey,
            film::{Listed, listed},
        },
    },
};

/// The filmed shots on the screen.
#[derive(Debug, Default)]
pub struct FilmsScreen {
    /// Place of the marked shot in the list.
    pub mark: usize,
    /// What came of fitting the marked shot, once that is known.
    played: Option<Result<Box<FilmReplay>, String>>,
    /// The clock of the shot that is watched.
    pub playback: Playback,
}

impl FilmsScreen {
    /// The marked shot, which is the one that is watched.
    pub fn marked(&self) -> Option<&'static Listed> {
        listed().get(self.mark)
    }

    /// Moves the mark by lines, down where positive.
    pub fn move_mark(&mut self, lines: isize) {
        self.mark = self.mark.saturating_add_signed(lines).min(listed().len().saturating_sub(1));
    }

    /// Marks the shot so many after the marked one; gives what is to be played, `None` where there is no such shot. It is watched when
    /// it is received.
    pub fn begin(&mut self, shots: isize) -> Option<FilmedShot> {
        let before = self.mark;
        self.move_mark(shots);
        if shots != 0 && self.mark == before {
            return None;
        }
        self.played = None;
        self.playback.jump(0.0);
        self.marked().map(|listed| listed.filmed.clone())
    }

    /// The shot of this number has been played; one that is no longer wanted is dropped.
    ///
    /// # Errors
    /// Why it could not be played.
    pub fn receive(&mut self, number: u32, played: Result<Box<FilmReplay>, String>) -> Result<(), String> {
        if self.played.is_none() && self.marked().is_some_and(|listed| listed.filmed.number == number) {
            let played = self.played.insert(played).as_ref().map_err(String::clone)?;
            self.playback.toggle(played.replay.duration());
        }
        Ok(())
    }

    /// Why nothing is watched, where that is known.
    pub fn failure(&self) -> Option<&str> {
        self.played.as_ref()?.as_ref().err().map(String::as_str)
    }

    /// What is watched; `None` while the stroke is being fitted, and where that has failed.
    pub fn played(&self) -> Option<&FilmReplay> {
        self.played.as_ref()?.as_ref().ok().map(Box::as_ref)
    }

    /// Does what a key asks of the shot that is watched.
    pub fn watch(&mut self, key: PlaybackKey) {
        if let Some(Ok(played)) = &self.played {
            self.playback.act(key, played.shot.recording.events(), played.replay.duration());
        }
    }

    /// Lets `seconds` pass for the shot.
    pub fn tick(&mut self, seconds: f64) {
        if let Some(Ok(played)) = &self.played {
            self.playback.tick(seconds, played.replay.duration());
        }
    }
}
