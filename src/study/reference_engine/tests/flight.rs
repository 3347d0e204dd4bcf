//! Flights, compared with the simulator and with conservation laws.

use super::super::*;
use crate::{
    simulation::{EventKind, Rail},
    study::{
        Errors, Method, StudyShot, Truth,
        shots::{MaxElevation, random_shots},
    },
    table::{Flight, RailModel, Rails, Table},
};

type D = DoubleDouble;

/// Each model of the rails, with a cloth of restitution one half, zero, and nearly one.
fn tables() -> [Table; 5] {
    let rails = Rails { height: Some(0.0365), ..Rails::default() };
    let table = |preset: &str, model, restitution| Table {
        rail: Rails { model, kappa: Some(1.2), ..rails },
        flight: Some(Flight { restitution, friction: None }),
        ..Table::preset(preset).unwrap()
    };
    let with_friction = Table {
        flight: Some(Flight { restitution: 0.6, friction: Some(0.4) }),
        ..table("textbook", RailModel::Nose, 0.5)
    };
    let whole_match = Table::default();
    [
        Table { flight: whole_match.flight, ..Table::preset("textbook").unwrap() },
        table("textbook", RailModel::Smooth, 0.0),
        table("textbook", RailModel::Equator, 0.95),
        with_friction,
        whole_match,
    ]
}

#[test]
fn both_engines_agree_on_flights() {
    for (index, table) in tables().iter().enumerate() {
        let (mut units, mut jumps) = (Vec::new(), 0);
        for shot in &random_shots(table, 80, 5, MaxElevation::FLIGHTS) {
            let truth = Truth::of(table, shot).unwrap();
            let errors = Errors::of(&truth, &Method::Engine.play(table, shot).unwrap());
            assert_eq!(errors.differs_at, None, "table {index}: {}", shot.command_line(&table.name));
            assert!(errors.rest_units < 1e3, "table {index}, {errors:?}: {}", shot.command_line(&table.name));
            assert!(truth.unaccounted.abs() < 1e-28, "table {index}: {}", shot.command_line(&table.name));
            jumps += truth.events.iter().filter(|event| matches!(event.1, EventKind::Jumps(_))).count();
            units.push(errors.rest_units);
        }
        units.sort_by(f64::total_cmp);
        assert!(units[units.len() / 2] < 2.0, "table {index}: {units:?}");
        assert!(jumps > 80 || table.flight.unwrap().restitution == 0.0, "table {index}: {jumps}");
    }
}

fn played(table: &Table, velocity: [f64; 3], spin: [f64; 3]) -> Shot<D> {
    let of = |v: [f64; 3]| Vector::of(v.into());
    let places = [[0.0; 3], [-1.0, 0.3, 0.0], [-1.0, -0.3, 0.0]].map(of);
    play(&Numbers::of(table), places, of(velocity), of(spin), by_extrema).unwrap()
}

#[test]
fn a_ball_thrown_straight_up_hops_for_the_sum_of_all_hops() {
    for restitution in [0.0, 0.5, 0.99] {
        let table =
            Table { flight: Some(Flight { restitution, friction: None }), ..Table::preset("textbook").unwrap() };
        let shot = played(&table, [0.0, 0.0, 2.0], [0.0, 0.0, 30.0]);
        // 2 V / g (1 - e), the last digits by division in double-double.
        let known = D::of(4.0) / (D::of(table.gravity) * (D::of(1.0) - D::of(restitution)));
        let late = shot.events.last().unwrap().0 - known;
        assert!(late.to_f64().abs() < 1e-28, "{restitution}: {}", late.to_f64());
        let kinds: Vec<_> = shot.events.iter().map(|event| event.1).collect();
        assert_eq!(kinds, [EventKind::Jumps(0), EventKind::Lands(0), EventKind::RollingStationary(0)]);
        assert_eq!(shot.end[0].position, Vector::zero());
    }
}

#[test]
fn strong_follow_climbs_the_nose_and_high_shots_leave_the_table() {
    let table = Table::default();
    let climbs = played(&table, [5.0, 0.0, 0.0], [0.0, 900.0, 0.0]);
    let kinds: Vec<_> = climbs.events.iter().map(|event| event.1).take(2).collect();
    assert_eq!(kinds, [EventKind::BallRail(0, Rail::Right), EventKind::Jumps(0)]);
    let off = played(&table, [5.0, 0.0, 1.5], [0.0; 3]);
    assert_eq!(off.events.last().map(|event| event.1), Some(EventKind::LeavesTable(0)));
    assert_eq!(off.end[0].motion, Motion::OffTable);
    assert!(off.energy[1].to_f64().abs() < 1e-28, "{:e}", off.energy[1].to_f64());
}

#[test]
fn stroke_into_the_cloth_agrees_with_the_engine() {
    let table = Table::default();
    let (numbers, of) = (Numbers::<D>::of(&table), D::of);
    for (b, theta) in [(0.1, 0.05), (-0.3, 0.6), (0.4, 1.4)] {
        let cue = crate::physics::CueInputs { a: 0.2, b, theta, phi: 1.1, speed: 3.0 };
        let shot = StudyShot::new(&table, crate::table::Layout::opening(&table), cue);
        let stroke =
            Stroke { a: of(0.2), b: of(b), theta: of(theta).sin_cos(), phi: of(1.1).sin_cos(), speed: of(3.0) };
        let (velocity, spin) = strike(&numbers, &stroke);
        let known = shot.impulse.velocity.extend(shot.impulse.lift);
        let [v, w] = [velocity, spin].map(Vector::to_f64);
        assert!(v.distance(known) < 1e-14 && w.distance(shot.impulse.spin) < 1e-12, "{theta}: {v} {known}");
        assert!(v.z > 0.0);
    }
}
