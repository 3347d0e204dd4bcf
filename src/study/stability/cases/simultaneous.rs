//! Exactly simultaneous events.

use glam::DVec2;
use rand::RngExt;
use rand_xoshiro::Xoshiro256PlusPlus;

use super::{Case, presets};
use crate::{
    physics::{CueDegrees, Motion},
    simulation::{EventKind, Rail},
    study::stability::{Shot, Trace, draw},
    table::{Layout, Table},
};

pub const CASES: &[Case] = &[
    Case::new("two object balls hit at the same moment", presets, fork)
        .checked("both are hit at the same time and leave symmetrically", hits_both),
    Case::new("ball and cushion hit at the same moment", presets, ball_at_cushion).checked(
        "both are hit at the same time, with the same result anywhere along the cushion",
        hits_ball_and_cushion,
    ),
];

/// Times that differ by less count as simultaneous, s: a ball moves 1e-12 m meanwhile.
const MOMENT: f64 = 1e-13;

/// Velocities that differ by less count as equal, m/s.
const VELOCITY_TOLERANCE: f64 = 1e-9;

/// Draws a shot along any line into the gap between two balls that are placed symmetrically on both sides.
fn fork(table: &Table, rng: &mut Xoshiro256PlusPlus) -> Shot {
    let beside = table.radius * if rng.random_bool(0.3) { 1.0 } else { rng.random_range(1.0..1.6) };
    let along = if rng.random_bool(0.3) { DVec2::X } else { DVec2::from_angle(rng.random_range(-3.1..3.1)) };
    let middle = DVec2::new(rng.random_range(-0.2..0.2), 0.0);
    let room = table.half_width() - beside - table.radius;
    let from = middle - rng.random_range(0.2..room.min(0.8)) * along;
    let b = draw::one_of(rng, &[-0.3, 0.0, 0.4]);
    let speed = if rng.random_bool(0.5) { rng.random_range(0.3..1.0) } else { rng.random_range(2.0..8.0) };
    Shot {
        layout: Layout::new([from, middle + beside * along.perp(), middle - beside * along.perp()]),
        cue: CueDegrees { b, ..CueDegrees::centre(along.to_angle().to_degrees(), speed) },
    }
}

/// Checks that both balls are hit simultaneously and leave as mirror images, unless the cue ball stops before.
fn hits_both(_: &Table, shot: &Shot, trace: &Trace) -> Result<(), String> {
    let is_hit = |ball: usize| trace.events.iter().any(|event| event.kind == EventKind::BallBall(0, ball));
    if !is_hit(1) && !is_hit(2) {
        return Ok(());
    }
    check_simultaneous(trace, EventKind::BallBall(0, 2))?;
    let [_, one, other] = shot.layout.balls;
    let across = (one - other).normalize();
    let [left, right] = [1, 2].map(|ball| leaves_with(trace, ball));
    let mirrored = right - 2.0 * right.dot(across) * across;
    if left.distance(mirrored) > VELOCITY_TOLERANCE {
        return Err(format!("the balls leave with {left} and {right} m/s, which are not symmetric"));
    }
    Ok(())
}

/// Returns the first velocity of a ball that was at rest, m/s.
fn leaves_with(trace: &Trace, ball: usize) -> DVec2 {
    let first = trace.pieces[ball].iter().find(|piece| piece.segment.motion != Motion::Stationary);
    first.map_or(DVec2::ZERO, |piece| piece.segment.velocity)
}

/// Checks that ball 1 is hit when `other` happens: whichever event comes first leaves the cue ball on its course to the other.
fn check_simultaneous(trace: &Trace, other: EventKind) -> Result<(), String> {
    let at = |kind| trace.events.iter().find(|event| event.kind == kind).map(|event| event.time);
    match (at(EventKind::BallBall(0, 1)), at(other)) {
        (Some(first), Some(second)) if (first - second).abs() <= MOMENT => Ok(()),
        (first, second) => Err(format!("hit at different times: ball 1 at {first:?}, the other at {second:?} s")),
    }
}

/// Draws an oblique shot into the upper cushion, in which the cue ball hits cushion and ball simultaneously.
fn ball_at_cushion(table: &Table, rng: &mut Xoshiro256PlusPlus) -> Shot {
    let direction = DVec2::from_angle(rng.random_range(0.5..1.2));
    let at = DVec2::new(rng.random_range(-0.2..0.2), table.half_width());
    // The other ball is next to this point or below it, and ahead.
    let beside = 2.0 * table.radius * DVec2::from_angle(rng.random_range(-0.3..0.0));
    let from = at - rng.random_range(0.2..0.6) * direction;
    let other = DVec2::new(-0.8, -0.8) * table.reach();
    let b = draw::one_of(rng, &[-0.3, 0.0, 0.4]);
    let phi_deg = direction.to_angle().to_degrees();
    Shot {
        layout: Layout::new([from, at + beside, other]),
        cue: CueDegrees { b, ..CueDegrees::centre(phi_deg, rng.random_range(2.0..8.0)) },
    }
}

/// Checks that both are hit simultaneously, and that the ball leaves as it does elsewhere along the cushion, with other
/// rounding.
fn hits_ball_and_cushion(table: &Table, shot: &Shot, trace: &Trace) -> Result<(), String> {
    check_simultaneous(trace, EventKind::BallRail(0, Rail::Top))?;
    let elsewhere = Layout::new(shot.layout.balls.map(|ball| ball + DVec2::new(0.012_345_678_9, 0.0)));
    let again = Trace::of(table, &Shot { layout: elsewhere, ..*shot });
    let [here, there] = [trace, &again].map(|trace| leaves_with(trace, 1));
    if here.distance(there) > VELOCITY_TOLERANCE {
        return Err(format!("ball 1 leaves with {here} m/s, and with {there} m/s a little farther along the cushion"));
    }
    Ok(())
}
