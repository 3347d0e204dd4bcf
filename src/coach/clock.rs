//! When a search has to end: when its time or its simulations are used up, or nobody waits any more.

use std::{
    sync::atomic::{AtomicBool, AtomicU64, Ordering},
    time::{Duration, Instant},
};

/// What a search may use, and what it has used.
#[derive(Debug)]
pub struct Clock<'a> {
    start: Instant,
    budget: Duration,
    most_simulations: u64,
    cancel: &'a AtomicBool,
    simulations: AtomicU64,
}

impl<'a> Clock<'a> {
    /// Starts it.
    pub fn start(budget: Duration, most_simulations: u64, cancel: &'a AtomicBool) -> Self {
        // A moment beyond the clock's range would be a panic; nobody waits for a year.
        let budget = budget.min(Duration::from_secs(365 * 24 * 3600));
        Self { start: Instant::now(), budget, most_simulations, cancel, simulations: AtomicU64::new(0) }
    }

    /// The moment at which this share of the time is used up.
    pub fn moment(&self, share: f64) -> Instant {
        self.start + self.budget.mul_f64(share)
    }

    /// Whether it is later than `moment`, or nobody waits.
    #[inline]
    pub fn is_past(&self, moment: Instant) -> bool {
        self.is_cancelled() || Instant::now() >= moment
    }

    /// Whether nobody waits any more.
    pub fn is_cancelled(&self) -> bool {
        self.cancel.load(Ordering::Relaxed)
    }

    /// The share that is used of the time or of the simulations, whichever is more; infinite where nobody waits. Between
    /// rounds of a search the simulations are those of whole rounds, whatever the threads do: where they decide, the same
    /// search takes the same course.
    pub fn used(&self) -> f64 {
        if self.is_cancelled() {
            return f64::INFINITY;
        }
        let time = self.elapsed().as_secs_f64() / self.budget.as_secs_f64().max(1e-9);
        time.max(self.simulations() as f64 / self.most_simulations as f64)
    }

    /// Takes note of simulations.
    pub fn count(&self, simulations: u64) {
        self.simulations.fetch_add(simulations, Ordering::Relaxed);
    }

    /// Shots simulated so far.
    pub fn simulations(&self) -> u64 {
        self.simulations.load(Ordering::Relaxed)
    }

    /// How many simulations are left until a share of the budget is used, as far as is known by now.
    pub fn simulations_until(&self, share: f64) -> f64 {
        (self.simulations() as f64 * (share / self.used() - 1.0)).max(0.0)
    }

    /// Time since the start.
    pub fn elapsed(&self) -> Duration {
        self.start.elapsed()
    }
}
