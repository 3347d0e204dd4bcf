//! Tests of the whole engine, with balls that rest against each other or against cushions.

mod flight;

use super::*;
use crate::{
    physics,
    simulation::EventKind,
    study::{
        Errors, Method, Truth,
        shots::{MaxElevation, StudyShot, random_shots},
    },
    table::{BALLS, Fade, RailModel, RailOverrides, Rails, SlipFriction, Table},
};

type D = DoubleDouble;

fn vector(x: f64, y: f64, z: f64) -> Vector<D> {
    Vector::of(glam::DVec3::new(x, y, z))
}

fn thesis() -> Table {
    Table::preset("thesis").unwrap()
}

/// Plays a shot with balls numbered by `order`, and with the y axis mirrored if `mirrored`.
fn played(table: &Table, shot: &StudyShot, order: [usize; BALLS], mirrored: bool) -> Shot<D> {
    let sign = if mirrored { -1.0 } else { 1.0 };
    let (v, w) = (shot.impulse.velocity, shot.impulse.spin);
    let places = order.map(|ball| shot.layout.balls[ball]).map(|ball| vector(ball.x, sign * ball.y, 0.0));
    let spin = vector(sign * w.x, w.y, sign * w.z);
    play(&Numbers::of(table), places, vector(v.x, sign * v.y, 0.0), spin, by_extrema).unwrap()
}

/// Shots on `thesis` with resting contacts, ball–ball contacts among them.
fn resting_shots() -> impl Iterator<Item = (StudyShot, Shot<D>)> {
    let shots = random_shots(&thesis(), 60, 3, MaxElevation::USUAL).into_iter();
    shots.map(|shot| (shot, played(&thesis(), &shot, [0, 1, 2], false))).filter(|(_, played)| played.pressed)
}

fn distance(one: Vector<D>, other: Vector<D>) -> f64 {
    (one - other).length().to_f64()
}

#[test]
fn friction_and_impacts_account_for_all_energy_in_resting_contacts() {
    let mut count = 0;
    for (shot, played) in resting_shots() {
        let unaccounted = (played.energy[1] / played.energy[0]).to_f64().abs();
        assert!(unaccounted < 1e-23, "{unaccounted:e}: {}", shot.command_line("thesis"));
        count += 1;
    }
    assert!(count >= 5, "{count}");
}

#[test]
fn mirroring_and_renumbering_change_nothing() {
    for (shot, played_first) in resting_shots() {
        let mirrored = played(&thesis(), &shot, [0, 1, 2], true);
        let renumbered = played(&thesis(), &shot, [0, 2, 1], false);
        for (ball, other) in [0, 2, 1].into_iter().enumerate() {
            let end = played_first.end[ball].position;
            let image = mirrored.end[ball].position;
            let error = distance(end, Vector::new(image.x, -image.y, image.z));
            assert!(error < 1e-20, "mirrored {error:e}: {}", shot.command_line("thesis"));
            let error = distance(end, renumbered.end[other].position);
            assert!(error < 1e-20, "renumbered {error:e}: {}", shot.command_line("thesis"));
        }
    }
}

#[test]
fn smooth_balls_that_push_each_other_keep_their_common_speed() {
    let table = Table { ball_restitution: 0.0, ball_friction: Some(0.0), ..thesis() };
    let numbers = Numbers::<D>::of(&table);
    let diameter = 2.0 * table.radius;
    let places = [vector(0.0, 0.0, 0.0), vector(diameter, 0.0, 0.0), vector(-1.0, 0.4, 0.0)];
    // Much topspin: the cloth drives the first ball exactly as much as it brakes the second, until the second rolls.
    let shot = play(&numbers, places, vector(1.0, 0.0, 0.0), vector(0.0, 150.0, 0.0), by_extrema).unwrap();
    let rolls = shot.events.iter().find(|(_, kind)| *kind == EventKind::SlidingRolling(1)).unwrap().0;
    // At the constant speed 1/2, the slip ends through the rotation alone.
    let known = D::of(0.5) / (D::of(2.5) * numbers.slide);
    assert!((rolls - known).to_f64().abs() < 1e-22, "{}", (rolls - known).to_f64());
    assert!(shot.pressed && shot.energy[1].to_f64().abs() < 1e-23, "{:e}", shot.energy[1].to_f64());
}

