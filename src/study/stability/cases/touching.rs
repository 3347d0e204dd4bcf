//! Balls that touch exactly or almost.

use std::f64::consts::{FRAC_PI_3, PI};

use glam::DVec2;
use rand::RngExt;
use rand_xoshiro::Xoshiro256PlusPlus;

use super::{Case, presets};
use crate::{
    physics::CueDegrees,
    simulation::EventKind,
    study::stability::{Shot, Trace, draw},
    table::{BALLS, Layout, Table},
};

pub const CASES: &[Case] = &[
    Case::new("two balls exactly touching", presets, two)
        .checked("momentum is conserved and passes along the line of centres", passes_on),
    Case::new("three balls exactly touching", presets, three).checked("momentum is conserved", keeps_momentum),
    Case::new("three balls in line, touching or 1e-16 to 1e-6 m apart", presets, line)
        .checked("momentum is conserved", keeps_momentum),
    Case::new("two balls 1e-16 to 1e-6 m apart", presets, gap)
        .checked("they meet after exactly that distance", meets_after_the_gap),
];

/// Rounding of sums of velocities, in ε of the fastest.
const OPERATIONS: f64 = 64.0;

/// Draws a position at which a small group of three balls is clear of the cushions.
fn middle(table: &Table, rng: &mut Xoshiro256PlusPlus) -> DVec2 {
    draw::position(table, rng) * 0.6
}

fn any_stroke(rng: &mut Xoshiro256PlusPlus) -> CueDegrees {
    CueDegrees { speed: rng.random_range(0.3..8.0), ..draw::stroke(rng) }
}

fn two(table: &Table, rng: &mut Xoshiro256PlusPlus) -> Shot {
    let from = middle(table, rng);
    let target = from + 2.0 * table.radius * DVec2::from_angle(rng.random_range(-PI..PI));
    Shot { layout: draw::with_others(table, &[from, target], rng), cue: any_stroke(rng) }
}

fn three(table: &Table, rng: &mut Xoshiro256PlusPlus) -> Shot {
    let from = middle(table, rng);
    let around = rng.random_range(-PI..PI);
    let side = 2.0 * table.radius;
    let second = from + side * DVec2::from_angle(around);
    let third = from + side * DVec2::from_angle(around + FRAC_PI_3);
    Shot { layout: Layout::new([from, second, third]), cue: any_stroke(rng) }
}

fn some_gap(rng: &mut Xoshiro256PlusPlus) -> f64 {
    if rng.random_bool(0.5) { 0.0 } else { draw::log_uniform(rng, 1e-16, 1e-6) }
}

fn line(table: &Table, rng: &mut Xoshiro256PlusPlus) -> Shot {
    let from = middle(table, rng);
    let angle = if rng.random_bool(0.5) { 0.0 } else { rng.random_range(-PI..PI) };
    let along = DVec2::from_angle(angle);
    let second = from + (2.0 * table.radius + some_gap(rng)) * along;
    let third = second + (2.0 * table.radius + some_gap(rng)) * along;
    let b = draw::one_of(rng, &[-0.4, 0.0, 0.4]);
    Shot {
        layout: Layout::new([from, second, third]),
        cue: CueDegrees { b, ..CueDegrees::centre(angle.to_degrees(), rng.random_range(0.3..8.0)) },
    }
}

fn gap(table: &Table, rng: &mut Xoshiro256PlusPlus) -> Shot {
    let from = middle(table, rng);
    let along = DVec2::from_angle(rng.random_range(-PI..PI));
    let second = from + (2.0 * table.radius + draw::log_uniform(rng, 1e-16, 1e-6)) * along;
    let b = draw::one_of(rng, &[-0.4, 0.0, 0.4]);
    Shot {
        layout: draw::with_others(table, &[from, second], rng),
        cue: CueDegrees { b, ..CueDegrees::centre(along.to_angle().to_degrees(), rng.random_range(0.3..8.0)) },
    }
}

/// Returns the velocities just after time zero, when all collisions at that time are over.
fn after_the_stroke(trace: &Trace) -> [DVec2; BALLS] {
    std::array::from_fn(|ball| {
        let own = if ball == 0 { trace.impulse.velocity } else { DVec2::ZERO };
        trace.pieces[ball].first().map_or(own, |piece| piece.segment.velocity)
    })
}

fn keeps_momentum(_: &Table, _: &Shot, trace: &Trace) -> Result<(), String> {
    let gained = after_the_stroke(trace).iter().sum::<DVec2>() - trace.impulse.velocity;
    let allowed = OPERATIONS * f64::EPSILON * trace.impulse.velocity.length();
    if gained.length() <= allowed {
        Ok(())
    } else {
        Err(format!("momentum changes by {:e} m/s at once", gained.length()))
    }
}

fn passes_on(table: &Table, shot: &Shot, trace: &Trace) -> Result<(), String> {
    keeps_momentum(table, shot, trace)?;
    let along = (shot.layout.balls[1] - shot.layout.balls[0]).normalize();
    let approach = trace.impulse.velocity.dot(along);
    let speed = trace.impulse.velocity.length();
    let given = after_the_stroke(trace)[1].dot(along);
    let expected = 0.5 * (1.0 + table.ball_restitution) * approach.max(0.0);
    // If the balls hardly approach, rounding or the start of a resting contact decides.
    let certain = approach.abs() > 1e-2;
    if certain && (given - expected).abs() > OPERATIONS * f64::EPSILON * speed {
        return Err(format!("the other ball starts with {given} m/s along the line of centres, not {expected}"));
    }
    Ok(())
}

fn meets_after_the_gap(table: &Table, shot: &Shot, trace: &Trace) -> Result<(), String> {
    let gap = shot.layout.balls[0].distance(shot.layout.balls[1]) - 2.0 * table.radius;
    let Some(first) = trace.events.first() else { return Err("nothing happens".to_owned()) };
    if first.kind != EventKind::BallBall(0, 1) {
        return Err(format!("the first event is {first:?}"));
    }
    // The gap is known to the rounding of the positions; friction slows the ball by less than that on this distance.
    let travelled = first.time * trace.impulse.velocity.length();
    let allowed = OPERATIONS * f64::EPSILON * table.length + 2e-5 * gap.abs();
    let off = (travelled - gap.max(0.0)).abs();
    if off <= allowed { Ok(()) } else { Err(format!("meets after {travelled:e} m, not {gap:e} m")) }
}
