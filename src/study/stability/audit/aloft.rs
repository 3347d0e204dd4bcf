//! What is lost where balls fly: at landings by formulas apart from the engine's, at impacts by those of the reference engine.

use crate::{
    physics::{SpatialState, slip},
    simulation::{Event, EventKind},
    study::reference_engine::{
        Ball, Contact, Motion, Numbers, Vector, balls_collide, collide_aloft, rail_collides, rail_normal,
    },
    table::{BALLS, Table},
};

/// Landings slower than this take less than rounding does, m/s: of a slip they take in proportion to their speed.
const LAST_LANDING: f64 = 1e-18;

/// Energy per mass of a ball, m²/s²: on the cloth just that of its motion along it and of its spin.
pub fn energy(table: &Table, ball: &SpatialState) -> f64 {
    let climb = ball.velocity.z;
    ball.seen_from_above().specific_energy(table.radius) + (0.5 * climb * climb + table.gravity * ball.position.z)
}

/// What the cloth takes in the first `landings` landings of a flight that begins in the state `start`, m²/s²: of the upright motion all
/// but the square of the restitution, and by friction `J u - 7/4 J²` of a slip `u` in each.
pub fn landings_loss(table: &Table, start: &SpatialState, landings: u32) -> f64 {
    let Some(flight) = table.flight else { return 0.0 };
    let (e, friction) = (flight.restitution, flight.friction.unwrap_or(table.sliding_friction));
    let climb = start.velocity.z;
    let mut speed = (climb * climb + 2.0 * table.gravity * start.position.z.max(0.0)).sqrt();
    let mut slips = slip(table.radius, start.velocity.truncate(), start.spin).length();
    let mut lost = 0.0;
    for _ in 0..landings {
        if speed < LAST_LANDING {
            break;
        }
        let rub = (friction * (1.0 + e) * speed).min(2.0 / 7.0 * slips);
        lost += 0.5 * speed * speed * (1.0 - e * e) + rub * (slips - 1.75 * rub);
        speed *= e;
        slips -= 3.5 * rub;
    }
    lost
}

/// What the impacts that are told of a `group` of balls take one after another, m²/s², and how far that takes balls out of what they
/// overlap, m; `flew` are those that have been in the air until now.
pub fn impacts_loss(
    table: &Table,
    before: &[SpatialState; BALLS],
    flew: [bool; BALLS],
    group: [bool; BALLS],
    told: &[Event],
) -> [f64; 2] {
    let numbers = Numbers::<f64>::of(table);
    let mut balls: [Ball<f64>; BALLS] = std::array::from_fn(|ball| {
        let SpatialState { position, velocity, spin } = before[ball];
        let [position, velocity, spin] = [position, velocity, spin].map(|v| Vector::new(v.x, v.y, v.z));
        let mut state = Ball { velocity, spin, ..Ball::still(position) };
        state.motion = if flew[ball] { Motion::Flying } else { state.on_cloth(&numbers, 0.0) };
        state
    });
    let mut work = 0.0;
    for event in told {
        let contact = match event.kind {
            EventKind::BallBall(first, second) if group[first] => Contact::Balls(first, second),
            EventKind::BallRail(ball, rail) if group[ball] => Contact::Rail(ball, rail),
            _ => continue,
        };
        if contact.is_aloft(&balls) {
            work += collide_aloft(&numbers, contact, &mut balls).work;
            continue;
        }
        work += match contact {
            Contact::Balls(first, second) => {
                let (mut one, mut other) = (balls[first], balls[second]);
                let work = balls_collide(&numbers, &mut one, &mut other);
                (balls[first], balls[second]) = (one, other);
                work
            }
            Contact::Rail(ball, rail) => {
                rail_collides(&numbers, numbers.cushion(rail), rail_normal(rail), &mut balls[ball])
            }
        };
        for ball in balls.iter_mut().filter(|ball| ball.velocity.z > 0.0) {
            ball.motion = Motion::Flying;
        }
    }
    let moved = balls.iter().zip(before).map(|(ball, before)| {
        let Vector { x, y, z } = ball.position;
        before.position.distance(glam::DVec3::new(x, y, z))
    });
    [work, moved.fold(0.0, f64::max)]
}
