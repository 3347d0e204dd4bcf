//! The latest shots on held-out layouts, played one after the other.
//!
//! A new set of shots plays through once and rests at its last shot; then nothing moves until another set comes or
//! somebody wants to see it again.

use crate::{
    learning::run::examples::{Example, Examples},
    table::Table,
    terminal::{playback::Playback, shot::Shot},
};

/// Seconds between two pictures.
pub const INTERVAL: f64 = 0.1;
/// Seconds that the balls lie still before the next shot.
const REST: f64 = 1.0;

/// What moves.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Motion {
    /// Nothing: the set has been played, or somebody has stopped it.
    Stopped,
    /// The shot.
    Playing,
    /// Nothing for so many seconds, then the next shot.
    Resting(f64),
}

/// Shots that are replayed.
#[derive(Debug)]
pub struct Replay {
    examples: Option<Examples>,
    /// A newer set that waits until this one is through.
    waiting: Option<Examples>,
    index: usize,
    /// The recording of the present shot; none where it cannot be played.
    shot: Option<Shot>,
    playback: Playback,
    motion: Motion,
    /// Whether somebody has stopped it: then nothing moves until somebody wants it.
    held: bool,
}

impl Default for Replay {
    fn default() -> Self {
        Self {
            examples: None,
            waiting: None,
            index: 0,
            shot: None,
            playback: Playback::default(),
            motion: Motion::Stopped,
            held: false,
        }
    }
}

impl Replay {
    /// Takes a new set; it plays at once, or after the one that is playing.
    pub fn offer(&mut self, examples: Examples, table: &Table) {
        if self.examples.as_ref() == Some(&examples) || examples.shots.is_empty() {
            return;
        }
        if self.examples.is_some() && (self.motion != Motion::Stopped || self.held) {
            self.waiting = Some(examples);
        } else {
            self.begin(examples, table);
        }
    }

    fn begin(&mut self, examples: Examples, table: &Table) {
        self.examples = Some(examples);
        self.show(0, table);
        self.motion = Motion::Playing;
    }

    /// Puts the shot with this number on the table, before its stroke.
    fn show(&mut self, index: usize, table: &Table) {
        self.index = index;
        self.playback.jump(0.0);
        self.shot = self.example().and_then(|example| {
            let Example { layout, cue, reward } = *example;
            Shot::new(table, &layout, cue, reward >= 1.0, "").ok()
        });
    }

    /// The set that is shown.
    pub const fn examples(&self) -> Option<&Examples> {
        self.examples.as_ref()
    }

    /// The present shot's number in the set, from 0.
    pub const fn index(&self) -> usize {
        self.index
    }

    /// The present shot.
    pub fn example(&self) -> Option<&Example> {
        self.examples.as_ref()?.shots.get(self.index)
    }

    /// What happens in it; none where it cannot be played.
    pub const fn shot(&self) -> Option<&Shot> {
        self.shot.as_ref()
    }

    /// Seconds since the stroke.
    pub const fn time(&self) -> f64 {
        self.playback.time
    }

    /// Whether anything moves.
    pub fn is_playing(&self) -> bool {
        self.motion != Motion::Stopped
    }

    /// Plays, or stops; at the end of the set it plays the newest from its beginning.
    pub fn toggle(&mut self, table: &Table) {
        if self.is_playing() {
            self.motion = Motion::Stopped;
            self.held = true;
            return;
        }
        self.held = false;
        if self.is_through() {
            match self.waiting.take() {
                Some(newer) => self.begin(newer, table),
                None => self.show(0, table),
            }
        } else if self.is_at_the_end() {
            self.show(self.index + 1, table);
        }
        self.motion = Motion::Playing;
    }

    fn duration(&self) -> f64 {
        self.shot.as_ref().map_or(0.0, |shot| shot.recording.duration())
    }

    fn is_at_the_end(&self) -> bool {
        self.playback.time >= self.duration()
    }

    fn is_through(&self) -> bool {
        let last = self.examples.as_ref().map_or(0, |examples| examples.shots.len().saturating_sub(1));
        self.index >= last && self.is_at_the_end()
    }

    /// Shows another shot before its stroke, the next where positive, and stops there.
    pub fn step(&mut self, shots: isize, table: &Table) {
        let count = self.examples.as_ref().map_or(0, |examples| examples.shots.len());
        if count > 0 {
            let index = self.index.saturating_add_signed(shots).min(count - 1);
            self.show(index, table);
        }
        self.motion = Motion::Stopped;
        self.held = true;
    }

    /// Lets `seconds` pass.
    pub fn tick(&mut self, seconds: f64, table: &Table) {
        match self.motion {
            Motion::Stopped => {}
            Motion::Playing => {
                self.playback.playing = true;
                self.playback.tick(seconds, self.duration());
                if self.is_at_the_end() {
                    self.motion = Motion::Resting(REST);
                }
            }
            Motion::Resting(left) if left > seconds => self.motion = Motion::Resting(left - seconds),
            Motion::Resting(_) if !self.is_through() => {
                self.show(self.index + 1, table);
                self.motion = Motion::Playing;
            }
            Motion::Resting(_) => match self.waiting.take() {
                Some(newer) => self.begin(newer, table),
                None => self.motion = Motion::Stopped,
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{physics::CueInputs, table::Layout};

    fn examples(after: u64) -> Examples {
        let layout = Layout::opening(&Table::default());
        let cue = CueInputs::parse("0,0,0,30,1").unwrap();
        Examples { after, shots: vec![Example { layout, cue, reward: 0.0 }; 3] }
    }

    fn pass(replay: &mut Replay, table: &Table) -> Vec<(u64, usize)> {
        let mut seen = Vec::new();
        let mut seconds = 0.0;
        while replay.is_playing() && seconds < 1e3 {
            let now = (replay.examples().unwrap().after, replay.index());
            if seen.last() != Some(&now) {
                seen.push(now);
            }
            replay.tick(INTERVAL, table);
            seconds += INTERVAL;
        }
        seen
    }

    #[test]
    fn a_set_plays_once_and_rests_at_its_last_shot() {
        let (table, mut replay) = (Table::default(), Replay::default());
        replay.offer(examples(1), &table);
        assert_eq!(pass(&mut replay, &table), [(1, 0), (1, 1), (1, 2)]);
        assert_eq!(replay.time(), replay.shot().unwrap().recording.duration());
        replay.offer(examples(1), &table);
        assert!(!replay.is_playing(), "the same set is no news");
        replay.toggle(&table);
        assert_eq!(pass(&mut replay, &table).len(), 3);
    }

    #[test]
    fn a_newer_set_waits_for_the_end_of_the_one_that_plays() {
        let (table, mut replay) = (Table::default(), Replay::default());
        replay.offer(examples(1), &table);
        replay.tick(0.3, &table);
        replay.offer(examples(2), &table);
        replay.offer(examples(3), &table);
        assert_eq!(pass(&mut replay, &table), [(1, 0), (1, 1), (1, 2), (3, 0), (3, 1), (3, 2)]);
    }

    #[test]
    fn what_somebody_has_stopped_stays_stopped() {
        let (table, mut replay) = (Table::default(), Replay::default());
        replay.offer(examples(1), &table);
        replay.step(1, &table);
        replay.offer(examples(2), &table);
        assert!(!replay.is_playing());
        assert_eq!((replay.examples().unwrap().after, replay.index()), (1, 1));
        replay.toggle(&table);
        assert_eq!(pass(&mut replay, &table).last(), Some(&(2, 2)));
    }
}
