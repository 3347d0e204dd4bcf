//! What the laws of impact and of free motion take of the energy, by formulas written apart from the engine's. Models of a
//! table's parts that go beyond the thesis are those of the reference engine.

use super::{
    least_squares::{Column, dot},
    motion::{Contact, energy},
};
use crate::{
    physics::{BallState, Motion},
    simulation::Rail,
    study::reference_engine::{Ball, Numbers, Vector, balls_collide, rail_collides},
    table::{BALLS, RailModel, Rails, Table},
};

/// The restitution of a contact.
pub const fn restitution(table: &Table, contact: &Contact) -> f64 {
    if contact.second.is_some() { table.ball_restitution } else { table.rail_restitution }
}

/// Coulomb's coefficient of a contact; `None` for one that never slips.
pub const fn friction(table: &Table, contact: &Contact) -> Option<f64> {
    if contact.second.is_some() { table.ball_friction } else { Some(table.rail_friction) }
}

/// What an impact in one contact takes, m²/s²: the normal impulse reverses the opening speed to `restitution` of it, and
/// friction takes slip by Coulomb's law, at most as much as ends it along t (thesis equations 17 to 23).
pub fn impact_loss(table: &Table, contact: &Contact, before: &Column, restitution: f64) -> f64 {
    let directions = contact.directions();
    let [opening, along, up] = directions.map(|direction| dot(&direction, before));
    if opening >= 0.0 {
        return 0.0;
    }
    let [normal, tangent, _] = directions.map(|direction| dot(&direction, &direction));
    let push = -(1.0 + restitution) * opening / normal;
    let slip = along.hypot(up);
    let holds = 1.0 / tangent;
    let share = match friction(table, contact) {
        Some(mu) if mu * push < holds * slip => mu * push / slip,
        _ => holds,
    };
    let mut after = *before;
    for (direction, impulse) in directions.iter().zip([push, -share * along, -share * up]) {
        after.iter_mut().zip(direction).for_each(|(after, direction)| *after += impulse * direction);
    }
    energy(before) - energy(&after)
}

/// The same for a table whose impacts go by other models: `None` for the thesis' laws, and for models that the reference engine
/// has not. Where it is not elastic there is no restitution.
pub fn impact_loss_by_models(
    table: &Table,
    contact: &Contact,
    balls: &[BallState; BALLS],
    is_elastic: bool,
) -> Option<f64> {
    let numbers = Numbers::<f64>::of(table);
    let numbers = if is_elastic { numbers } else { numbers.inelastic() };
    let vector = |v: glam::DVec2, z: f64| Vector::new(v.x, v.y, z);
    let plain = |state: &BallState| Ball {
        velocity: vector(state.velocity, 0.0),
        spin: vector(state.spin.truncate(), state.spin.z),
        ..Ball::still(vector(state.position, 0.0))
    };
    let mut first = plain(&balls[contact.first]);
    if let Some(second) = contact.second {
        let by_speed = table.ball_fade.is_some() || table.ball_slip_friction.is_some();
        return by_speed.then(|| balls_collide(&numbers, &mut first, &mut plain(&balls[second])));
    }
    let cushion = numbers.cushion(Rail::with_normal(contact.normal));
    let is_known = table.rail != Rails::default() && table.rail.model != RailModel::Mathavan;
    is_known.then(|| rail_collides(&numbers, cushion, vector(contact.normal, 0.0), &mut first))
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
    let boring = table.spinning_friction * g;
    let spin = if boring > 0.0 { work(boring, radius * state.spin.z.abs(), 2.5 * boring) } else { 0.0 };
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
