//! Counter of the computational work of contacts and impacts, which limits a shot.

use std::cell::Cell;

/// Approximate number of multiplications: deterministic for a shot on every machine, and nearly proportional to its computing time.
#[derive(Clone, Debug, Default)]
pub struct Effort(Cell<u64>);

impl Effort {
    /// Adds to the count.
    pub fn add(&self, multiplications: u64) {
        self.0.set(self.0.get() + multiplications);
    }

    /// Moves the count of `other` to this counter.
    pub fn absorb(&self, other: &Self) {
        self.add(other.0.take());
    }

    /// Returns the count so far.
    pub fn spent(&self) -> u64 {
        self.0.get()
    }
}