#[test]
fn ball_rolling_next_to_another_is_unaffected() {
    let table = thesis();
    let numbers = Numbers::<D>::of(&table);
    let shot = |x: f64| {
        let places = [vector(0.0, 0.0, 0.0), vector(x, 0.0, 0.0), vector(-1.0, 0.4, 0.0)];
        let spin = vector(-0.3 / table.radius, 0.0, 0.0);
        play(&numbers, places, vector(0.0, 0.3, 0.0), spin, by_extrema).unwrap()
    };
    let (beside, alone) = (shot(2.0 * table.radius), shot(0.5));
    assert!(distance(beside.end[0].position, alone.end[0].position) < 1e-28);
}

#[test]
fn an_impact_passes_through_a_row_of_balls() {
    let table = Table { ball_restitution: 1.0, ball_friction: Some(0.0), ..thesis() };
    let numbers = Numbers::<D>::of(&table);
    let diameter = 2.0 * table.radius;
    let places = [0.0, diameter, 2.0 * diameter].map(|x| vector(x, 0.0, 0.0));
    let shot = play(&numbers, places, vector(0.5, 0.0, 0.0), Vector::zero(), by_extrema).unwrap();
    let hits: Vec<EventKind> = shot.events.iter().map(|event| event.1).take(2).collect();
    assert_eq!(hits, [EventKind::BallBall(0, 1), EventKind::BallBall(1, 2)]);
    assert_eq!(distance(shot.end[0].position, places[0]), 0.0);
    assert_eq!(distance(shot.end[1].position, places[1]), 0.0);
}

#[test]
fn a_symmetric_break_stays_symmetric() {
    for table in [thesis(), Table::preset("textbook").unwrap()] {
        let numbers = Numbers::<D>::of(&table);
        let high = table.radius;
        let places = [vector(-0.3, 0.0, 0.0), vector(0.3, high, 0.0), vector(0.3, -high, 0.0)];
        let shot = play(&numbers, places, vector(1.5, 0.0, 0.0), vector(0.0, 20.0, 0.0), by_extrema).unwrap();
        let (left, right) = (shot.end[1].position, shot.end[2].position);
        assert!(distance(left, Vector::new(right.x, -right.y, right.z)) < 1e-26);
        assert!(shot.end[0].position.y.to_f64().abs() < 1e-26);
    }
}

#[test]
fn shots_in_single_precision_end_as_well() {
    for shot in random_shots(&thesis(), 60, 9, MaxElevation::USUAL) {
        assert!(Method::Single.play(&thesis(), &shot).is_some(), "{}", shot.command_line("thesis"));
    }
}

/// Tables with each model of a part by itself, and `match`, which has all models but one.
fn models() -> Vec<Table> {
    let textbook = || Table::preset("textbook").unwrap();
    let rails = |rail: Rails| Table { rail, ..textbook() };
    let high = Rails { height: Some(0.0365), ..Rails::default() };
    let fade = Some(Fade { from: 0.5, slope: 0.05, least: 0.6 });
    let own = |e, mu, height| Some(RailOverrides { e: Some(e), mu: Some(mu), height: Some(height) });
    vec![
        Table::default(),
        rails(Rails { model: RailModel::Nose, ..high }),
        rails(Rails { model: RailModel::Smooth, kappa: Some(1.3), ..high }),
        rails(Rails { model: RailModel::Equator, fade, ..high }),
        rails(Rails {
            model: RailModel::Smooth,
            left: own(0.8, 0.1, 0.034),
            right: own(0.9, 0.3, 0.038),
            bottom: Some(RailOverrides { e: Some(0.7), ..RailOverrides::default() }),
            top: Some(RailOverrides { mu: Some(0.15), ..RailOverrides::default() }),
            ..high
        }),
        Table { rolling_growth: 0.03, ..textbook() },
        Table { ball_fade: fade, ..textbook() },
        Table { ball_slip_friction: Some(SlipFriction { least: 0.01, rise: 0.1, fade: 1.1 }), ..textbook() },
    ]
}

