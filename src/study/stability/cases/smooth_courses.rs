//! Courses of pressed balls in contacts without friction and bounce, in closed form: written apart from the engine.

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
        .checked("both go on at the speed that they share until one of them rolls, to 1e-9 m", both_go_on),
    Case::new("a ball pressed between a smooth ball and cushion", smooth, squeezing)
        .checked("nothing moves until the pressing ball's spin has died down, to 1e-6 s and 1e-9 m", nothing_moves),
];

/// Error in place that the engine's resting contacts may have, m.
const ALLOWED: f64 = 1e-9;

/// Error in time, s. A slip that friction uses up in this time, 5e-6 m/s, may be taken for none: it moves nothing by more
/// than 5e-12 m.
const MOMENT: f64 = 1e-6;

fn smooth() -> Vec<Table> {
    variants("smooth and dead", |table| {
        (table.ball_restitution, table.rail_restitution) = (0.0, 0.0);
        (table.ball_friction, table.rail_friction) = (Some(0.0), 0.0);
    })
}

/// Level, with follow: the slip at the cloth drives the ball on.
fn follow(phi_deg: f64, rng: &mut Xoshiro256PlusPlus) -> CueDegrees {
    CueDegrees { b: rng.random_range(0.45..0.95), ..CueDegrees::centre(phi_deg, draw::log_uniform(rng, 0.02, 1.0)) }
}

/// Straight at a ball that it touches, far from every cushion.
fn behind(table: &Table, rng: &mut Xoshiro256PlusPlus) -> Shot {
    let from = 0.3 * draw::place(table, rng);
    // Exact in binary or not.
    let along = if rng.random_bool(0.5) { 0.0 } else { rng.random_range(-180.0..180.0_f64) };
    let second = from + 2.0 * table.radius * DVec2::from_angle(along.to_radians());
    let layout = Layout::new([from, second, 0.95 * table.reach()]);
    Shot { layout, cue: follow(along, rng) }
}

/// The cloth drives the ball behind just as hard as it holds the one in front, which slides: their speed stays.
fn both_go_on(table: &Table, shot: &Shot, trace: &Trace) -> Result<(), String> {
    let speed = 0.5 * trace.impulse.velocity.length();
    let direction = trace.impulse.velocity.normalize();
    let slip = table.radius * trace.impulse.spin.truncate().length() - speed;
    // Both slips fall at 5/2 μg.
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

/// Straight at a ball that it touches and that stands on a cushion.
fn squeezing(table: &Table, rng: &mut Xoshiro256PlusPlus) -> Shot {
    // Along x the direction is exact: what presses has no part aside.
    let along = 0.5 * draw::place(table, rng).y;
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
    if moved > ALLOWED || late > MOMENT {
        return Err(format!("pressed for {lasts} s, the balls end {late:e} s off and {moved:e} m away"));
    }
    Ok(())
}
