//! What keeps a shot from going on for ever where balls crowd.
//!
//! Three balls and a cushion that all touch can hand an impact round without end: a ball that has to squeeze past another
//! closes with it again as soon as it has been stopped, and time stands still. Letting such balls overlap by a hair lets
//! time go on.
//!
//! Shots of hundreds of impacts or thousands of contact steps are simulated more and more coarsely: of two million random
//! shots on `match` ten get there, of a hundred thousand on `thesis` 48.

/// Impacts of balls that follow each other within this time belong together, s.
const TOGETHER: f64 = 1e-7;

/// So many of them are a matter of course: three touching balls against a cushion exchange some dozens.
const USUAL: u32 = 64;

/// By how much the first impact beyond them is late, s; sixteen more double it. Balls that close with 1 m/s overlap by
/// 1e-12 m.
const FIRST_DELAY: f64 = 1e-12;

/// Longest delay, s: what has piled up so far closes with less than 1e-6 m/s.
const LONGEST_DELAY: f64 = 1e-7;

/// Impacts of a shot that are simulated as exactly as can be, and how many more double its tolerances.
const FINE_IMPACTS: u32 = 160;
const IMPACTS_TO_DOUBLE: u32 = 5;

/// The same for steps of resting contacts.
const FINE_STEPS: u32 = 1000;
const STEPS_TO_DOUBLE: u32 = 25;

/// Impacts of a shot after which it is brought to its end.
const TOO_MANY_IMPACTS: u32 = 250;

/// Impacts and steps of a contact after which there is no hope of an end.
const HOPELESS_IMPACTS: u32 = 1500;
const HOPELESS_STEPS: u32 = 2500;

/// How much has happened.
#[derive(Clone, Copy, Debug)]
pub struct Crowd {
    last: f64,
    count: u32,
    impacts: u32,
    steps: u32,
}

impl Crowd {
    /// No impact yet.
    pub const NONE: Self = Self { last: f64::NEG_INFINITY, count: 0, impacts: 0, steps: 0 };

    /// Takes note of an impact of two balls.
    #[inline(always)]
    pub fn impact(&mut self, now: f64) {
        self.count = if now - self.last < TOGETHER { self.count + 1 } else { 0 };
        self.last = now;
        self.impacts += 1;
    }

    /// Takes note of an impact on a cushion.
    #[inline(always)]
    pub fn rebound(&mut self) {
        self.impacts += 1;
    }

    /// Takes note of a step of a resting contact.
    pub fn step(&mut self) {
        self.steps += 1;
    }

    /// By how much the speed below which balls are at rest is to grow, 1 to a million: what neither time nor coarser steps
    /// bring to an end, this does. Infinite where all that has failed: what takes part in anything more stops dead.
    #[inline(always)]
    pub fn stillness(&self) -> f64 {
        if self.impacts < TOO_MANY_IMPACTS && self.steps < HOPELESS_STEPS { 1.0 } else { self.long_stillness() }
    }

    #[cold]
    fn long_stillness(&self) -> f64 {
        if self.impacts > HOPELESS_IMPACTS || self.steps > HOPELESS_STEPS {
            return f64::INFINITY;
        }
        f64::from(1_u32 << (self.impacts.saturating_sub(TOO_MANY_IMPACTS) / IMPACTS_TO_DOUBLE).min(20))
    }

    /// By how much all tolerances are to grow, 1 to a million.
    pub fn coarseness(&self) -> f64 {
        let impacts = self.impacts.saturating_sub(FINE_IMPACTS) / IMPACTS_TO_DOUBLE;
        let steps = self.steps.saturating_sub(FINE_STEPS) / STEPS_TO_DOUBLE;
        f64::from(1_u32 << (impacts + steps).min(20))
    }

    /// By how much the next impact comes late, s: zero but for a crowd.
    #[inline(always)]
    pub fn delay(&self) -> f64 {
        if self.count < USUAL { 0.0 } else { self.long_delay() }
    }

    #[cold]
    fn long_delay(&self) -> f64 {
        let doublings = (self.count - USUAL) / 16;
        (FIRST_DELAY * f64::from(1_u32 << doublings.min(30))).min(LONGEST_DELAY)
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

    #[test]
    fn only_shots_without_end_are_coarse() {
        let mut crowd = Crowd::NONE;
        for _ in 0..FINE_IMPACTS {
            crowd.rebound();
        }
        assert_eq!(crowd.coarseness(), 1.0);
        for _ in 0..FINE_IMPACTS {
            crowd.rebound();
        }
        assert_eq!(crowd.coarseness(), 2_f64.powi(20));
    }
}
