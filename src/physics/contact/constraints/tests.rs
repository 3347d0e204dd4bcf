//! Tests of impulses that cancel residual speeds, and of contacts that cannot all be held.

use super::*;
use crate::{physics::BallState, table::Rail};

/// A ball at a cushion that slips on it and opens at this speed.
fn rubbing(opening: f64) -> (Table, [BallState; BALLS], [Contact; 1]) {
    let table = Table::preset("textbook").unwrap();
    let mut balls = [0.0, 0.3, -0.3].map(|x| BallState::at_rest(DVec2::new(x, 0.0)));
    balls[0].position.x = table.half_length();
    balls[0].velocity = DVec2::new(-opening, 0.5);
    balls[0].spin = DVec3::new(20.0, 10.0, 40.0);
    (table, balls, [Contact::with_cushion(0, Rail::Right)])
}

fn stopped(opening: f64, given: f64) -> f64 {
    let (table, mut balls, contacts) = rubbing(opening);
    let before = balls[0].specific_energy(table.radius);
    stop_by_impulses(&table, &mut balls, &contacts, &ActiveSet::SLIPPING, &[given]);
    assert!(contacts[0].opening_speed(&balls).abs() < 1e-18);
    balls[0].specific_energy(table.radius) - before
}

#[test]
fn pulling_impulse_gains_no_energy() {
    assert!(stopped(1e-9, 0.0) <= f64::EPSILON);
    // A closing contact is pushed and has friction.
    assert!(stopped(-1e-9, 0.0) < -1e-11);
}

/// If such a speed were treated as rounding of the spin's 40 rad/s, it would remain and carry the ball away.
#[test]
fn speed_within_rounding_of_a_spin_is_stopped() {
    assert!(stopped(1e-13, 0.0) <= f64::EPSILON);
    assert!(stopped(-1e-13, 0.0) <= f64::EPSILON);
}

#[test]
fn excess_push_is_reduced_together_with_its_friction() {
    assert!(stopped(1e-9, 1e-6) > 1e-11);
}

/// A ball slides along a ball at rest, between that ball and a cushion: its trajectory would have to curve to touch both. Held by the
/// forces of the first instant, it would gain energy.
#[test]
fn cushion_and_curved_ball_contact_are_inconsistent() {
    let table = Table::preset("textbook").unwrap();
    let slack = |speed: f64| {
        let mut balls =
            [0.0, 2.0 * table.radius, 0.5].map(|y| BallState::at_rest(DVec2::new(0.0, y - table.half_width())));
        balls[0].velocity.x = speed;
        balls[0].spin = DVec3::new(7.0, 4.0, 0.0);
        let contacts = [Contact::with_cushion(0, Rail::Bottom), Contact::of_balls(0, 1)];
        let set = ActiveSet::of(&table, &balls, &contacts, 1e-9);
        let scene = Scene { table: &table, balls: &balls, contacts: &contacts, set: &set };
        let mut pressed = Forces::NONE;
        // The cushion takes the push of the cloth's friction; the other ball takes no more than it can without being moved.
        pressed.normal[..2].copy_from_slice(&[1.75, 0.04]);
        scene.forces(Some(&pressed)).expect("forces").slack
    };
    assert!(slack(0.0) > 0.0, "{}", slack(0.0));
    for speed in [1e-3, 0.1, 1.0] {
        let bend = speed * speed / (2.0 * table.radius);
        assert!(slack(speed) < -0.3 * bend, "{speed} m/s: {:e} of {bend:e}", slack(speed));
    }
}