#[test]
fn both_engines_agree_on_every_model_of_a_table() {
    for (index, table) in models().iter().enumerate() {
        let shots = random_shots(table, 60, 5, MaxElevation::USUAL);
        let mut units: Vec<f64> = Vec::new();
        for shot in &shots {
            let truth = Truth::of(table, shot).unwrap();
            let run = Method::Engine.play(table, shot).unwrap();
            let errors = Errors::of(&truth, &run);
            assert_eq!(errors.differs_at, None, "table {index}: {}", shot.command_line(&table.name));
            assert!(errors.rest_units < 1e3, "table {index}, {errors:?}: {}", shot.command_line(&table.name));
            assert!(truth.unaccounted.abs() < 1e-29, "table {index}: {}", shot.command_line(&table.name));
            units.push(errors.rest_units);
        }
        units.sort_by(f64::total_cmp);
        assert!(units[units.len() / 2] < 2.0, "table {index}: {units:?}");
    }
}

#[test]
fn rail_at_centre_height_equals_the_equator_model_on_cloth() {
    let at_centre = |model| {
        let rail = Rails { model, height: Some(Table::default().radius), ..Rails::default() };
        Table { rail, flight: None, ..Table::default() }
    };
    let [nose, equator] = [RailModel::Nose, RailModel::Equator].map(at_centre);
    for shot in random_shots(&nose, 30, 8, MaxElevation::USUAL) {
        let [one, other] = [&nose, &equator].map(|table| played(table, &shot, [0, 1, 2], false));
        for (one, other) in one.end.iter().zip(&other.end) {
            assert!(distance(one.position, other.position) < 1e-22, "{}", shot.command_line(&nose.name));
        }
    }
}

#[test]
fn squirt_agrees_with_the_engine() {
    let (table, of) = (Table::default(), D::of);
    let numbers = Numbers::<D>::of(&table);
    for a in [-0.49, -0.2, 0.0, 0.3, 0.49] {
        let cue = physics::CueInputs { a, b: 0.1, theta: 0.2, phi: 1.1, speed: 3.0 };
        let engine = physics::strike(&table, &cue);
        let stroke = Stroke { a: of(a), b: of(0.1), theta: of(0.2).sin_cos(), phi: of(1.1).sin_cos(), speed: of(3.0) };
        let (velocity, spin) = strike(&numbers, &stroke);
        assert!((velocity.x.to_f64() - engine.velocity.x).abs() < 1e-15, "{a}");
        assert!((velocity.y.to_f64() - engine.velocity.y).abs() < 1e-15, "{a}");
        assert!((spin.to_f64() - engine.spin).abs().cmplt(glam::DVec3::splat(1e-13)).all(), "{a}");
    }
}

#[test]
fn unsupported_models_are_named_and_not_judged() {
    let shot = random_shots(&thesis(), 1, 1, MaxElevation::USUAL)[0];
    let rail = Rails { model: RailModel::Mathavan, height: Some(0.036), ..Rails::default() };
    let integrated = Table { rail, ..thesis() };
    assert_eq!(Truth::of(&integrated, &shot).unwrap_err(), Unjudged::IntegratedRail);
    let tilted = Table { tilt: glam::DVec2::new(1e-3, 0.0), ..thesis() };
    assert_eq!(Truth::of(&tilted, &shot).unwrap_err(), Unjudged::Slope);
}
