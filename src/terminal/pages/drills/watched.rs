//! A stroke that was played, while it is watched.

use crate::{
    physics::CueInputs,
    terminal::{AttemptOutcome, shot::Playback},
};

/// A stroke that was played.
#[derive(Debug)]
pub struct Watched {
    /// What came of it.
    pub outcome: AttemptOutcome,
    /// What the player had meant.
    pub meant: CueInputs,
    /// How often the player makes that, as soon as it is known.
    pub chance: Option<f64>,
    /// The clock of the shot.
    pub playback: Playback,
    /// Whether it has been seen to its end: before, nothing tells what comes of it.
    pub is_settled: bool,
}

impl Watched {
    /// Whether the coach has made the stroke.
    pub fn is_by_coach(&self) -> bool {
        self.outcome.session.attempts.last().is_some_and(|attempt| attempt.by_coach)
    }

    /// Seconds that the shot takes.
    pub fn duration(&self) -> f64 {
        self.outcome.shot.as_ref().map_or(0.0, |shot| shot.recording.duration())
    }

    /// Once it has been seen to its end, its result may be shown.
    pub(super) fn settle(&mut self) {
        self.is_settled |= self.playback.time >= self.duration();
    }

    /// Goes to its end, where its result is shown.
    pub(super) fn finish(&mut self) {
        self.playback.jump(self.duration());
        self.settle();
    }
}
