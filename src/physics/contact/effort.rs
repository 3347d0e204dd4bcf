//! Work of a shot's contacts and impacts: what its guards count.

use std::cell::Cell;

/// Work in multiplications of numbers, about: the same for the same shot on every machine, and near to proportional to its time.
#[derive(Clone, Debug, Default)]
pub struct Effort(Cell<u64>);

impl Effort {
    /// So much more has been done.
    pub fn add(&self, multiplications: u64) {
        self.0.set(self.0.get() + multiplications);
    }

    /// What another one has counted is counted here from now on.
    pub fn absorb(&self, other: &Self) {
        self.add(other.0.take());
    }

    /// What has been done so far.
    pub fn spent(&self) -> u64 {
        self.0.get()
    }
}
