//! The replay buffer: shots that were played, the oldest making room for the newest.

use rand::{Rng, RngExt};

use super::{action::Action, observation::Observation, venues::Conditions};

/// One shot: what was seen, what was done, what it earned. A shot is a whole episode, so there is no next state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transition {
    /// The layout as the agent saw it.
    pub observation: Observation,
    /// Under which conditions it was played.
    pub conditions: Conditions,
    /// What it did.
    pub action: Action,
    /// What that earned, as a share of the most that there is to earn.
    pub success: f32,
}

/// A ring of the last shots.
#[derive(Clone, Debug)]
pub struct ReplayBuffer {
    transitions: Vec<Transition>,
    capacity: usize,
    /// Where the next shot goes once the buffer is full.
    next: usize,
}

impl ReplayBuffer {
    /// An empty buffer for `capacity` shots, at least one.
    pub fn new(capacity: usize) -> Self {
        Self { transitions: Vec::new(), capacity: capacity.max(1), next: 0 }
    }

    /// A buffer with the content that [`ReplayBuffer::transitions`] and [`ReplayBuffer::next`] gave.
    pub fn restore(capacity: usize, mut transitions: Vec<Transition>, next: usize) -> Self {
        let capacity = capacity.max(1);
        transitions.truncate(capacity);
        Self { transitions, capacity, next: next % capacity }
    }

    /// What is held, in the order of the ring.
    pub fn transitions(&self) -> &[Transition] {
        &self.transitions
    }

    /// Where the next shot goes once the buffer is full.
    pub const fn next(&self) -> usize {
        self.next
    }

    /// Adds a shot.
    pub fn push(&mut self, transition: Transition) {
        if self.transitions.len() < self.capacity {
            self.transitions.push(transition);
        } else {
            self.transitions[self.next] = transition;
            self.next = (self.next + 1) % self.capacity;
        }
    }

    /// Number of shots held.
    pub const fn len(&self) -> usize {
        self.transitions.len()
    }

    /// Whether there are none.
    pub const fn is_empty(&self) -> bool {
        self.transitions.is_empty()
    }

    /// `count` shots drawn uniformly, the same one possibly twice; none from an empty buffer.
    pub fn sample(&self, count: usize, rng: &mut (impl Rng + ?Sized)) -> Vec<Transition> {
        if self.is_empty() {
            return Vec::new();
        }
        (0..count).map(|_| self.transitions[rng.random_range(0..self.transitions.len())]).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::table::{Layout, Table};
    use rand::SeedableRng;
    use rand_xoshiro::Xoshiro256PlusPlus;

    #[test]
    fn the_oldest_shots_make_room_for_the_newest() {
        let observation = Observation::new(&Layout::opening(&Table::default()), 0);
        let mut buffer = ReplayBuffer::new(3);
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(1);
        assert!(buffer.sample(5, &mut rng).is_empty());
        for success in 0..5u8 {
            buffer.push(Transition {
                observation,
                conditions: Conditions::default(),
                action: [0.0; 5],
                success: f32::from(success),
            });
        }
        assert_eq!(buffer.len(), 3);
        let mut seen: Vec<f32> = buffer.sample(100, &mut rng).iter().map(|transition| transition.success).collect();
        seen.sort_by(f32::total_cmp);
        seen.dedup();
        assert_eq!(seen, [2.0, 3.0, 4.0]);
    }
}
