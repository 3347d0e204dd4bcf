//! Events at exactly the same moment.

use glam::DVec2;
use rand::RngExt;
use rand_xoshiro::Xoshiro256PlusPlus;

use super::{Case, presets};
use crate::{
    physics::CueDegrees,
    simulation::{EventKind, Rail},
    study::stability::{Shot, Trace, draw},
    table::{Layout, Table},
};

pub const CASES: &[Case] = &[
    Case::new("two object balls hit at the same moment", presets, fork)
        .checked("both are hit, at the same moment", hits_both),
    Case::new("ball and cushion hit at the same moment", presets, ball_at_cushion)
        .checked("both are hit, at the same moment", hits_ball_and_cushion),
];

/// Times that differ by less are the same moment, s: a ball moves 1e-12 m meanwhile.
const MOMENT: f64 = 1e-13;

/// Along x into the gap between two balls that stand alike on both sides.
fn fork(table: &Table, rng: &mut Xoshiro256PlusPlus) -> Shot {
    let beside = table.radius * if rng.random_bool(0.3) { 1.0 } else { rng.random_range(1.0..1.6) };
    let from = DVec2::new(-rng.random_range(0.2..0.8), 0.0);
    let b = draw::one_of(rng, &[-0.3, 0.0, 0.4]);
    Shot {
        layout: Layout::new([from, DVec2::new(0.0, beside), DVec2::new(0.0, -beside)]),
        cue: CueDegrees { b, ..CueDegrees::centre(0.0, rng.random_range(2.0..8.0)) },
    }
}

fn hits_both(_: &Table, _: &Shot, trace: &Trace) -> Result<(), String> {
    happen_together(trace, EventKind::BallBall(0, 2))
}

/// Whether the ball 1 is hit just when `other` happens: whichever comes first leaves the cue ball on its way to the other.
fn happen_together(trace: &Trace, other: EventKind) -> Result<(), String> {
    let at = |kind| trace.events.iter().find(|event| event.kind == kind).map(|event| event.time);
    match (at(EventKind::BallBall(0, 1)), at(other)) {
        (Some(first), Some(second)) if (first - second).abs() <= MOMENT => Ok(()),
        (first, second) => Err(format!("hit at different moments: ball 1 at {first:?}, the other at {second:?} s")),
    }
}

/// Aslant into the upper cushion, where another ball is met just when the cushion is.
fn ball_at_cushion(table: &Table, rng: &mut Xoshiro256PlusPlus) -> Shot {
    let direction = DVec2::from_angle(rng.random_range(0.5..1.2));
    let at = DVec2::new(rng.random_range(-0.2..0.2), table.half_width());
    // The other ball stands beside or below, and ahead.
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

fn hits_ball_and_cushion(_: &Table, _: &Shot, trace: &Trace) -> Result<(), String> {
    happen_together(trace, EventKind::BallRail(0, Rail::Top))
}
