//! The course of a ball along one step of a resting contact.

use glam::DVec2;

use super::{MOST_STRAY, Resting};
use crate::simulation::segment::Curve;

impl Resting {
    /// Half the acceleration at the start of the step, and the rest of a ball's course as polynomials.
    pub fn course(&self, ball: usize) -> (DVec2, Curve) {
        let h = self.step;
        let (p0, p1) = (&self.begin[ball], &self.end[ball]);
        let (a0, a1) = (self.first.linear[ball], self.last.linear[ball]);
        let moved = p1.position - p0.position;
        let (v0, v1) = (p0.velocity, p1.velocity);
        let square = h * h;
        let (cube, fourth) = (h * square, square * square);
        let by_velocities = 0.5 * h * (v0 + v1) + square / 12.0 * (a0 - a1);
        let position = if h > self.constants.tolerance.shortest_quintic || moved.distance(by_velocities) > MOST_STRAY {
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
        (0.5 * a0, Curve { position, spin })
    }
}
