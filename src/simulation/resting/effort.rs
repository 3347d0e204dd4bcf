//! What the searches for forces by the solver cost, for the guard of the engine.

use std::cell::Cell;

/// Bounces of chatters that take as long as a search that finds forces, and as one that finds none.
const FOUND: u32 = 1;
const NOT_FOUND: u32 = 200;

/// Searches so far, as if they were bounces.
#[derive(Clone, Debug, Default)]
pub struct Effort(Cell<u32>);

impl Effort {
    /// Takes note of a search.
    pub fn add(&self, is_found: bool) {
        self.0.set(self.0.get() + if is_found { FOUND } else { NOT_FOUND });
    }

    /// All since this was asked last.
    pub fn take(&self) -> u32 {
        self.0.take()
    }
}
