//! The motion of a ball at one time of a film, and its fit to the course of the ball.

use glam::{DVec2, DVec3};

use super::film::Sample;
use crate::{
    physics::Impulse,
    statistics::{Fit, fit},
};

/// Scale of the robust loss, m: residuals far above it are damped.
const ROBUST: f64 = 0.02;

/// Appends the distances between simulated and filmed positions along both axes, damped: linear near zero, logarithmic beyond
/// [`ROBUST`].
pub fn extend_with_misses(residuals: &mut Vec<f64>, positions: &[DVec2], samples: &[Sample]) {
    for (sample, position) in samples.iter().zip(positions) {
        let miss = *position - sample.position;
        residuals.extend([miss.x, miss.y].map(|miss| ROBUST * (miss / ROBUST).asinh()));
    }
}

/// Fits from every start, and returns the fit with the smallest sum of squares.
pub fn best_fit<const N: usize>(
    starts: impl IntoIterator<Item = [f64; N]>,
    steps: [f64; N],
    rounds: usize,
    mut residuals: impl FnMut(&[f64; N], &mut Vec<f64>),
) -> Option<Fit<N>> {
    let fits = starts.into_iter().map(|start| fit(start, steps, rounds, &mut residuals));
    fits.reduce(|best, found| if found.squares < best.squares { found } else { best })
}

/// The motion of a ball at one time: the parameters of a fit to its course.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion {
    /// Centre, m.
    pub position: DVec2,
    /// Velocity, m/s.
    pub velocity: DVec2,
    /// Slip on the cloth, m/s.
    pub slip: DVec2,
    /// Speed of the side spin at the equator, `R w_z`, m/s.
    pub side: f64,
}

impl Motion {
    /// Returns the motion as seven numbers, in the order of the fields.
    pub fn numbers(&self) -> [f64; 7] {
        let Self { position, velocity, slip, side } = *self;
        [position.x, position.y, velocity.x, velocity.y, slip.x, slip.y, side]
    }

    /// Creates the motion from seven numbers.
    pub fn of([x, y, vx, vy, ux, uy, side]: [f64; 7]) -> Self {
        Self { position: DVec2::new(x, y), velocity: DVec2::new(vx, vy), slip: DVec2::new(ux, uy), side }
    }

    /// Returns the impulse that sets a ball at rest in this motion.
    pub fn impulse(&self, radius: f64) -> Impulse {
        let Self { velocity, slip, side, .. } = *self;
        Impulse::on_cloth(velocity, DVec3::new(slip.y - velocity.y, velocity.x - slip.x, side) / radius)
    }
}
