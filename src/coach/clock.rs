//! The end of a search: its time or its simulations are used up, or it is cancelled.

use std::{
    sync::atomic::{AtomicBool, AtomicU64, Ordering},
    time::{Duration, Instant},
};

/// The limits of a search, and what it has used.
#[derive(Debug)]
pub struct Clock<'a> {
    start: Instant,
    budget: Duration,
    most_simulations: u64,
    cancel: &'a AtomicBool,
    simulations: AtomicU64,
}

impl<'a> Clock<'a> {
    /// Starts the clock.
    pub fn start(budget: Duration, most_simulations: u64, cancel: &'a AtomicBool) -> Self {
        // An instant beyond the clock's range would panic; no search runs for a year.
        let budget = budget.min(Duration::from_secs(365 * 24 * 3600));
        Self { start: Instant::now(), budget, most_simulations, cancel, simulations: AtomicU64::new(0) }
    }

    /// Returns the instant at which this share of the time is used up.
    pub fn deadline(&self, share: f64) -> Instant {
        self.start + self.budget.mul_f64(share)
    }

    /// Whether `moment` has passed, or the search is cancelled.
    #[inline]
    pub fn is_past(&self, moment: Instant) -> bool {
        self.is_cancelled() || Instant::now() >= moment
    }

    /// Whether the search is cancelled.
    pub fn is_cancelled(&self) -> bool {
        self.cancel.load(Ordering::Relaxed)
    }

    /// Returns the used share of the time or of the simulations, whichever is larger; infinite if cancelled. Between
    /// rounds of a search, the simulations are those of whole rounds on any number of threads. If they limit the search, its
    /// course is therefore reproducible.
    pub fn used_share(&self) -> f64 {
        if self.is_cancelled() {
            return f64::INFINITY;
        }
        let time = self.elapsed().as_secs_f64() / self.budget.as_secs_f64().max(1e-9);
        time.max(self.simulations() as f64 / self.most_simulations as f64)
    }

    /// Adds to the number of simulations.
    pub fn count(&self, simulations: u64) {
        self.simulations.fetch_add(simulations, Ordering::Relaxed);
    }

    /// Returns the number of shots simulated so far.
    pub fn simulations(&self) -> u64 {
        self.simulations.load(Ordering::Relaxed)
    }

    /// Returns the estimated number of simulations left until this share of the budget is used, at the rate so far.
    pub fn remaining_simulations(&self, share: f64) -> f64 {
        (self.simulations() as f64 * (share / self.used_share() - 1.0)).max(0.0)
    }

    /// Returns the time since the start.
    pub fn elapsed(&self) -> Duration {
        self.start.elapsed()
    }
}
