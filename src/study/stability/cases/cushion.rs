//! Balls exactly on a cushion and in a corner.

use std::f64::consts::{FRAC_PI_4, PI};

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
    Case::new("object ball exactly on a cushion", presets, object_ball)
        .checked("a ball driven into the cushion rebounds at once", returns),
    Case::new("cue ball exactly on a cushion", presets, cue_ball)
        .checked("struck into the cushion it rebounds, struck away it leaves", leaves),
    Case::new("object ball exactly in a corner", presets, corner_ball)
        .checked("both cushions are hit at the same time", returns),
    Case::new("a shot exactly into a corner at 45°", presets, into_corner)
        .checked("both cushions are hit at the same time", hits_both),
];

/// Times that differ by less count as simultaneous, s: a ball moves 1e-12 m meanwhile, many times the rounding of a table's
/// length.
const MOMENT: f64 = 1e-13;

fn on_cushion(table: &Table, rng: &mut Xoshiro256PlusPlus) -> (DVec2, Rail) {
    let rail = draw::one_of(rng, &Rail::ALL);
    let n = rail.normal();
    let anywhere = draw::position(table, rng);
    (anywhere * (DVec2::ONE - n.abs()) - n * table.reach(), rail)
}

/// Returns a shot that drives the ball at `target` `towards` some direction; `None` if there is no room for it.
fn driving(table: &Table, target: DVec2, towards: DVec2, rng: &mut Xoshiro256PlusPlus) -> Option<Shot> {
    let direction = DVec2::from_angle(rng.random_range(-0.5..0.5)).rotate(towards);
    let from = target - 2.0 * table.radius * towards - rng.random_range(0.0..0.6) * direction;
    let b = draw::one_of(rng, &[-0.5, 0.0, 0.4, 0.9]);
    let cue = CueDegrees { b, ..CueDegrees::centre(direction.to_angle().to_degrees(), rng.random_range(0.5..8.0)) };
    let layout = Layout::new([from, target, draw::position(table, rng)]);
    layout.validate(table).is_ok().then_some(Shot { layout, cue })
}

fn object_ball(table: &Table, rng: &mut Xoshiro256PlusPlus) -> Shot {
    loop {
        let (target, rail) = on_cushion(table, rng);
        // Into the cushion, from perpendicular to nearly parallel.
        let towards = DVec2::from_angle(rng.random_range(-1.2..1.2)).rotate(-rail.normal());
        if let Some(shot) = driving(table, target, towards, rng) {
            return shot;
        }
    }
}

fn corner_ball(table: &Table, rng: &mut Xoshiro256PlusPlus) -> Shot {
    loop {
        let signs = draw::corner(rng);
        let turn = draw::one_of(rng, &[0.0, 0.0, 0.3, -0.3]) * rng.random::<f64>();
        let towards = DVec2::from_angle(FRAC_PI_4 + turn) * signs;
        if let Some(shot) = driving(table, signs * table.reach(), towards, rng) {
            return shot;
        }
    }
}

/// Checks that ball 1, when first hit, rebounds simultaneously from every cushion that it touches and is driven into.
fn returns(table: &Table, shot: &Shot, trace: &Trace) -> Result<(), String> {
    let Some(first) = trace.events.iter().find(|event| matches!(event.kind, EventKind::BallBall(..))) else {
        return Ok(());
    };
    if first.kind != EventKind::BallBall(0, 1)
        || trace.events.iter().any(|e| e.kind.rail().is_some() && e.time < first.time)
    {
        return Ok(());
    }
    let place = trace.pieces[0]
        .iter()
        .rfind(|piece| piece.end <= first.time)
        .map_or(shot.layout.balls[0], |piece| piece.segment.position_after(piece.end - piece.segment.start));
    let target = shot.layout.balls[1];
    let pushed = (target - place).normalize();
    for rail in Rail::ALL {
        let is_there = rail.gap(table.reach(), target) == 0.0;
        let answers = |e: &crate::simulation::Event| {
            [EventKind::BallRail(1, rail), EventKind::ContactBegins(1)].contains(&e.kind)
                && (e.time - first.time).abs() <= MOMENT
        };
        // Friction between the balls turns the direction by 7° at most, since the ball has no side spin.
        if is_there && pushed.dot(rail.normal()) < -0.3 && !trace.events.iter().any(answers) {
            return Err(format!(
                "ball 1 is driven into the {} cushion at {} s, but does not rebound",
                rail.name(),
                first.time
            ));
        }
    }
    Ok(())
}

fn cue_ball(table: &Table, rng: &mut Xoshiro256PlusPlus) -> Shot {
    let (from, rail) = on_cushion(table, rng);
    let direction = DVec2::from_angle(rng.random_range(-PI..PI)).rotate(rail.normal());
    let layout = draw::with_others(table, &[from], rng);
    Shot { layout, cue: CueDegrees { phi_deg: direction.to_angle().to_degrees(), ..draw::stroke(rng) } }
}

fn leaves(table: &Table, shot: &Shot, trace: &Trace) -> Result<(), String> {
    let from = shot.layout.balls[0];
    for rail in Rail::ALL {
        let speed = trace.impulse.velocity.dot(rail.normal());
        if rail.gap(table.reach(), from) != 0.0 {
            continue;
        }
        let answers = trace.events.iter().any(|e| e.time == 0.0 && e.kind == EventKind::BallRail(0, rail));
        // Below this speed the ball comes to rest instead of bouncing.
        if speed < -1e-9 && !answers {
            return Err(format!("struck into the {} cushion without an impact", rail.name()));
        }
        if speed > 0.0 && answers {
            return Err(format!("struck away from the {} cushion, but hits it", rail.name()));
        }
    }
    Ok(())
}

/// Draws a shot along the diagonal of a corner, from a distance that is exact in binary.
fn into_corner(table: &Table, rng: &mut Xoshiro256PlusPlus) -> Shot {
    let signs = draw::corner(rng);
    let distance = f64::from(rng.random_range(1..64)) / 256.0;
    let from = signs * (table.reach() - DVec2::splat(distance));
    let layout = loop {
        let layout = draw::with_others(table, &[from], rng);
        // No ball may be in the way.
        let clear = layout.balls[1..].iter().all(|ball| (signs * table.reach()).distance(*ball) > 0.6);
        if clear {
            break layout;
        }
    };
    let phi_deg = if signs.x > 0.0 { 45.0 * signs.y } else { 135.0 * signs.y };
    let b = draw::one_of(rng, &[-0.3, 0.0, 0.2, 0.4]);
    Shot { layout, cue: CueDegrees { b, ..CueDegrees::centre(phi_deg, rng.random_range(2.0..8.0)) } }
}

fn hits_both(_: &Table, _: &Shot, trace: &Trace) -> Result<(), String> {
    let mut cushions = trace.events.iter().filter(|event| matches!(event.kind, EventKind::BallRail(0, _)));
    match (cushions.next(), cushions.next()) {
        (Some(first), Some(second)) if (second.time - first.time).abs() <= MOMENT && first.kind != second.kind => {
            Ok(())
        }
        (first, second) => Err(format!("the cushions are hit at different times: {first:?}, {second:?}")),
    }
}
