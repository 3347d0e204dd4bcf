//! Random draws that the shot generators share.

use std::f64::consts::TAU;

use glam::DVec2;
use rand::{Rng, RngExt};

use crate::{
    physics::CueDegrees,
    table::{BALLS, Layout, Table},
};

/// Draws a number whose decimal exponent is uniformly distributed.
pub fn log_uniform(rng: &mut (impl Rng + ?Sized), low: f64, high: f64) -> f64 {
    10_f64.powf(rng.random_range(low.log10()..high.log10()))
}

/// Draws one of `choices` with equal probability.
pub fn one_of<T: Copy>(rng: &mut (impl Rng + ?Sized), choices: &[T]) -> T {
    choices[rng.random_range(0..choices.len())]
}

/// Draws one of the table's corners, as the signs of its coordinates.
pub fn corner(rng: &mut (impl Rng + ?Sized)) -> DVec2 {
    DVec2::new(one_of(rng, &[-1.0, 1.0]), one_of(rng, &[-1.0, 1.0]))
}

/// Draws a tip position anywhere on the ball, in one of eight cases exactly at its rim.
pub fn tip(rng: &mut (impl Rng + ?Sized)) -> (f64, f64) {
    let share: f64 = if rng.random_bool(0.125) { 1.0 } else { rng.random::<f64>().sqrt() };
    let around = DVec2::from_angle(rng.random_range(0.0..TAU));
    let mut tip = share * around;
    // Rounding may move a position at the rim beyond it.
    while tip.length_squared() > 1.0 {
        tip *= 1.0 - f64::EPSILON;
    }
    (tip.x, tip.y)
}

/// Draws a stroke from the full range of every input.
pub fn stroke(rng: &mut (impl Rng + ?Sized)) -> CueDegrees {
    let (a, b) = tip(rng);
    let speed = if rng.random_bool(0.5) { rng.random_range(0.3..8.0) } else { log_uniform(rng, 1e-6, 60.0) };
    let theta_deg = if rng.random_bool(0.5) { rng.random_range(0.0..20.0) } else { rng.random_range(0.0..89.9) };
    CueDegrees { a, b, theta_deg, phi_deg: rng.random_range(-180.0..180.0), speed }
}

/// Draws a position of a ball's centre on the table.
pub fn position(table: &Table, rng: &mut (impl Rng + ?Sized)) -> DVec2 {
    let reach = table.reach();
    DVec2::new(rng.random_range(-reach.x..=reach.x), rng.random_range(-reach.y..=reach.y))
}

/// Draws valid positions for the other balls, given the valid positions of one or two.
pub fn with_others(table: &Table, given: &[DVec2], rng: &mut (impl Rng + ?Sized)) -> Layout {
    loop {
        let layout =
            Layout::new(std::array::from_fn(|ball| given.get(ball).copied().unwrap_or_else(|| position(table, rng))));
        if given.len() >= BALLS || layout.validate(table).is_ok() {
            return layout;
        }
    }
}
