//! Any number of lines as a bounded number of stretches.

use super::stretch::Stretch;

/// Most stretches that are kept; one takes 450 bytes, all of them not quite a megabyte.
pub const CAPACITY: usize = 2048;

/// Stretches of equally many lines, except for the last one, which is still filling.
#[derive(Clone, Debug, PartialEq)]
pub struct Thinned {
    stretches: Vec<Stretch>,
    /// Lines in a full stretch.
    size: u64,
    /// Lines in the last stretch.
    filled: u64,
}

impl Default for Thinned {
    fn default() -> Self {
        Self { stretches: Vec::new(), size: 1, filled: 0 }
    }
}

impl Thinned {
    /// Adds a line after all others. Each doubling of the size touches as many stretches as lines have come in since the
    /// one before, at most: constant time a line on average.
    pub fn push(&mut self, line: Stretch) {
        if self.filled < self.size
            && let Some(last) = self.stretches.last_mut()
        {
            last.absorb(&line);
            self.filled += 1;
            return;
        }
        if self.stretches.len() == CAPACITY {
            self.halve();
        }
        self.stretches.push(line);
        self.filled = 1;
    }

    /// The stretches in order.
    pub fn stretches(&self) -> &[Stretch] {
        &self.stretches
    }

    fn halve(&mut self) {
        for pair in 0..CAPACITY / 2 {
            let mut first = self.stretches[2 * pair].clone();
            first.absorb(&self.stretches[2 * pair + 1]);
            self.stretches[pair] = first;
        }
        self.stretches.truncate(CAPACITY / 2);
        self.size *= 2;
    }
}
