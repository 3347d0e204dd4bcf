//! When a picture is due: at once after a key, steadily while something moves, and ten times a second at most where only
//! the runs that are followed have news.

use std::time::{Duration, Instant};

/// Least time between two pictures that only news of runs have made.
const NEWS_INTERVAL: Duration = Duration::from_millis(100);

/// Keeps the time of pictures.
#[derive(Debug)]
pub struct Pace {
    /// When the last picture was drawn.
    drawn: Instant,
    /// When the next one is due, while something moves.
    due: Instant,
    /// Whether news wait for a picture.
    stale: bool,
}

impl Pace {
    /// A picture has been drawn at `now`, the first one.
    pub const fn new(now: Instant) -> Self {
        Self { drawn: now, due: now, stale: false }
    }

    /// Until when to wait for news, before a picture is due without; for ever where it is `None`. `interval` is the time
    /// between two pictures while something moves.
    pub fn wake(&mut self, interval: Option<Duration>) -> Option<Instant> {
        let Some(interval) = interval else { return self.stale.then(|| self.drawn + NEWS_INTERVAL) };
        // From when the last picture was due, not from when it was done: the rate is to be steady.
        if self.due <= self.drawn {
            self.due = (self.due + interval).max(self.drawn);
        }
        Some(self.due)
    }

    /// Time since the last picture.
    pub fn since(&self, now: Instant) -> Duration {
        now.saturating_duration_since(self.drawn)
    }

    /// News of runs has come, and nothing else: whether they are drawn `now`. Where something moves they come with its
    /// next picture.
    pub fn news(&mut self, now: Instant, moves: bool) -> bool {
        self.stale = true;
        !moves && self.since(now) >= NEWS_INTERVAL
    }

    /// A picture has been drawn at `now`.
    pub const fn drew(&mut self, now: Instant) {
        self.drawn = now;
        self.stale = false;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_runs_with_news_ten_times_a_second_make_ten_pictures_a_second() {
        let start = Instant::now();
        let at = |milliseconds: u64| start + Duration::from_millis(milliseconds);
        let mut pace = Pace::new(start);
        let mut pictures = Vec::new();
        // One run has news at 100, 200, ... ms, the other one at 137, 237, ...
        let mut news = (1..100).flat_map(|n| [100 * n, 100 * n + 37]).peekable();
        while let Some(&next) = news.peek() {
            let wake = pace.wake(None).filter(|wake| *wake < at(next));
            let now = wake.unwrap_or_else(|| at(next));
            if wake.is_some() || pace.news(at(news.next().unwrap()), false) {
                pace.drew(now);
                pictures.push(now);
            }
        }
        assert!(pictures.windows(2).all(|pair| pair[1] - pair[0] >= NEWS_INTERVAL), "{pictures:?}");
        assert!((95..=100).contains(&pictures.len()), "{}", pictures.len());
        assert_eq!(pace.wake(None), Some(*pictures.last().unwrap() + NEWS_INTERVAL), "the last news are drawn as well");
    }

    #[test]
    fn what_moves_sets_the_pace_and_rest_has_none() {
        let start = Instant::now();
        let mut pace = Pace::new(start);
        assert_eq!(pace.wake(None), None);
        let frame = Duration::from_millis(33);
        assert_eq!(pace.wake(Some(frame)), Some(start + frame));
        assert!(!pace.news(start + 5 * NEWS_INTERVAL, true));
        // Late by 4 ms: the next one is due as if it had not been.
        pace.drew(start + frame + Duration::from_millis(4));
        assert_eq!(pace.wake(Some(frame)), Some(start + 2 * frame));
        assert_eq!(pace.wake(None), None, "all news are drawn");
    }
}
