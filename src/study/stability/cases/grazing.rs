//! A ball that just touches another, or just misses it. The outcome follows from exactly known numbers.

use glam::DVec2;
use rand::RngExt;
use rand_xoshiro::Xoshiro256PlusPlus;

use super::{Case, presets};
use crate::{
    physics::CueDegrees,
    simulation::EventKind,
    study::stability::{Shot, Trace, draw},
    table::{Layout, Table},
};

pub const CASES: &[Case] = &[Case::new("grazing contact, relative depth 1e-15 to 1e-3", presets, shot)
    .checked("hit or missed as the exact numbers predict", check)];

/// Depths below this share of the diameter are indistinguishable from zero: the squares of diameter and distance are each
/// rounded to half an ε, and so is the root of their difference.
const UNDECIDED: f64 = 4.0 * f64::EPSILON;

/// The ball moves exactly along x, because neither its velocity nor its spin has a sideways effect.
fn shot(table: &Table, rng: &mut Xoshiro256PlusPlus) -> Shot {
    let depth = draw::one_of(rng, &[-1.0, 1.0]) * draw::log_uniform(rng, 1e-15, 1e-3);
    let beside = 2.0 * table.radius * (1.0 - depth) * draw::one_of(rng, &[-1.0, 1.0]);
    let from = rng.random_range(0.1..0.8);
    let struck = DVec2::new(-from, 0.0);
    // The second object ball stays out of the way.
    let other = DVec2::new(rng.random_range(-1.0..1.0), -0.9 * table.half_width() * beside.signum());
    let b = draw::one_of(rng, &[-0.5, 0.0, 0.4, 0.7]);
    let speed = rng.random_range(1.5..8.0);
    Shot {
        layout: Layout::new([struck, DVec2::new(0.0, beside), other]),
        cue: CueDegrees { b, ..CueDegrees::centre(0.0, speed) },
    }
}

fn check(table: &Table, shot: &Shot, trace: &Trace) -> Result<(), String> {
    let diameter = 2.0 * table.radius;
    let depth = 1.0 - shot.layout.balls[1].y.abs() / diameter;
    let hit = matches!(
        trace.events.iter().find(|event| matches!(event.kind, EventKind::BallBall(..) | EventKind::BallRail(..))),
        Some(event) if event.kind == EventKind::BallBall(0, 1)
    );
    // A ball with backspin may return before it gets there.
    let passes =
        trace.pieces[0].iter().any(|piece| piece.segment.position_after(piece.end - piece.segment.start).x > 0.0);
    if depth > UNDECIDED && !hit && passes {
        return Err(format!("passes through at a relative depth of {depth:e}"));
    }
    if depth < -UNDECIDED && hit {
        return Err(format!("hits over a relative gap of {:e}", -depth));
    }
    Ok(())
}
