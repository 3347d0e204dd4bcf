//! Adversarial shots: balls that touch or almost touch, at cushions, in corners and in line, with strokes that make them hard.

use std::f64::consts::{FRAC_PI_4, TAU};

use glam::DVec2;
use rand::{Rng, RngExt};

use super::{Shot, draw};
use crate::{
    physics::CueDegrees,
    table::{BALLS, Layout, Table},
};

/// Draws a shot biased towards hard cases.
pub fn shot<R: Rng>(table: &Table, rng: &mut R) -> Shot {
    let layout = layout(table, rng);
    Shot { layout, cue: stroke(table, &layout, rng) }
}

fn layout(table: &Table, rng: &mut impl Rng) -> Layout {
    loop {
        let mut balls = [DVec2::ZERO; BALLS];
        for ball in 0..BALLS {
            balls[ball] = hard_position(table, &balls[..ball], rng);
        }
        // Any of them may be the cue ball.
        let first = rng.random_range(0..BALLS);
        balls.swap(0, first);
        let layout = Layout::new(balls);
        if layout.validate(table).is_ok() {
            return layout;
        }
    }
}

/// Draws a gap: exactly zero, or 1e-16 to 1e-6 m; sometimes an overlap that is still accepted, also if two overlaps add up: a
/// ball that starts inside a cushion is moved onto its nose, and thereby further into its neighbour.
fn gap(rng: &mut impl Rng) -> f64 {
    match rng.random_range(0..8) {
        0..3 => 0.0,
        3 => -draw::log_uniform(rng, 1e-16, 4.5e-10),
        _ => draw::log_uniform(rng, 1e-16, 1e-6),
    }
}

fn hard_position(table: &Table, others: &[DVec2], rng: &mut impl Rng) -> DVec2 {
    let reach = table.reach();
    let signs = draw::corner(rng);
    let anywhere = draw::position(table, rng);
    let diameter = 2.0 * table.radius;
    match (rng.random_range(0..10), others) {
        // At a long or a short cushion, or in a corner.
        (0, _) => DVec2::new(anywhere.x, signs.y * (reach.y - gap(rng))),
        (1, _) => DVec2::new(signs.x * (reach.x - gap(rng)), anywhere.y),
        (2, _) => signs * (reach - DVec2::new(gap(rng), gap(rng))),
        // Against another ball, in any direction or in one that is exact in binary.
        (3..6, [.., other]) => {
            let angle = if rng.random_bool(0.5) {
                rng.random_range(0.0..TAU)
            } else {
                FRAC_PI_4 * f64::from(rng.random_range(0..8))
            };
            *other + (diameter + gap(rng)) * DVec2::from_angle(angle)
        }
        // Against another ball and a cushion.
        (6, [.., other]) => {
            let y = signs.y * (reach.y - gap(rng));
            let across = (y - other.y).abs();
            let along = ((diameter + gap(rng)).powi(2) - across * across).max(0.0).sqrt();
            DVec2::new(other.x + signs.x * along, y)
        }
        // Against both others, or in line with them.
        (7, [first, second]) => {
            let middle = 0.5 * (*first + *second);
            let half = 0.5 * first.distance(*second);
            let height = ((diameter + gap(rng)).powi(2) - half * half).max(0.0).sqrt();
            middle + signs.x * height * (*second - *first).normalize_or(DVec2::X).perp()
        }
        (8, [first, second]) => *second + (diameter + gap(rng)) * (*second - *first).normalize_or(DVec2::X),
        _ => anywhere,
    }
}

fn stroke(table: &Table, layout: &Layout, rng: &mut impl Rng) -> CueDegrees {
    let cue = draw::stroke(rng);
    let tiny = draw::one_of(rng, &[-1.0, 1.0]) * draw::log_uniform(rng, 1e-16, 1e-9);
    // A ball struck with a level cue at 2/5 of the radius above the centre rolls at once.
    let (a, b, theta_deg) = match rng.random_range(0..8) {
        0 => (0.0, 0.0, 0.0),
        1 => (0.0, 0.4, 0.0),
        2 => (0.0, 0.4 + tiny, 0.0),
        3 => (tiny, 0.4, 0.0),
        4 => (cue.a, cue.b, 0.0),
        5 => (cue.a, cue.b, rng.random_range(85.0..89.9)),
        _ => (cue.a, cue.b, cue.theta_deg),
    };
    let phi_deg = match rng.random_range(0..6) {
        0 => draw::one_of(rng, &[-135.0, -90.0, -45.0, 0.0, 45.0, 90.0, 135.0, 180.0]),
        1..4 => aim(table, layout, rng),
        _ => cue.phi_deg,
    };
    CueDegrees { a, b, theta_deg, phi_deg, speed: cue.speed }
}

/// Draws a direction towards another ball, degrees: full, grazing its edge at any depth, or just missing it.
fn aim(table: &Table, layout: &Layout, rng: &mut impl Rng) -> f64 {
    let to = layout.balls[rng.random_range(1..BALLS)] - layout.balls[0];
    let edge = (2.0 * table.radius / to.length()).min(1.0).asin();
    let depth = match rng.random_range(0..4) {
        0 => 1.0,
        1 => rng.random::<f64>(),
        2 => draw::log_uniform(rng, 1e-16, 1e-3),
        _ => -draw::log_uniform(rng, 1e-16, 1e-3),
    };
    let side = draw::one_of(rng, &[-1.0, 1.0]);
    (to.to_angle() + side * edge * (1.0 - depth)).to_degrees()
}
