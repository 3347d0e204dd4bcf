//! Hard cases of flights: grazes from above, landings on an edge or on the top of a ball, endless hops.

use glam::DVec2;
use rand::RngExt;
use rand_xoshiro::Xoshiro256PlusPlus;

use super::{Case, CaseKind, variant};
use crate::{
    physics::{CueDegrees, Cushion, strike},
    simulation::{EventKind, Rail},
    study::stability::{Shot, Trace, adversarial, draw},
    table::{Flight, Layout, Rails, Table},
};

pub const CASES: &[Case] = &[
    Case::new("grazing a ball from above, relative depth 1e-12 to 1e-3", flying, graze)
        .checked("hit or missed as the exact numbers predict", hit_or_missed),
    Case::new("random shots with the cue raised by up to 60°", flying, raised).of_kind(CaseKind::Adversarial),
    Case::new("balls that touch or almost touch, the cue raised by up to 60°", flying_by_thesis, raised_at_touching)
        .of_kind(CaseKind::Adversarial),
    Case::new("landing on the nose of a cushion", flying, on_the_nose),
    Case::new("landing exactly on a ball's top", flying, on_top),
    Case::new("endless hops, e_c = 0.99", lively, hops),
    Case::new("into the corner from the air", flying, corner),
    Case::new("massé at 89° and 8 m/s where balls can fly", flying, masse),
];

fn with(what: &str, restitution: f64) -> Vec<Table> {
    let flight = Some(Flight { restitution, friction: None });
    ["textbook", "thesis", "match"]
        .iter()
        .filter_map(|name| variant(name, what, |table| table.flight = flight))
        .collect()
}

fn flying() -> Vec<Table> {
    with("flying", 0.5)
}

/// Tables on which simultaneous impacts follow the thesis' laws, which the audit implements.
fn flying_by_thesis() -> Vec<Table> {
    flying().into_iter().filter(|table| table.rail == Rails::default()).collect()
}

fn lively() -> Vec<Table> {
    with("flying, e_c = 0.99", 0.99)
}

/// Draws a stroke along x that makes the cue ball jump. Returns it with the cue ball's horizontal velocity and vertical speed.
fn jump(table: &Table, rng: &mut Xoshiro256PlusPlus, speeds: std::ops::Range<f64>) -> (CueDegrees, DVec2, f64) {
    let stroke = CueDegrees {
        b: rng.random_range(-0.2..0.2),
        theta_deg: rng.random_range(15.0..55.0),
        ..CueDegrees::centre(0.0, rng.random_range(speeds))
    };
    let impulse = strike(table, &stroke.into());
    (stroke, impulse.velocity, impulse.lift)
}

/// Draws a shot in which the ball, at the top of its flight, passes next to and above another ball, at a distance of two radii
/// minus a tiny depth.
fn graze(table: &Table, rng: &mut Xoshiro256PlusPlus) -> Shot {
    loop {
        let (stroke, velocity, lift) = jump(table, rng, 1.0..4.0);
        let (time, height) = (lift / table.gravity, 0.5 * lift * lift / table.gravity);
        let depth = draw::one_of(rng, &[-1.0, 1.0]) * draw::log_uniform(rng, 1e-12, 1e-3);
        let distance = 2.0 * table.radius * (1.0 - depth);
        if height >= 0.95 * distance
            || height < 0.2 * table.radius
            || velocity.x * velocity.x < 2.0 * table.gravity * height
        {
            continue;
        }
        let from = DVec2::new(-0.3, 0.0);
        let beside = (distance * distance - height * height).sqrt() * draw::one_of(rng, &[-1.0, 1.0]);
        let ball = from + time * velocity + DVec2::new(0.0, beside);
        if ball.distance(from) > 2.1 * table.radius {
            return Shot { layout: draw::with_others(table, &[from, ball], rng), cue: stroke };
        }
    }
}

fn hit_or_missed(table: &Table, shot: &Shot, trace: &Trace) -> Result<(), String> {
    let impulse = strike(table, &shot.cue.into());
    let (time, height) = (impulse.lift / table.gravity, 0.5 * impulse.lift * impulse.lift / table.gravity);
    let offset = shot.layout.balls[1] - shot.layout.balls[0] - time * impulse.velocity;
    let depth = 1.0 - offset.length().hypot(height) / (2.0 * table.radius);
    // Anything else in the way comes first.
    let first = trace.events.iter().find(|event| event.kind.is_contact());
    let hit = first.is_some_and(|event| event.kind == EventKind::BallBall(0, 1) && event.time < 2.0 * time);
    let met_other = first.is_some_and(|event| event.kind != EventKind::BallBall(0, 1) && event.time < 2.0 * time);
    if met_other || depth.abs() < 1e-11 || hit == (depth > 0.0) {
        Ok(())
    } else {
        Err(format!("a graze of relative depth {depth:e} is {}", if hit { "hit" } else { "missed" }))
    }
}

