//! The replay buffer: a ring of past shots, in which a new shot replaces the oldest.

use rand::{Rng, RngExt};

/// A ring buffer of the most recent shots.
#[derive(Clone, Debug)]
pub struct ReplayBuffer<T> {
    stored: Vec<T>,
    capacity: usize,
    /// Index of the slot that the next shot overwrites once the buffer is full.
    next: usize,
}

impl<T: Copy> ReplayBuffer<T> {
    /// Creates an empty buffer for `capacity` shots, at least one.
    pub fn new(capacity: usize) -> Self {
        Self::restore(capacity, Vec::new(), 0)
    }

    /// Restores a buffer from the values of [`ReplayBuffer::stored`] and [`ReplayBuffer::next`].
    pub fn restore(capacity: usize, mut stored: Vec<T>, next: usize) -> Self {
        let capacity = capacity.max(1);
        stored.truncate(capacity);
        Self { stored, capacity, next: next % capacity }
    }

    /// The stored shots, in the order of the ring.
    pub fn stored(&self) -> &[T] {
        &self.stored
    }

    /// Index of the slot that the next shot overwrites once the buffer is full.
    pub const fn next(&self) -> usize {
        self.next
    }

    /// Number of stored shots.
    pub const fn len(&self) -> usize {
        self.stored.len()
    }

    /// Share of the buffer that is filled.
    pub fn fill_fraction(&self) -> f64 {
        self.stored.len() as f64 / self.capacity as f64
    }

    pub fn push(&mut self, shot: T) {
        if self.stored.len() < self.capacity {
            self.stored.push(shot);
        } else {
            self.stored[self.next] = shot;
            self.next = (self.next + 1) % self.capacity;
        }
    }

    /// Draws `count` shots uniformly with replacement; none from an empty buffer.
    pub fn sample(&self, count: usize, rng: &mut (impl Rng + ?Sized)) -> Vec<T> {
        if self.stored.is_empty() {
            return Vec::new();
        }
        (0..count).map(|_| self.stored[rng.random_range(0..self.stored.len())]).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_xoshiro::Xoshiro256PlusPlus;

    #[test]
    fn new_shots_replace_the_oldest() {
        let mut buffer = ReplayBuffer::new(3);
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(1);
        assert!(buffer.sample(5, &mut rng).is_empty());
        (0..5).for_each(|shot| buffer.push(shot));
        assert_eq!((buffer.len(), buffer.fill_fraction()), (3, 1.0));
        let mut seen = buffer.sample(100, &mut rng);
        seen.sort_unstable();
        seen.dedup();
        assert_eq!(seen, [2, 3, 4]);
    }
}
