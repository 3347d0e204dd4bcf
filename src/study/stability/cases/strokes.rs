//! Extreme strokes: almost no slip or spin, the slowest and the fastest, massé, the tip at the rim.

use rand::RngExt;
use rand_xoshiro::Xoshiro256PlusPlus;

use super::{Case, lone, presets};
use crate::{
    physics::CueDegrees,
    study::stability::{Generator, Shot, draw},
    table::{Layout, Table},
};

const fn case(name: &'static str, shot: Generator) -> Case {
    Case::new(name, presets, shot)
        .checked("a ball without impacts stops where the closed form predicts", lone::stops_where_the_closed_form_says)
}

pub const CASES: &[Case] = &[
    case("next to no slip: relative 1e-16 to 1e-6", next_to_no_slip),
    case("spins of 1e-16 to 1e-9", tiny_spins),
    case("speeds from 1e-6 to 60 m/s", all_speeds),
    case("massé at 89° to 89.999°", masse),
    case("tip at the rim of the ball", rim),
];

/// Returns a shot with a random layout.
fn with(table: &Table, rng: &mut Xoshiro256PlusPlus, stroke: CueDegrees) -> Shot {
    Shot { layout: Layout::random(table, rng), cue: stroke }
}

/// Draws a speed, half of the time so low that the ball often meets nothing.
fn speed(rng: &mut Xoshiro256PlusPlus) -> f64 {
    if rng.random_bool(0.5) { rng.random_range(0.05..0.5) } else { rng.random_range(0.5..8.0) }
}

fn tiny(rng: &mut Xoshiro256PlusPlus, low: f64, high: f64) -> f64 {
    draw::one_of(rng, &[-1.0, 1.0]) * draw::log_uniform(rng, low, high)
}

/// A ball struck with a level cue at 2/5 of the radius above the centre rolls at once.
fn next_to_no_slip(table: &Table, rng: &mut Xoshiro256PlusPlus) -> Shot {
    let b = 0.4 * (1.0 + tiny(rng, 1e-16, 1e-6));
    let stroke = CueDegrees { b, ..CueDegrees::centre(rng.random_range(-180.0..180.0), speed(rng)) };
    with(table, rng, stroke)
}

fn tiny_spins(table: &Table, rng: &mut Xoshiro256PlusPlus) -> Shot {
    let (a, b, theta_deg) = (tiny(rng, 1e-16, 1e-9), tiny(rng, 1e-16, 1e-9), draw::log_uniform(rng, 1e-16, 1e-9));
    let b = if rng.random_bool(0.5) { b } else { 0.4 };
    let stroke = CueDegrees { a, b, theta_deg, phi_deg: rng.random_range(-180.0..180.0), speed: speed(rng) };
    with(table, rng, stroke)
}

fn all_speeds(table: &Table, rng: &mut Xoshiro256PlusPlus) -> Shot {
    let stroke = CueDegrees { speed: draw::log_uniform(rng, 1e-6, 60.0), ..draw::stroke(rng) };
    with(table, rng, stroke)
}

fn masse(table: &Table, rng: &mut Xoshiro256PlusPlus) -> Shot {
    let stroke = CueDegrees { theta_deg: rng.random_range(89.0..89.999), ..draw::stroke(rng) };
    with(table, rng, stroke)
}

fn rim(table: &Table, rng: &mut Xoshiro256PlusPlus) -> Shot {
    let (mut a, mut b) = draw::tip(rng);
    let length = a.hypot(b);
    (a, b) = (a / length, b / length);
    while a * a + b * b > 1.0 {
        (a, b) = (a * (1.0 - f64::EPSILON), b * (1.0 - f64::EPSILON));
    }
    let stroke = CueDegrees { a, b, speed: speed(rng), ..draw::stroke(rng) };
    with(table, rng, stroke)
}
