//! Trajectories of balls during one step of a resting contact, and their end at rest.

use glam::{DVec2, DVec3};

use super::{MAX_DEVIATION, Resting};
use crate::{
    physics::BallState,
    simulation::{Constants, Course, Curve, Tolerance},
    table::BALLS,
};

impl Resting {
    /// Returns half the acceleration at the start of the step, and the polynomials of the rest of a ball's trajectory.
    pub fn course(&self, ball: usize) -> (DVec2, Option<Box<Course>>) {
        let h = self.step;
        let (p0, p1) = (&self.begin[ball], &self.end[ball]);
        let (a0, a1) = (self.first.linear[ball], self.last.linear[ball]);
        let moved = p1.position - p0.position;
        let (v0, v1) = (p0.velocity, p1.velocity);
        let square = h * h;
        let (cube, fourth) = (h * square, square * square);
        let by_velocities = 0.5 * h * (v0 + v1) + square / 12.0 * (a0 - a1);
        let position = if h > self.constants.tolerance.shortest_quintic || moved.distance(by_velocities) > MAX_DEVIATION
        {
            [
                (20.0 * moved - h * (8.0 * v1 + 12.0 * v0) - h * h * (3.0 * a0 - a1)) / (2.0 * cube),
                (-30.0 * moved + h * (14.0 * v1 + 16.0 * v0) + h * h * (3.0 * a0 - 2.0 * a1)) / (2.0 * fourth),
                (12.0 * moved - 6.0 * h * (v1 + v0) - h * h * (a0 - a1)) / (2.0 * (h * fourth)),
            ]
        } else {
            let mean = (v1 - v0) / h;
            [(3.0 * mean - 2.0 * a0 - a1) / (3.0 * h), (a0 + a1 - 2.0 * mean) / (4.0 * h * h), DVec2::ZERO]
        };
        let (w0, w1) = (self.first.angular[ball], self.last.angular[ball]);
        let mean = (p1.spin - p0.spin) / h;
        let spin = [w0, (3.0 * mean - 2.0 * w0 - w1) / h, (w0 + w1 - 2.0 * mean) / (h * h)];
        (0.5 * a0, Some(Box::new(Course::Contact(Curve { position, spin }))))
    }

    /// Whether no member moves or rolls at the end of this step. A ball that only spins about the vertical counts as still: if it presses,
    /// its contact restarts.
    pub fn is_still(&self) -> bool {
        let Constants { radius, tolerance: Tolerance { still, .. }, .. } = self.constants;
        let is_slow = |ball: &BallState| {
            ball.velocity.length_squared().max(radius * radius * ball.spin.truncate().length_squared()) < still * still
        };
        (0..BALLS).all(|ball| !self.members[ball] || is_slow(&self.end[ball]))
    }

    /// Sets the members to rest at the end of this step.
    pub fn come_to_rest(&mut self) {
        for (ball, _) in self.end.iter_mut().zip(self.members).filter(|(_, member)| *member) {
            ball.velocity = DVec2::ZERO;
            ball.spin = DVec3::new(0.0, 0.0, ball.spin.z);
        }
    }
}
