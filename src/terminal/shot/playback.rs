//! The clock of a shot's playback: play, pause, and stepping from event to event.

use crate::simulation::Event;

/// Playback speeds, with real time in the middle.
pub const SPEEDS: [f64; 7] = [0.1, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0];
const REAL: usize = 3;
/// Seconds between two updates of the numbers on the screen while the balls move. Thirty updates a second would be unreadable, and each
/// costs bytes on a slow link.
const READOUT_INTERVAL: f64 = 0.1;

/// A playback command.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PlaybackKey {
    /// Plays or pauses.
    Toggle,
    /// Jumps to another event, the next one if positive.
    Event(isize),
    /// Plays faster if positive, otherwise slower.
    Pace(isize),
    /// Jumps to the stroke.
    ToStart,
    /// Jumps to the end of the shot.
    ToEnd,
}

/// State of the playback.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Playback {
    /// Seconds since the stroke.
    pub time: f64,
    /// The time that the displayed numbers belong to.
    pub readout: f64,
    /// Whether the clock is running.
    pub playing: bool,
    since_readout: f64,
    speed: usize,
}

impl Default for Playback {
    fn default() -> Self {
        Self { time: 0.0, readout: 0.0, playing: false, since_readout: 0.0, speed: REAL }
    }
}

impl Playback {
    /// Playback speed, seconds of the shot per second.
    pub fn speed(&self) -> f64 {
        SPEEDS[self.speed]
    }

    /// Sets one of [`SPEEDS`]; ignores any other.
    pub fn set_speed(&mut self, speed: f64) {
        self.speed = SPEEDS.iter().position(|known| *known == speed).unwrap_or(self.speed);
    }

    /// Changes to the next higher speed, or the next lower one if negative.
    pub fn change_speed(&mut self, steps: isize) {
        self.speed = self.speed.saturating_add_signed(steps).min(SPEEDS.len() - 1);
    }

    /// Runs a playback command for a shot with these `events` and this `duration`.
    pub fn apply(&mut self, key: PlaybackKey, events: &[Event], duration: f64) {
        match key {
            PlaybackKey::Toggle => self.toggle(duration),
            PlaybackKey::Event(steps) => self.step(steps, events, duration),
            PlaybackKey::Pace(steps) => self.change_speed(steps),
            PlaybackKey::ToStart => self.seek(0.0),
            PlaybackKey::ToEnd => self.seek(duration),
        }
    }

    /// Plays or pauses; at the end of the shot, plays from the start.
    pub fn toggle(&mut self, duration: f64) {
        if !self.playing && self.time >= duration {
            self.seek(0.0);
        }
        self.playing = !self.playing;
        self.readout = self.time;
    }

    /// Pauses at the present time.
    pub fn pause(&mut self) {
        self.playing = false;
        self.readout = self.time;
    }

    /// Advances by `seconds` of real time; pauses at the end of the shot.
    pub fn tick(&mut self, seconds: f64, duration: f64) {
        if !self.playing {
            return;
        }
        self.time += seconds * self.speed();
        self.since_readout += seconds;
        if self.time >= duration {
            self.seek(duration);
        } else if self.since_readout >= READOUT_INTERVAL {
            self.since_readout = 0.0;
            self.readout = self.time;
        }
    }

    /// Pauses at `time`.
    pub fn seek(&mut self, time: f64) {
        self.time = time;
        self.readout = time;
        self.since_readout = 0.0;
        self.playing = false;
    }

    /// Follows another player's clock, which is at `time` in a shot of this `duration`.
    pub fn follow(&mut self, time: f64, duration: f64, playing: bool) {
        self.seek(time.min(duration));
        self.playing = playing && time < duration;
    }

    /// Pauses at the next event or the end; if `steps` is negative, at the previous event or the stroke.
    pub fn step(&mut self, steps: isize, events: &[Event], duration: f64) {
        let (found, end) = if steps > 0 {
            (events.iter().find(|event| event.time > self.time), duration)
        } else {
            (events.iter().rfind(|event| event.time < self.time), 0.0)
        };
        self.seek(found.map_or(end, |event| event.time));
    }
}

/// Number of events up to `time`.
pub fn passed_count(events: &[Event], time: f64) -> usize {
    events.partition_point(|event| event.time <= time)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulation::EventKind;

    fn events() -> Vec<Event> {
        [0.5, 0.5, 1.25].map(|time| Event { time, kind: EventKind::SlidingRolling(0) }).to_vec()
    }

    #[test]
    fn stepping_visits_every_event_time_once_and_both_ends() {
        let mut playback = Playback::default();
        let mut seen = Vec::new();
        for _ in 0..4 {
            playback.step(1, &events(), 2.0);
            seen.push(playback.time);
        }
        assert_eq!(seen, [0.5, 1.25, 2.0, 2.0]);
        for _ in 0..4 {
            playback.step(-1, &events(), 2.0);
            seen.push(playback.time);
        }
        assert_eq!(seen[4..], [1.25, 0.5, 0.0, 0.0]);
        assert_eq!(passed_count(&events(), 0.5), 2);
    }

    #[test]
    fn playing_ends_at_the_end_and_starts_again_from_the_stroke() {
        let mut playback = Playback::default();
        playback.toggle(2.0);
        playback.change_speed(1);
        playback.tick(0.6, 2.0);
        assert!(playback.playing && (playback.time - 1.2).abs() < 1e-12);
        playback.tick(0.6, 2.0);
        assert!(!playback.playing && playback.time == 2.0);
        playback.toggle(2.0);
        assert!(playback.playing && playback.time == 0.0);
    }

    #[test]
    fn another_players_clock_is_followed_up_to_the_end_of_the_shot() {
        let mut playback = Playback::default();
        playback.follow(1.5, 2.0, true);
        assert!(playback.playing && (playback.time, playback.readout) == (1.5, 1.5));
        playback.follow(7.0, 2.0, true);
        assert!(!playback.playing && playback.time == 2.0);
    }

    #[test]
    fn readouts_change_ten_times_a_second() {
        let mut playback = Playback::default();
        playback.toggle(60.0);
        let mut changes = 0;
        for _ in 0..60 {
            let before = playback.readout;
            playback.tick(1.0 / 30.0, 60.0);
            changes += usize::from(playback.readout != before);
        }
        assert!((15..=20).contains(&changes), "{changes}");
    }
}
