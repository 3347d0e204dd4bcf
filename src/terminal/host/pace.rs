//! Frame pacing: immediately after a key, at a steady rate while something moves, and at most ten times a second for news of followed runs.

use std::time::{Duration, Instant};

/// Smallest interval between two frames drawn only for news of runs.
const REPORT_INTERVAL: Duration = Duration::from_millis(100);

/// Frame timer.
#[derive(Debug)]
pub struct Pace {
    /// Time of the last frame.
    drawn: Instant,
    /// Time of the next frame while something moves.
    due: Instant,
    /// Whether there is news that has not been drawn.
    stale: bool,
}

impl Pace {
    /// Starts the timer after the first frame, drawn at `now`.
    pub const fn new(now: Instant) -> Self {
        Self { drawn: now, due: now, stale: false }
    }

    /// Returns the time until which to wait for events before the next frame is due; `None` means without limit. `interval` is the frame
    /// interval while something moves.
    pub fn next_wake(&mut self, interval: Option<Duration>) -> Option<Instant> {
        let Some(interval) = interval else { return self.stale.then(|| self.drawn + REPORT_INTERVAL) };
        // Counted from when the last frame was due, not from when it was drawn, to keep the rate steady.
        if self.due <= self.drawn {
            self.due = (self.due + interval).max(self.drawn);
        }
        Some(self.due)
    }

    /// Time since the last frame.
    pub fn since(&self, now: Instant) -> Duration {
        now.saturating_duration_since(self.drawn)
    }

    /// Records that only news of runs has arrived, and returns whether to draw it `now`. While something moves, the next frame shows it.
    pub fn on_report(&mut self, now: Instant, moves: bool) -> bool {
        self.stale = true;
        !moves && self.since(now) >= REPORT_INTERVAL
    }

    /// Records that a frame was drawn at `now`.
    pub const fn on_drawn(&mut self, now: Instant) {
        self.drawn = now;
        self.stale = false;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frequent_reports_of_two_runs_give_ten_frames_a_second() {
        let start = Instant::now();
        let at = |milliseconds: u64| start + Duration::from_millis(milliseconds);
        let mut pace = Pace::new(start);
        let mut pictures = Vec::new();
        // One run has news at 100, 200, ... ms, the other one at 137, 237, ...
        let mut news = (1..100).flat_map(|n| [100 * n, 100 * n + 37]).peekable();
        while let Some(&next) = news.peek() {
            let wake = pace.next_wake(None).filter(|wake| *wake < at(next));
            let now = wake.unwrap_or_else(|| at(next));
            if wake.is_some() || pace.on_report(at(news.next().unwrap()), false) {
                pace.on_drawn(now);
                pictures.push(now);
            }
        }
        assert!(pictures.windows(2).all(|pair| pair[1] - pair[0] >= REPORT_INTERVAL), "{pictures:?}");
        assert!((95..=100).contains(&pictures.len()), "{}", pictures.len());
        assert_eq!(
            pace.next_wake(None),
            Some(*pictures.last().unwrap() + REPORT_INTERVAL),
            "the last news are drawn as well"
        );
    }

    #[test]
    fn frames_are_paced_only_while_something_moves() {
        let start = Instant::now();
        let mut pace = Pace::new(start);
        assert_eq!(pace.next_wake(None), None);
        let frame = Duration::from_millis(33);
        assert_eq!(pace.next_wake(Some(frame)), Some(start + frame));
        assert!(!pace.on_report(start + 5 * REPORT_INTERVAL, true));
        // Late by 4 ms: the next frame is due as if it had been on time.
        pace.on_drawn(start + frame + Duration::from_millis(4));
        assert_eq!(pace.next_wake(Some(frame)), Some(start + 2 * frame));
        assert_eq!(pace.next_wake(None), None, "all news are drawn");
    }
}
