//! The replay buffer: shots that were played, the oldest making room for the newest.

use rand::{Rng, RngExt};

/// A ring of the last shots.
#[derive(Clone, Debug)]
pub struct ReplayBuffer<T> {
    held: Vec<T>,
    capacity: usize,
    /// Where the next shot goes once the buffer is full.
    next: usize,
}

impl<T: Copy> ReplayBuffer<T> {
    /// An empty buffer for `capacity` shots, at least one.
    pub fn new(capacity: usize) -> Self {
        Self::restore(capacity, Vec::new(), 0)
    }

    /// A buffer with the content that [`ReplayBuffer::held`] and [`ReplayBuffer::next`] gave.
    pub fn restore(capacity: usize, mut held: Vec<T>, next: usize) -> Self {
        let capacity = capacity.max(1);
        held.truncate(capacity);
        Self { held, capacity, next: next % capacity }
    }

    /// What is held, in the order of the ring.
    pub fn held(&self) -> &[T] {
        &self.held
    }

    /// Where the next shot goes once the buffer is full.
    pub const fn next(&self) -> usize {
        self.next
    }

    /// Number of shots held.
    pub const fn len(&self) -> usize {
        self.held.len()
    }

    /// Share of the buffer that is filled.
    pub fn fill(&self) -> f64 {
        self.held.len() as f64 / self.capacity as f64
    }

    pub fn push(&mut self, shot: T) {
        if self.held.len() < self.capacity {
            self.held.push(shot);
        } else {
            self.held[self.next] = shot;
            self.next = (self.next + 1) % self.capacity;
        }
    }

    /// `count` shots drawn uniformly, the same one possibly twice; none from an empty buffer.
    pub fn sample(&self, count: usize, rng: &mut (impl Rng + ?Sized)) -> Vec<T> {
        if self.held.is_empty() {
            return Vec::new();
        }
        (0..count).map(|_| self.held[rng.random_range(0..self.held.len())]).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_xoshiro::Xoshiro256PlusPlus;

    #[test]
    fn the_oldest_shots_make_room_for_the_newest() {
        let mut buffer = ReplayBuffer::new(3);
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(1);
        assert!(buffer.sample(5, &mut rng).is_empty());
        (0..5).for_each(|shot| buffer.push(shot));
        assert_eq!((buffer.len(), buffer.fill()), (3, 1.0));
        let mut seen = buffer.sample(100, &mut rng);
        seen.sort_unstable();
        seen.dedup();
        assert_eq!(seen, [2, 3, 4]);
    }
}
