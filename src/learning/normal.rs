//! Normal random numbers (Box and Muller, 1958).

use std::f64::consts::TAU;

use rand::{Rng, RngExt};

/// Two independent standard normal numbers.
pub fn normal_pair(rng: &mut (impl Rng + ?Sized)) -> [f64; 2] {
    // 1 - u lies above 0, where the logarithm is finite.
    let radius = (-2.0 * (1.0 - rng.random::<f64>()).ln()).sqrt();
    let (sin, cos) = (TAU * rng.random::<f64>()).sin_cos();
    [radius * cos, radius * sin]
}
