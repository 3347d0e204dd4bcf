//! Counter of the computational work of a shot, which limits it.

use std::cell::Cell;

/// Estimated computing time, ns: a sum of constant costs, so that a shot has the same effort on every machine.
#[derive(Clone, Debug, Default)]
pub struct Effort(Cell<u64>);

impl Effort {
    /// Adds to the count.
    pub fn add(&self, cost: u64) {
        self.0.set(self.0.get() + cost);
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
