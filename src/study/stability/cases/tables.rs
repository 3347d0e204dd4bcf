//! Extreme tables: friction, restitution and size at the limits of the accepted range.

use rand::RngExt;
use rand_xoshiro::Xoshiro256PlusPlus;

use super::{Case, variants, with_restitution};
use crate::{
    physics::{CueDegrees, Motion},
    study::stability::{Shot, Trace, adversarial, draw, random},
    table::{BALLS, Table},
};

pub const CASES: &[Case] = &[
    Case::new("next to no friction", next_to_no_friction, shot)
        .with_requirement("every shot ends; a cloth without any friction is rejected")
        .any_events(),
    Case::new("friction of 10 and 1000 on the cloth, 0.99 in contacts", large_friction, shot)
        .with_requirement("friction of 1 and more in contacts, whose forces would not be unique, is rejected"),
    Case::new("no restitution, e = 0", || with_restitution(0.0), shot),
    Case::new("restitution e = 0.3", || with_restitution(0.3), shot),
    Case::new("full restitution, e = 1", || with_restitution(1.0), shot).any_events(),
    Case::new("full restitution without friction in contacts", lossless, shot)
        .checked("no collision changes the energy", keeps_energy)
        .any_events(),
    Case::new("the smallest table, 16 by 6 ball radii", smallest, shot).any_events(),
    Case::new("the longest table, ten metres", longest, shot),
    Case::new("balls of one millimetre and of one metre", all_balls, shot),
];

fn next_to_no_friction() -> Vec<Table> {
    variants("mu = 0.0001", |table| {
        (table.sliding_friction, table.rolling_friction) = (1e-4, 1e-4);
        (table.spinning_friction, table.rail_friction, table.ball_friction) = (0.0, 0.0, Some(0.0));
    })
}

fn large_friction() -> Vec<Table> {
    let all = |mu: f64| {
        variants(&format!("mu = {mu}"), move |table| {
            (table.sliding_friction, table.rolling_friction, table.spinning_friction) = (mu, mu, mu);
            (table.rail_friction, table.ball_friction) = (0.99, Some(0.99));
        })
    };
    [all(10.0), all(1000.0)].concat()
}

fn lossless() -> Vec<Table> {
    variants("lossless", |table| {
        (table.ball_restitution, table.rail_restitution) = (1.0, 1.0);
        (table.rail_friction, table.ball_friction) = (0.0, Some(0.0));
    })
}

fn smallest() -> Vec<Table> {
    variants("smallest", |table| {
        (table.length, table.width) = (16.0 * table.radius, 6.0 * table.radius);
        table.opening_offset = 2.0 * table.radius;
    })
}

fn longest() -> Vec<Table> {
    variants("10 m", |table| (table.length, table.width) = (10.0, 5.0))
}

fn all_balls() -> Vec<Table> {
    let scaled = |scale: f64| {
        variants(&format!("scaled by {scale:.3}"), move |table| {
            table.radius *= scale;
            (table.length, table.width, table.opening_offset) =
                (table.length * scale, table.width * scale, table.opening_offset * scale);
        })
    };
    [scaled(1e-3 / 0.03), scaled(1.0 / 0.03)].concat()
}

fn shot(table: &Table, rng: &mut Xoshiro256PlusPlus) -> Shot {
    let speed = if rng.random_bool(0.5) { rng.random_range(0.3..8.0) } else { draw::log_uniform(rng, 1e-4, 8.0) };
    let Shot { layout, cue } =
        if rng.random_bool(0.5) { random::shot(table, rng) } else { adversarial::shot(table, rng) };
    Shot { layout, cue: CueDegrees { speed, ..cue } }
}

/// Rounding of an energy in a collision, in ε.
const OPERATIONS: f64 = 64.0;

/// Below this speed a ball that touches something is brought to rest against it, m/s.
const SETTLES: f64 = 1e-4;

/// Checks that collisions conserve the sum of energies: at every change of speed without a ball that starts or ends resting or
/// stops, except for bounces that are too slow to be followed.
fn keeps_energy(table: &Table, _: &Shot, trace: &Trace) -> Result<(), String> {
    let least = 0.5 * trace.constants.tolerance.slowest_lossless_bounce.powi(2);
    for event in trace.events.iter().filter(|event| event.kind.balls().1.is_some() || event.kind.rail().is_some()) {
        let (first, second) = event.kind.balls();
        let (mut change, mut scale, mut settles) = (0.0, 0.0, false);
        for (ball, pieces) in trace.pieces.iter().enumerate().take(BALLS) {
            let Some(next) = pieces.iter().position(|piece| piece.segment.start == event.time).filter(|next| *next > 0)
            else {
                // The next piece of a ball that is hit may not be stored, because pieces are stored when they end.
                settles |= [Some(first), second].contains(&Some(ball)) && trace.kept_until != f64::INFINITY;
                continue;
            };
            let (last, next) = (&pieces[next - 1], &pieces[next]);
            let before = last.segment.state_after(&trace.constants, last.end - last.segment.start);
            let after = next.segment.state_after(&trace.constants, 0.0);
            change += after.specific_energy(table.radius) - before.specific_energy(table.radius);
            scale += last.segment.state_after(&trace.constants, 0.0).specific_energy(table.radius)
                + after.specific_energy(table.radius);
            settles |= [last, next].iter().any(|piece| piece.segment.motion == Motion::Resting)
                || before.velocity.length().min(after.velocity.length()) < SETTLES;
        }
        if !settles && change.abs() > OPERATIONS * f64::EPSILON * scale + least {
            return Err(format!("{:?} changes the energy by {change:e} m²/s²", event.kind));
        }
    }
    Ok(())
}
