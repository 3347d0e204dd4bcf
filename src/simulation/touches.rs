//! Which balls touch cushions or each other.

use glam::DVec2;

use super::{Constants, Rail, extrapolation::State, predict::TOUCHING};
use crate::physics::{MAX_TOUCHES, Touch};

/// Contacts that open more slowly than this and are pressed stay closed, m/s: they would close again within 1e-8 s, without
/// end where two of them feed each other.
pub const SLOWEST_OPENING: f64 = 1e-9;

/// Pairs of balls, in the order used everywhere.
pub const PAIRS: [(usize, usize); 3] = [(0, 1), (0, 2), (1, 2)];

/// The contacts, in a fixed order.
#[derive(Clone, Copy, Debug)]
pub struct Touches {
    list: [Touch; MAX_TOUCHES],
    count: usize,
}

impl Touches {
    const NONE: Touch = Touch { first: 0, second: None, rail_normal: DVec2::ZERO };

    /// All contacts of the balls that open and close no faster than `slowest`, m/s.
    pub fn of(constants: &Constants, balls: &State, slowest: f64) -> Self {
        let mut touches = Self { list: [Self::NONE; MAX_TOUCHES], count: 0 };
        for (first, ball) in balls.iter().enumerate() {
            for rail in Rail::ALL {
                let normal = rail.normal();
                let gap = normal.abs().dot(constants.reach) + ball.position.dot(normal);
                if gap <= TOUCHING {
                    touches.add(Touch { first, second: None, rail_normal: normal }, balls, slowest);
                }
            }
        }
        for (first, second) in PAIRS {
            let gap = balls[first].position.distance(balls[second].position) - 2.0 * constants.radius;
            if gap <= TOUCHING {
                touches.add(Touch { first, second: Some(second), rail_normal: DVec2::ZERO }, balls, slowest);
            }
        }
        touches
    }

    fn add(&mut self, touch: Touch, balls: &State, slowest: f64) {
        if touch.opening_speed(balls).abs() <= slowest && self.count < MAX_TOUCHES {
            self.list[self.count] = touch;
            self.count += 1;
        }
    }

    /// Keeps only the contacts asked for; tells whether any had to go.
    pub fn retain(&mut self, mut wanted: impl FnMut(&Touch) -> bool) -> bool {
        let before = self.count;
        self.count = 0;
        for index in 0..before {
            if wanted(&self.list[index]) {
                self.list[self.count] = self.list[index];
                self.count += 1;
            }
        }
        self.count < before
    }

    /// The contacts.
    pub fn as_slice(&self) -> &[Touch] {
        &self.list[..self.count]
    }
}
