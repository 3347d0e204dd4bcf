//! Impacts that pile up at one moment.
//!
//! Three balls and a cushion that all touch can hand an impact round without end: a ball that has to squeeze past another
//! closes with it again as soon as it has been stopped, and time stands still. Letting such balls overlap by a hair lets
//! time go on.

/// Impacts of balls that follow each other within this time belong together, s.
const TOGETHER: f64 = 1e-7;

/// So many of them are a matter of course: three touching balls against a cushion exchange some dozens.
const USUAL: u32 = 64;

/// By how much the first impact beyond them is late, s; sixteen more double it. Balls that close with 1 m/s overlap by
/// 1e-12 m.
const FIRST_DELAY: f64 = 1e-12;

/// Longest delay, s: what has piled up so far closes with less than 1e-6 m/s.
const LONGEST_DELAY: f64 = 1e-7;

/// How many impacts have piled up.
#[derive(Clone, Copy, Debug)]
pub struct Crowd {
    last: f64,
    count: u32,
}

impl Crowd {
    /// No impact yet.
    pub const NONE: Self = Self { last: f64::NEG_INFINITY, count: 0 };

    /// Takes note of an impact of two balls.
    #[inline(always)]
    pub fn impact(&mut self, now: f64) {
        self.count = if now - self.last < TOGETHER { self.count + 1 } else { 0 };
        self.last = now;
    }

    /// By how much the next impact comes late, s: zero but for a crowd.
    #[inline(always)]
    pub fn delay(&self) -> f64 {
        if self.count < USUAL { 0.0 } else { self.long_delay() }
    }

    #[cold]
    fn long_delay(&self) -> f64 {
        let doublings = (self.count - USUAL) / 16;
        (FIRST_DELAY * 2_f64.powi(doublings.min(30) as i32)).min(LONGEST_DELAY)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_impacts_that_pile_up_come_late() {
        let mut crowd = Crowd::NONE;
        for count in 0..1000 {
            crowd.impact(1e-6 * f64::from(count));
        }
        assert_eq!(crowd.delay(), 0.0);
        for _ in 0..70 {
            crowd.impact(0.5);
        }
        let first = crowd.delay();
        assert!(first > 0.0);
        for _ in 0..1000 {
            crowd.impact(0.5);
        }
        assert!(crowd.delay() > first && crowd.delay() <= LONGEST_DELAY);
    }
}