/// Draws a shot in which the ball lands on the nose of the right cushion, at any possible height.
fn on_the_nose(table: &Table, rng: &mut Xoshiro256PlusPlus) -> Shot {
    let [sine, cosine] = Cushion::of(table, Rail::Right).nose;
    loop {
        let (stroke, velocity, lift) = jump(table, rng, 1.5..5.0);
        let angle: f64 = rng.random_range(0.0..1.55);
        let (inwards, height) = (table.radius * angle.cos(), table.radius * (sine + angle.sin()));
        let falls = lift * lift - 2.0 * table.gravity * height;
        if falls <= 0.0 {
            continue;
        }
        let time = (lift + falls.sqrt()) / table.gravity;
        let nose = table.reach().x + cosine * table.radius;
        let from = DVec2::new(nose - inwards - time * velocity.x, rng.random_range(-0.3..0.3));
        if from.x > -table.reach().x {
            return Shot { layout: draw::with_others(table, &[from], rng), cue: stroke };
        }
    }
}

/// Draws a shot in which the ball lands exactly on top of another.
fn on_top(table: &Table, rng: &mut Xoshiro256PlusPlus) -> Shot {
    loop {
        let (stroke, velocity, lift) = jump(table, rng, 2.0..5.0);
        let falls = lift * lift - 4.0 * table.gravity * table.radius;
        if falls <= 0.0 {
            continue;
        }
        let time = (lift + falls.sqrt()) / table.gravity;
        let from = DVec2::new(-0.5, 0.1);
        let ball = from + time * velocity;
        if ball.x < table.reach().x && ball.distance(from) > 2.1 * table.radius {
            return Shot { layout: draw::with_others(table, &[from, ball], rng), cue: stroke };
        }
    }
}

/// Greatest cue elevation, degrees: players seldom raise the cue further.
const STEEPEST: f64 = 60.0;

fn raised(table: &Table, rng: &mut Xoshiro256PlusPlus) -> Shot {
    let theta_deg = rng.random_range(0.0..STEEPEST);
    Shot { layout: Layout::random(table, rng), cue: CueDegrees { theta_deg, ..draw::stroke(rng) } }
}

fn raised_at_touching(table: &Table, rng: &mut Xoshiro256PlusPlus) -> Shot {
    let theta_deg = rng.random_range(0.0..STEEPEST);
    let shot = adversarial::shot(table, rng);
    Shot { cue: CueDegrees { theta_deg, ..shot.cue }, ..shot }
}

fn hops(table: &Table, rng: &mut Xoshiro256PlusPlus) -> Shot {
    let stroke =
        CueDegrees { theta_deg: rng.random_range(3.0..60.0), speed: rng.random_range(0.3..5.0), ..draw::stroke(rng) };
    Shot { layout: Layout::random(table, rng), cue: stroke }
}

/// Draws a shot along the diagonal of a corner, low enough to hit both noses at the same time.
fn corner(table: &Table, rng: &mut Xoshiro256PlusPlus) -> Shot {
    loop {
        let way = rng.random_range(0.15..0.9) * table.reach().y;
        let from = table.reach() - DVec2::splat(way);
        let stroke = CueDegrees {
            theta_deg: rng.random_range(5.0..50.0),
            ..CueDegrees::centre(45.0, rng.random_range(1.0..5.0))
        };
        let impulse = strike(table, &stroke.into());
        if impulse.lift * impulse.lift < 2.0 * table.gravity * 2.0 * table.radius {
            return Shot { layout: draw::with_others(table, &[from], rng), cue: stroke };
        }
    }
}

fn masse(table: &Table, rng: &mut Xoshiro256PlusPlus) -> Shot {
    let (a, b) = draw::tip(rng);
    let stroke = CueDegrees { a, b, theta_deg: 89.0, phi_deg: rng.random_range(-180.0..180.0), speed: 8.0 };
    Shot { layout: Layout::random(table, rng), cue: stroke }
}
