//! Replay of a run's latest shots on held-out layouts, one after the other.
//!
//! A new set of shots is played once and stops at its last shot. After that nothing moves until the next set arrives or the user
//! starts the replay again.

use crate::terminal::{Reel, ReplayShot, pages::moved_index, shot::Playback};

/// Time between two frames, s.
pub const INTERVAL: f64 = 0.1;
/// Pause between two shots, s.
const PAUSE: f64 = 1.0;

/// State of the replay.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
enum Motion {
    /// Stopped: the set has been played, or the user has stopped it.
    #[default]
    Stopped,
    /// A shot is playing.
    Playing,
    /// Pause before the next shot, with the remaining time, s.
    Resting(f64),
}

/// The replay of a set of shots.
#[derive(Debug, Default)]
pub struct Replay {
    /// The set on the screen.
    pub reel: Option<Reel>,
    /// A newer set that waits for the end of this one.
    waiting: Option<Reel>,
    /// Index of the current shot in the set.
    pub index: usize,
    /// Playback position of the current shot.
    pub playback: Playback,
    motion: Motion,
    /// Whether the user has stopped the replay, so that only the user can start it again.
    stopped_by_user: bool,
    /// Whether the run was resumed from a point before the set on the screen. Then the next set is newer, whatever its number.
    pub is_outdated: bool,
}

impl Replay {
    /// Accepts a new set, and plays it now or after the one that is playing. A set that is not newer than the latest one is ignored.
    /// So is that set itself, which is read again when the user returns to the run.
    pub fn queue(&mut self, reel: Reel) {
        let newest = self.waiting.as_ref().or(self.reel.as_ref());
        let is_old = |newest: &Reel| newest.after >= reel.after && !self.is_outdated || newest.has_same_shots(&reel);
        if reel.shots.is_empty() || newest.is_some_and(is_old) {
            return;
        }
        self.is_outdated = false;
        if self.reel.is_some() && (self.motion != Motion::Stopped || self.stopped_by_user) {
            self.waiting = Some(reel);
        } else {
            self.begin(reel);
        }
    }

    fn begin(&mut self, reel: Reel) {
        self.reel = Some(reel);
        self.show(0);
        self.motion = Motion::Playing;
    }

    /// Shows the shot with this index, before its stroke.
    fn show(&mut self, index: usize) {
        self.index = index;
        self.playback.seek(0.0);
    }

    /// The current shot.
    pub fn shot(&self) -> Option<&ReplayShot> {
        self.reel.as_ref()?.shots.get(self.index)
    }

    /// Whether the replay is running.
    pub fn is_playing(&self) -> bool {
        self.motion != Motion::Stopped
    }

    /// Starts or stops the replay. At the end of the set it starts the newest set from its beginning.
    pub fn toggle(&mut self) {
        if self.is_playing() {
            self.motion = Motion::Stopped;
            self.stopped_by_user = true;
            return;
        }
        self.stopped_by_user = false;
        if self.is_finished() {
            match self.waiting.take() {
                Some(newer) => self.begin(newer),
                None => self.show(0),
            }
        } else if self.is_at_the_end() {
            self.show(self.index + 1);
        }
        self.motion = Motion::Playing;
    }

    fn duration(&self) -> f64 {
        self.shot().and_then(|one| one.shot.as_ref()).map_or(0.0, |shot| shot.recording.duration())
    }

    fn is_at_the_end(&self) -> bool {
        self.playback.time >= self.duration()
    }

    fn is_finished(&self) -> bool {
        let last = self.reel.as_ref().map_or(0, |reel| reel.shots.len().saturating_sub(1));
        self.index >= last && self.is_at_the_end()
    }

    /// Stops the replay and shows another shot, before its stroke: the next one if positive, the one before if negative.
    pub fn step(&mut self, shots: isize) {
        let count = self.reel.as_ref().map_or(0, |reel| reel.shots.len());
        if count > 0 {
            self.show(moved_index(self.index, shots, count));
        }
        self.motion = Motion::Stopped;
        self.stopped_by_user = true;
    }

    /// Advances the replay by `seconds`.
    pub fn tick(&mut self, seconds: f64) {
        match self.motion {
            Motion::Stopped => {}
            Motion::Playing => {
                self.playback.playing = true;
                self.playback.tick(seconds, self.duration());
                if self.is_at_the_end() {
                    self.motion = Motion::Resting(PAUSE);
                }
            }
            Motion::Resting(left) if left > seconds => self.motion = Motion::Resting(left - seconds),
            Motion::Resting(_) if !self.is_finished() => {
                self.show(self.index + 1);
                self.motion = Motion::Playing;
            }
            Motion::Resting(_) => match self.waiting.take() {
                Some(newer) => self.begin(newer),
                None => self.motion = Motion::Stopped,
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        learning::run::examples::{Example, Examples},
        table::Table,
    };
    use crate::{physics::CueInputs, table::Layout};

    fn reel(after: u64) -> Reel {
        let layout = Layout::opening(&Table::default());
        let cue = CueInputs::parse("0,0,0,30,1").unwrap();
        let examples = Examples { after, shots: vec![Example { layout, cue, reward: 0.0 }; 3] };
        Reel::record(&examples, &Table::default())
    }

    fn pass(replay: &mut Replay) -> Vec<(u64, usize)> {
        let mut seen = Vec::new();
        let mut seconds = 0.0;
        while replay.is_playing() && seconds < 1e3 {
            let now = (replay.reel.as_ref().unwrap().after, replay.index);
            if seen.last() != Some(&now) {
                seen.push(now);
            }
            replay.tick(INTERVAL);
            seconds += INTERVAL;
        }
        seen
    }

    #[test]
    fn reel_plays_once_and_stops_at_last_shot() {
        let mut replay = Replay::default();
        replay.queue(reel(1));
        assert_eq!(pass(&mut replay), [(1, 0), (1, 1), (1, 2)]);
        assert_eq!(replay.playback.time, replay.duration());
        replay.queue(reel(1));
        assert!(!replay.is_playing(), "the same set is no news");
        replay.toggle();
        assert_eq!(pass(&mut replay).len(), 3);
    }

    #[test]
    fn newer_reel_starts_after_the_current_one() {
        let mut replay = Replay::default();
        replay.queue(reel(1));
        replay.tick(0.3);
        replay.queue(reel(2));
        replay.queue(reel(3));
        assert_eq!(pass(&mut replay), [(1, 0), (1, 1), (1, 2), (3, 0), (3, 1), (3, 2)]);
    }

    #[test]
    fn replay_stopped_by_user_stays_stopped() {
        let mut replay = Replay::default();
        replay.queue(reel(1));
        replay.step(1);
        replay.queue(reel(2));
        assert!(!replay.is_playing());
        assert_eq!((replay.reel.as_ref().unwrap().after, replay.index), (1, 1));
        replay.toggle();
        assert_eq!(pass(&mut replay).last(), Some(&(2, 2)));
    }
}
