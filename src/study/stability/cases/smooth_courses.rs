//! Courses of pressed balls in contacts without friction and restitution, in closed form: implemented independently of the
//! engine.

use glam::DVec2;
use rand::RngExt;
use rand_xoshiro::Xoshiro256PlusPlus;

use super::{Case, variants};
use crate::{
    physics::CueDegrees,
    study::stability::{Shot, Trace, draw},
    table::{Layout, Table},
};

pub const CASES: &[Case] = &[
    Case::new("a ball resting on another, smooth ball", smooth, behind)
        .checked("both move at their common speed until one of them rolls, to 1e-9 m", both_go_on),
    Case::new("a ball pressed between a smooth ball and cushion", smooth, squeezing)
        .checked("nothing moves until the pressing ball's spin has ended, to 1e-6 s and 1e-9 m", nothing_moves),
];

/// Accepted position error of the engine's resting contacts, m.
const ALLOWED: f64 = 1e-9;

/// Accepted time error, s. A slip that friction consumes in this time, 5e-6 m/s, may count as zero: it moves nothing by more
/// than 5e-12 m.
const TIME_TOLERANCE: f64 = 1e-6;

fn smooth() -> Vec<Table> {
    variants("smooth and dead", |table| {
        (table.ball_restitution, table.rail_restitution) = (0.0, 0.0);
        (table.ball_friction, table.rail_friction) = (Some(0.0), 0.0);
    })
}

/// Draws a stroke with a level cue and follow: the slip at the cloth drives the ball forwards.
fn follow(phi_deg: f64, rng: &mut Xoshiro256PlusPlus) -> CueDegrees {
    CueDegrees { b: rng.random_range(0.45..0.95), ..CueDegrees::centre(phi_deg, draw::log_uniform(rng, 0.02, 1.0)) }
}

/// Draws a shot straight at a touching ball, far from every cushion.
fn behind(table: &Table, rng: &mut Xoshiro256PlusPlus) -> Shot {
    let from = 0.3 * draw::position(table, rng);
    // A direction that is exact in binary, or any.
    let along = if rng.random_bool(0.5) { 0.0 } else { rng.random_range(-180.0..180.0_f64) };
    let second = from + 2.0 * table.radius * DVec2::from_angle(along.to_radians());
    let layout = Layout::new([from, second, 0.95 * table.reach()]);
    Shot { layout, cue: follow(along, rng) }
}

/// Checks that both balls move at their common speed: the cloth drives the rear ball exactly as much as it brakes the sliding
/// front ball.
fn both_go_on(table: &Table, shot: &Shot, trace: &Trace) -> Result<(), String> {
    let speed = 0.5 * trace.impulse.velocity.length();
    let direction = trace.impulse.velocity.normalize();
    let slip = table.radius * trace.impulse.spin.truncate().length() - speed;
    // Both slips decrease at 5/2 μg.
    let until = 0.99 * slip.min(speed) / (2.5 * table.sliding_friction * table.gravity);
    for ball in 0..2 {
        let expected = shot.layout.balls[ball] + until * speed * direction;
        let Some(piece) = trace.pieces[ball].iter().find(|piece| piece.end >= until) else {
            return Err(format!("ball {ball} has stopped by {until} s"));
        };
        let off = piece.segment.position_after(until - piece.segment.start).distance(expected);
        if off > ALLOWED {
            return Err(format!("ball {ball} is {off:e} m off at {until} s"));
        }
    }
    Ok(())
}

/// Draws a shot straight at a touching ball that also touches a cushion.
fn squeezing(table: &Table, rng: &mut Xoshiro256PlusPlus) -> Shot {
    // Along x the direction is exact: the pressing force has no transverse component.
    let along = 0.5 * draw::position(table, rng).y;
    let target = DVec2::new(table.half_length(), along);
    let from = target - DVec2::new(2.0 * table.radius, 0.0);
    let other = DVec2::new(-0.5 * table.half_length(), 0.0);
    Shot { layout: Layout::new([from, target, other]), cue: follow(0.0, rng) }
}

fn nothing_moves(table: &Table, shot: &Shot, trace: &Trace) -> Result<(), String> {
    let spin = table.radius * trace.impulse.spin.truncate().length();
    let lasts = spin / (2.5 * table.sliding_friction * table.gravity);
    let late = (trace.end.time - lasts).abs();
    let moved = (0..3).map(|ball| trace.end.balls[ball].position.distance(shot.layout.balls[ball])).fold(0.0, f64::max);
    if moved > ALLOWED || late > TIME_TOLERANCE {
        return Err(format!("pressed for {lasts} s, the balls end {late:e} s off and {moved:e} m away"));
    }
    Ok(())
}
