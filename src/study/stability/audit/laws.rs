//! Energy that the laws of impact and of free motion dissipate, by formulas independent of the engine; impacts use those of the
//! reference engine.

use crate::{
    physics::{BallState, Motion},
    study::reference_engine::{Ball, Contact, Numbers, RailLaw, balls_collide, rail_collides, rail_normal},
    table::{BALLS, Table},
};

/// Returns the energy that an impact at one contact dissipates by the formulas of the reference engine, m²/s² (thesis equations
/// 17 to 23, and other models of a table's parts). `None` for Mathavan's rails, which that engine does not implement.
pub fn impact_loss(numbers: &Numbers<f64>, contact: Contact, balls: &[Ball<f64>; BALLS]) -> Option<f64> {
    if contact.opening_speed(balls) >= 0.0 {
        return Some(0.0);
    }
    match contact {
        Contact::Balls(first, second) => Some(balls_collide(numbers, &mut { balls[first] }, &mut { balls[second] })),
        Contact::Rail(ball, rail) => {
            let cushion = numbers.cushion(rail);
            let is_known = !matches!(cushion.law, RailLaw::Integrated);
            is_known.then(|| rail_collides(numbers, cushion, rail_normal(rail), &mut { balls[ball] }))
        }
    }
}

/// Returns the energy that the cloth dissipates on a ball that moves freely for `time` seconds from `state`, m²/s² (thesis
/// equations 1 to 8).
pub fn free_loss(numbers: &Numbers<f64>, table: &Table, state: &BallState, motion: Motion, time: f64) -> f64 {
    // Nothing is lost in the air, or out of play.
    if matches!(motion, Motion::Flying | Motion::OffTable) {
        return 0.0;
    }
    let (radius, g) = (table.radius, table.gravity);
    // The work of a force against a speed that decreases at `rate`, until the speed is zero.
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
            let deceleration = numbers.band(v.length()).deceleration;
            work(1.4 * deceleration, v.length(), deceleration)
        }
        Motion::Stationary | Motion::Resting | Motion::Flying | Motion::OffTable => 0.0,
    }
}
