//! Balls in resting contact that have come to rest.

use glam::{DVec2, DVec3};

use super::Resting;
use crate::{
    physics::BallState,
    simulation::{Constants, Tolerance},
    table::BALLS,
};

impl Resting {
    /// Whether no member moves or rolls any more at the end of this step. One that only spins about its vertical counts as still: if it
    /// presses, its contact begins anew.
    pub fn is_still(&self) -> bool {
        let Constants { radius, tolerance: Tolerance { still, .. }, .. } = self.constants;
        let is_slow = |ball: &BallState| {
            ball.velocity.length_squared().max(radius * radius * ball.spin.truncate().length_squared()) < still * still
        };
        (0..BALLS).all(|ball| !self.members[ball] || is_slow(&self.end[ball]))
    }

    /// Brings the members to rest at the end of this step.
    pub fn come_to_rest(&mut self) {
        for (ball, _) in self.end.iter_mut().zip(self.members).filter(|(_, member)| *member) {
            ball.velocity = DVec2::ZERO;
            ball.spin = DVec3::new(0.0, 0.0, ball.spin.z);
        }
    }
}
