//! Drawing numbers: what the generators of shots have in common.

use std::f64::consts::TAU;

use glam::DVec2;
use rand::{Rng, RngExt};

use crate::{
    physics::CueDegrees,
    table::{BALLS, Layout, Table},
};

/// A number whose decimal exponent is drawn evenly.
pub fn log_uniform(rng: &mut (impl Rng + ?Sized), low: f64, high: f64) -> f64 {
    10_f64.powf(rng.random_range(low.log10()..high.log10()))
}

/// One of these, each as likely as the others.
pub fn one_of<T: Copy>(rng: &mut (impl Rng + ?Sized), choices: &[T]) -> T {
    choices[rng.random_range(0..choices.len())]
}

/// One of the table's corners by the signs of its places.
pub fn corner(rng: &mut (impl Rng + ?Sized)) -> DVec2 {
    DVec2::new(one_of(rng, &[-1.0, 1.0]), one_of(rng, &[-1.0, 1.0]))
}

/// A tip that meets the ball anywhere, in one of eight cases exactly at its rim.
pub fn tip(rng: &mut (impl Rng + ?Sized)) -> (f64, f64) {
    let share: f64 = if rng.random_bool(0.125) { 1.0 } else { rng.random::<f64>().sqrt() };
    let around = DVec2::from_angle(rng.random_range(0.0..TAU));
    let mut tip = share * around;
    // At the rim rounding may lead beyond it.
    while tip.length_squared() > 1.0 {
        tip *= 1.0 - f64::EPSILON;
    }
    (tip.x, tip.y)
}

/// A stroke from the full range of every input.
pub fn stroke(rng: &mut (impl Rng + ?Sized)) -> CueDegrees {
    let (a, b) = tip(rng);
    let speed = if rng.random_bool(0.5) { rng.random_range(0.3..8.0) } else { log_uniform(rng, 1e-6, 60.0) };
    let theta_deg = if rng.random_bool(0.5) { rng.random_range(0.0..20.0) } else { rng.random_range(0.0..89.9) };
    CueDegrees { a, b, theta_deg, phi_deg: rng.random_range(-180.0..180.0), speed }
}

/// A place for a ball's centre on the table.
pub fn place(table: &Table, rng: &mut (impl Rng + ?Sized)) -> DVec2 {
    let reach = table.reach();
    DVec2::new(rng.random_range(-reach.x..=reach.x), rng.random_range(-reach.y..=reach.y))
}

/// Puts the other balls anywhere that is possible beside the one or two given, whose places are known to be possible.
pub fn with_others(table: &Table, given: &[DVec2], rng: &mut (impl Rng + ?Sized)) -> Layout {
    loop {
        let layout =
            Layout::new(std::array::from_fn(|ball| given.get(ball).copied().unwrap_or_else(|| place(table, rng))));
        if given.len() >= BALLS || layout.validate(table).is_ok() {
            return layout;
        }
    }
}
