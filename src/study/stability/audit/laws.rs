//! What the laws of impact and of free motion take of the energy, by formulas written apart from the engine's: impacts by those of
//! the reference engine.

use super::motion::Contact;
use crate::{
    physics::{BallState, Motion},
    simulation::Rail,
    study::reference_engine::{Ball, Numbers, Vector, balls_collide, rail_collides},
    table::{BALLS, RailModel, Table},
};

/// The restitution of a contact.
pub const fn restitution(table: &Table, contact: &Contact) -> f64 {
    if contact.second.is_some() { table.ball_restitution } else { table.rail_restitution }
}

/// Coulomb's coefficient of a contact; `None` for one that never slips.
pub const fn friction(table: &Table, contact: &Contact) -> Option<f64> {
    if contact.second.is_some() { table.ball_friction } else { Some(table.rail_friction) }
}

/// What an impact in one contact takes by the reference engine's formulas, m²/s² (thesis equations 17 to 23, and other models of a
/// table's parts): with the contact's restitution or, where it is not elastic, with none. `None` for Mathavan's rails, which that
/// engine has not.
pub fn impact_loss(table: &Table, contact: &Contact, balls: &[BallState; BALLS], is_elastic: bool) -> Option<f64> {
    if contact.second.is_none() && table.rail.model == RailModel::Mathavan {
        return None;
    }
    let numbers = Numbers::<f64>::of(table);
    let numbers = if is_elastic { numbers } else { numbers.inelastic() };
    let vector = |v: glam::DVec2, z: f64| Vector::new(v.x, v.y, z);
    let plain = |ball: usize| {
        let BallState { position, velocity, spin } = balls[ball];
        let still = Ball::still(vector(position, 0.0));
        Ball { velocity: vector(velocity, 0.0), spin: vector(spin.truncate(), spin.z), ..still }
    };
    let (mut first, second, normal) = (plain(contact.first), contact.second.map(plain), vector(contact.normal, 0.0));
    let relative = second.map_or(first.velocity, |second| first.velocity - second.velocity);
    Some(match second {
        _ if relative.dot(normal) >= 0.0 => 0.0,
        Some(mut second) => balls_collide(&numbers, &mut first, &mut second),
        None => rail_collides(&numbers, numbers.cushion(Rail::with_normal(contact.normal)), normal, &mut first),
    })
}

/// The work of the cloth on a ball that moves freely for `time` seconds from `state` on, m²/s² (thesis equations 1 to 8).
pub fn free_loss(table: &Table, state: &BallState, motion: Motion, time: f64) -> f64 {
    // In the air nothing is lost, nor by what is out of play.
    if matches!(motion, Motion::Flying | Motion::OffTable) {
        return 0.0;
    }
    let (radius, g) = (table.radius, table.gravity);
    // The work of a force over a speed that it brings down at some rate, as long as there is any.
    let work = |force: f64, speed: f64, rate: f64| {
        let time = if rate * time < speed { time } else { speed / rate };
        force * time * (speed - 0.5 * rate * time)
    };
    let spinning = table.spinning_friction * g;
    let spin = if spinning > 0.0 { work(spinning, radius * state.spin.z.abs(), 2.5 * spinning) } else { 0.0 };
    let v = state.velocity;
    spin + match motion {
        Motion::Sliding => {
            let force = table.sliding_friction * g;
            work(force, (v.x - radius * state.spin.y).hypot(v.y + radius * state.spin.x), 3.5 * force)
        }
        Motion::Rolling => {
            let deceleration = Numbers::<f64>::of(table).band(v.length()).0;
            work(1.4 * deceleration, v.length(), deceleration)
        }
        Motion::Stationary | Motion::Resting | Motion::Flying | Motion::OffTable => 0.0,
    }
}
