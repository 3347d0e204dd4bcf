//! A played stroke during playback.

use crate::{
    physics::CueInputs,
    terminal::{AttemptOutcome, shot::Playback},
};

/// A played stroke during playback.
#[derive(Debug)]
pub struct Watched {
    /// Its result.
    pub outcome: AttemptOutcome,
    /// The stroke that the player meant, without errors.
    pub intended: CueInputs,
    /// The success rate of the meant stroke; `None` until it has been computed.
    pub chance: Option<f64>,
    /// Playback position and speed of the shot.
    pub playback: Playback,
    /// Whether the end of the shot has been shown. Before that, nothing on the screen may reveal the result.
    pub is_end_shown: bool,
}

impl Watched {
    /// Whether the coach has played the stroke.
    pub fn is_by_coach(&self) -> bool {
        self.outcome.session.attempts.last().is_some_and(|attempt| attempt.by_coach)
    }

    /// Duration of the shot, s.
    pub fn duration(&self) -> f64 {
        self.outcome.shot.as_ref().map_or(0.0, |shot| shot.recording.duration())
    }

    /// Allows the result to be shown if the playback has reached the end.
    pub(super) fn settle(&mut self) {
        self.is_end_shown |= self.playback.time >= self.duration();
    }

    /// Jumps to the end, where the result is shown.
    pub(super) fn finish(&mut self) {
        self.playback.seek(self.duration());
        self.settle();
    }
}
