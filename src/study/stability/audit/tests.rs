//! Violations that the audit detects, and shots that it accepts.

use glam::DVec2;
use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;

use super::*;
use crate::{
    physics::{BallState, CueDegrees},
    simulation::{Course, Rail},
    study::stability::{Case, Shot, cases, random},
    table::{Flight, Layout, RailModel, RailOverrides, Rails, THESIS_PRESETS},
};

/// Returns the largest unexplained energy in a shot after tampering, as a multiple of the tolerance.
fn unexplained(table: &Table, shot: &Shot, tamper: impl FnOnce(&mut Trace)) -> f64 {
    let mut trace = Trace::of(table, shot);
    tamper(&mut trace);
    left_by(table, &trace)
}

/// Returns the same for a shot that has been played, by the laws of a table.
fn left_by(table: &Table, trace: &Trace) -> f64 {
    let mut figures = Figures::default();
    audit(table, trace, &mut figures);
    figures.unexplained.value
}

fn case_called(name: &str) -> Case {
    cases().into_iter().find(|case| case.name == name).unwrap()
}

/// A shot over two cushions and a ball.
fn lively() -> (Table, Shot) {
    let layout = Layout::new([DVec2::new(-0.5, 0.01), DVec2::ZERO, DVec2::new(1.0, 0.5)]);
    (
        Table::preset("textbook").unwrap(),
        Shot { layout, cue: CueDegrees { a: 0.2, b: 0.3, ..CueDegrees::centre(0.0, 4.0) } },
    )
}

/// A shot on the thesis' table whose cue ball is pressed against a cushion for a while.
fn pressed() -> (Table, Shot) {
    let table = Table::preset("thesis").unwrap();
    let case = case_called("a ball resting on a cushion");
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(1);
    loop {
        let shot = (case.shot)(&table, &mut rng);
        let trace = Trace::of(&table, &shot);
        if trace.pieces[0].iter().filter(|piece| piece.segment.motion == Motion::Resting).count() > 3 {
            return (table, shot);
        }
    }
}

/// The side spin of a ball ends on its way along a cushion.
#[test]
fn a_spin_that_ends_against_a_cushion_is_explained() {
    let table = Table::preset("thesis").unwrap();
    let shot = r#"{"layout": [[0.6605517353993215, -0.3942754478236047], [0.4614715737467585, -0.423863774229514],
        [0.16292131207569605, -0.1396717743680046]], "cue": {"a": -0.31536479533037, "b": 0.8130529572876475,
        "phi_deg": -7.48977395544091, "speed": 33.16013417052466, "theta_deg": 10.061314137005898}}"#;
    let left = unexplained(&table, &serde_json::from_str(shot).unwrap(), |_| {});
    assert!(left < 1.0, "{left}");
}

fn piece_of(trace: &mut Trace, motion: Motion, last: bool) -> &mut Piece {
    let mut all = trace.pieces[0].iter_mut().filter(|piece| piece.segment.motion == motion);
    if last { all.next_back() } else { all.next() }.expect("the cue ball moves like that")
}

/// Ends a piece just before its speed reaches zero, and stops the ball there.
fn stop_from(speed: f64, table: &Table, trace: &mut Trace) {
    let early = speed / crate::physics::Rolling::of(table).least;
    let now = {
        let piece = piece_of(trace, Motion::Rolling, true);
        piece.end -= early;
        piece.end
    };
    if let Some(rest) = trace.pieces[0].last_mut().filter(|piece| piece.segment.motion == Motion::Stationary) {
        rest.segment.start = now;
    }
}

#[test]
fn ordinary_shots_leave_nothing_unexplained() {
    for name in THESIS_PRESETS {
        let table = Table::preset(name).unwrap();
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(5);
        let left = (0..150).map(|_| unexplained(&table, &random::shot(&table, &mut rng), |_| {}));
        let unexplained: Vec<f64> = left.filter(|left| *left > 1.0).collect();
        assert!(unexplained.is_empty(), "on {name}: {unexplained:?}");
    }
    for (table, shot) in [lively(), pressed()] {
        assert!(unexplained(&table, &shot, |_| {}) < 1.0);
    }
}

#[test]
fn sudden_stop_of_a_ball_is_detected() {
    let (table, shot) = lively();
    let stop = |trace: &mut Trace| {
        let segment = &mut trace.pieces[0][1].segment;
        (segment.velocity, segment.spin) = (DVec2::ZERO, glam::DVec3::ZERO);
    };
    assert!(unexplained(&table, &shot, stop) > 1e9);
}

#[test]
fn early_end_of_a_roll_is_detected() {
    let (table, shot) = lively();
    for (speed, seen) in [(1e-3, 1e6), (1e-6, 1.0)] {
        let left = unexplained(&table, &shot, |trace| stop_from(speed, &table, trace));
        assert!(left > seen, "from {speed} m/s: {left}");
    }
}

#[test]
fn impact_with_wrong_energy_loss_is_detected() {
    let (table, shot) = lively();
    for share in [1.0 - 1e-9, 1.0 + 1e-9] {
        let left = unexplained(&table, &shot, |trace| trace.pieces[0][1].segment.velocity *= share);
        assert!(left > 100.0, "{share}: {left}");
    }
}

/// The audit does not check impacts on rails with a law that the reference engine does not implement.
#[test]
fn impacts_on_rails_of_another_law_are_not_judged() {
    let (table, shot) = lively();
    let rail = Rails { model: RailModel::Mathavan, height: Some(0.036), ..Rails::default() };
    let left = unexplained(&Table { rail, ..table }, &shot, |_| {});
    assert!(left < 1.0, "{left}");
}

