//! Resting contacts in all forms: a ball on one or two cushions, on another ball, or between balls and cushions.

use std::f64::consts::FRAC_PI_4;

use glam::DVec2;
use rand::RngExt;
use rand_xoshiro::Xoshiro256PlusPlus;

use super::{Case, presets, rail_course, variant, variants};
use crate::{
    physics::CueDegrees,
    simulation::Rail,
    study::stability::{Shot, draw},
    table::{Layout, Table},
};

pub const CASES: &[Case] = &[
    Case::new("a ball resting on a cushion", lively_and_dead, on_cushion),
    Case::new("a ball resting on two cushions", lively_and_dead, on_two_cushions),
    Case::new("a ball resting on another", lively_and_dead, on_ball),
    Case::new("a ball pressed between ball and cushion", lively_and_dead, between),
    Case::new("a ball resting on a smooth cushion", smooth, against_smooth_cushion)
        .checked("stops when and where quadrature predicts, to 1e-9 s and m", rail_course::follows_quadrature),
];

/// The bundled tables, and the thesis' table with contacts that do not bounce at all.
fn lively_and_dead() -> Vec<Table> {
    let mut tables = presets();
    tables.extend(variant("thesis", "dead", |table| (table.ball_restitution, table.rail_restitution) = (0.0, 0.0)));
    tables
}

/// Cushions without friction and restitution, on which the course of a pressed ball is known except for two integrals.
fn smooth() -> Vec<Table> {
    variants("smooth and dead cushions", |table| (table.rail_restitution, table.rail_friction) = (0.0, 0.0))
}

/// Draws a stroke with follow and some side: the slip at the cloth presses the ball against whatever it has hit.
fn pressing(phi_deg: f64, rng: &mut Xoshiro256PlusPlus) -> CueDegrees {
    CueDegrees {
        a: rng.random_range(-0.4..0.4),
        b: rng.random_range(0.4..0.9),
        theta_deg: draw::one_of(rng, &[0.0, 5.0, 20.0]),
        phi_deg,
        speed: draw::log_uniform(rng, 0.05, 8.0),
    }
}

fn position_on(rail: Rail, table: &Table, rng: &mut Xoshiro256PlusPlus) -> DVec2 {
    let n = rail.normal();
    0.9 * draw::position(table, rng) * (DVec2::ONE - n.abs()) - n * table.reach()
}

fn on_cushion(table: &Table, rng: &mut Xoshiro256PlusPlus) -> Shot {
    let rail = draw::one_of(rng, &Rail::ALL);
    let direction = DVec2::from_angle(rng.random_range(-1.2..1.2)).rotate(-rail.normal());
    let back = if rng.random_bool(0.3) { 0.0 } else { rng.random_range(0.0..0.3) };
    let from = position_on(rail, table, rng) + back * rail.normal();
    Shot { layout: draw::with_others(table, &[from], rng), cue: pressing(direction.to_angle().to_degrees(), rng) }
}

fn on_two_cushions(table: &Table, rng: &mut Xoshiro256PlusPlus) -> Shot {
    let signs = draw::corner(rng);
    let turn = draw::one_of(rng, &[0.0, 1e-9, 0.3]) * rng.random_range(-1.0..1.0);
    let direction = DVec2::from_angle(FRAC_PI_4 + turn) * signs;
    let back = if rng.random_bool(0.3) { 0.0 } else { rng.random_range(0.0..0.3) };
    let from = signs * table.reach() - signs * back;
    Shot { layout: draw::with_others(table, &[from], rng), cue: pressing(direction.to_angle().to_degrees(), rng) }
}

fn on_ball(table: &Table, rng: &mut Xoshiro256PlusPlus) -> Shot {
    loop {
        let from = 0.8 * draw::position(table, rng);
        let direction = DVec2::from_angle(rng.random_range(-3.2..3.2));
        let apart = 2.0 * table.radius + if rng.random_bool(0.5) { 0.0 } else { rng.random_range(0.0..0.3) };
        let layout = Layout::new([from, from + apart * direction, draw::position(table, rng)]);
        if layout.validate(table).is_ok() {
            let turn = draw::one_of(rng, &[0.0, 0.0, 1e-6, 0.05]) * rng.random_range(-1.0..1.0);
            return Shot { layout, cue: pressing((direction.to_angle() + turn).to_degrees(), rng) };
        }
    }
}

fn between(table: &Table, rng: &mut Xoshiro256PlusPlus) -> Shot {
    loop {
        let rail = draw::one_of(rng, &Rail::ALL);
        let target = position_on(rail, table, rng);
        let direction = DVec2::from_angle(draw::one_of(rng, &[0.0, 0.1, 0.8]) * rng.random_range(-1.0..1.0));
        let direction = direction.rotate(-rail.normal());
        let apart = 2.0 * table.radius + if rng.random_bool(0.5) { 0.0 } else { rng.random_range(0.0..0.3) };
        let layout = Layout::new([target - apart * direction, target, draw::position(table, rng)]);
        if layout.validate(table).is_ok() {
            let turn = draw::one_of(rng, &[0.0, 0.0, 0.05]) * rng.random_range(-1.0..1.0);
            return Shot { layout, cue: pressing((direction.to_angle() + turn).to_degrees(), rng) };
        }
    }
}

/// Draws a shot of a ball on a cushion into that cushion, so soft that it usually meets no other ball or cushion.
fn against_smooth_cushion(table: &Table, rng: &mut Xoshiro256PlusPlus) -> Shot {
    let rail = draw::one_of(rng, &Rail::ALL);
    let along = rng.random_range(-1.3..1.3_f64);
    let direction = DVec2::from_angle(along).rotate(-rail.normal());
    let from = 0.2 * position_on(rail, table, rng) * (DVec2::ONE - rail.normal().abs()) - rail.normal() * table.reach();
    let far = (0.9 * table.reach()) * rail.normal();
    let layout = Layout::new([from, far, far + 4.0 * table.radius * rail.normal().perp()]);
    let speed = rng.random_range(0.05..0.8);
    Shot { layout, cue: CueDegrees { speed, ..pressing(direction.to_angle().to_degrees(), rng) } }
}