#[test]
fn excess_friction_loss_is_detected() {
    let (table, shot) = lively();
    for motion in [Motion::Sliding, Motion::Rolling] {
        let brake = |trace: &mut Trace| piece_of(trace, motion, false).segment.half_acceleration *= 1.0 + 1e-9;
        let left = unexplained(&table, &shot, brake);
        assert!(left > 100.0, "{motion:?}: {left}");
    }
}

#[test]
fn excess_loss_of_a_resting_contact_is_detected() {
    let (table, shot) = pressed();
    let drag = |trace: &mut Trace| {
        let piece = piece_of(trace, Motion::Resting, false);
        let time = piece.end - piece.segment.start;
        let spin = 1e-6 * piece.segment.spin / time;
        let Some(Course::Contact(curve)) = piece.segment.course.as_deref_mut() else { panic!("a contact") };
        curve.spin[0] -= spin;
    };
    let left = unexplained(&table, &shot, drag);
    assert!(left > 10.0, "{left}");
}

/// Balls pressed between others and cushions, audited by the laws of their own table and of others.
#[test]
fn wrong_friction_in_coupled_contacts_is_detected() {
    let case = case_called("a ball pressed between ball and cushion");
    let table = (case.tables)().into_iter().find(|table| table.name == "thesis").unwrap();
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(3);
    let traces: Vec<Trace> = (0..20).map(|_| Trace::of(&table, &(case.shot)(&table, &mut rng))).collect();
    let seen = |table: &Table| traces.iter().filter(|trace| left_by(table, trace) > 1.0).count();
    let with_own_rails = |mu: f64| {
        let own = Some(RailOverrides { mu: Some(mu), ..RailOverrides::default() });
        let rail = Rails { left: own, right: own, bottom: own, top: own, ..table.rail };
        Table { rail, rail_friction: 0.0, ..table.clone() }
    };
    assert_eq!((seen(&table), seen(&with_own_rails(table.rail_friction))), (0, 0));
    // Not every ball slips on its cushion; all roll and spin.
    let others = [
        (with_own_rails(0.98 * table.rail_friction), 5),
        (Table { rail_friction: 0.98 * table.rail_friction, ..table.clone() }, 5),
        (Table { rolling_friction: 0.5 * table.rolling_friction, ..table.clone() }, 20),
        (Table { spinning_friction: 0.5 * table.spinning_friction, ..table.clone() }, 20),
    ];
    for (other, least) in &others {
        assert!(seen(other) >= *least, "{} of {least}", seen(other));
    }
}

/// A stroke with a raised cue at a ball near by, audited by the laws of its own table and of others.
#[test]
fn wrong_energy_losses_in_the_air_are_detected() {
    let flight = Flight { restitution: 0.5, friction: Some(0.2) };
    let table = Table { flight: Some(flight), ..Table::preset("textbook").unwrap() };
    let layout = Layout::new([DVec2::new(-0.5, 0.0), DVec2::new(-0.36, 0.01), DVec2::new(1.0, 0.5)]);
    let shot = Shot { layout, cue: CueDegrees { theta_deg: 20.0, ..CueDegrees::centre(0.0, 3.0) } };
    let trace = Trace::of(&table, &shot);
    assert!(trace.events.iter().any(|event| event.kind == EventKind::BallBall(0, 1)));
    let left = |table: &Table| left_by(table, &trace);
    assert!(left(&table) < 1.0, "{}", left(&table));
    let others = [
        Table { flight: Some(Flight { restitution: 0.5 + 1e-7, ..flight }), ..table.clone() },
        Table { flight: Some(Flight { friction: Some(0.2 - 1e-7), ..flight }), ..table.clone() },
        Table { ball_restitution: table.ball_restitution - 1e-7, ..table.clone() },
        Table { ball_friction: table.ball_friction.map(|friction| friction + 1e-7), ..table.clone() },
    ];
    for other in &others {
        assert!(left(other) > 100.0, "{}", left(other));
    }
}

/// A ball that hits a cushion with 1 mm/s and keeps no speed perpendicular to it.
fn dead_impact(table: &Table, rests: bool) -> Residual {
    let mut before = [BallState::at_rest(DVec2::ZERO); BALLS];
    before[0].velocity = DVec2::new(0.0, -1e-3);
    let (contact, numbers) = (Contact::Rail(0, Rail::Bottom), &Numbers::of(table));
    let impacts = vec![contact];
    let after = [BallState::at_rest(DVec2::ZERO); BALLS];
    let rests = [rests, false, false];
    let moment =
        Moment { table, numbers, before, after, rested: [false; BALLS], rests, impacts, closed: vec![contact] };
    moment.residual([true, false, false])
}

#[test]
fn impact_loses_all_energy_only_with_time_for_omitted_bounces() {
    let table = Table::preset("textbook").unwrap();
    let e = table.rail_restitution;
    let Residual { unexplained, bounces } = dead_impact(&table, false);
    assert!((unexplained - 0.5e-6 * e * e).abs() < 1e-15 && bounces.is_none());
    let Residual { unexplained, bounces } = dead_impact(&table, true);
    let bounces = bounces.unwrap();
    assert!(unexplained.abs() < 1e-15 && (bounces.energy - 0.5e-6 * e * e).abs() < 1e-15);
    assert!(bounces.duration > 1e-3);
}
