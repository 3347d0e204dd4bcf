//! Errors of fixed time steps, and their convergence with smaller steps.

use super::*;
use crate::{
    physics::CueInputs,
    simulation::{Recording, Start},
};

fn record(steps: Steps, table: &Table, layout: &Layout, cue: &CueInputs) -> (Recording, SteppedShot) {
    let play = Recording::record_with(table, layout, Start::Stroke(cue), |impulse, recorder| {
        let stepped = steps.simulate(table, layout, impulse, recorder);
        (stepped.end, stepped)
    });
    play.unwrap()
}

fn play(dt: f64, locate: bool, shot: &str) -> (Recording, SteppedShot) {
    let table = Table::preset("textbook").unwrap();
    let cue = CueInputs::parse(shot).unwrap();
    record(Steps::new(dt, locate).unwrap(), &table, &Layout::opening(&table), &cue)
}

/// Greatest distance between the final positions of a ball, m.
fn apart(one: &Recording, other: &Recording) -> f64 {
    let pairs = one.final_layout().balls.into_iter().zip(other.final_layout().balls);
    pairs.map(|(a, b)| a.distance(b)).fold(0.0, f64::max)
}

fn error(dt: f64, locate: bool) -> f64 {
    let shot = "0,0.2,5,12.5,3";
    let table = Table::preset("textbook").unwrap();
    let exact = Recording::new(&table, &Layout::opening(&table), &CueInputs::parse(shot).unwrap()).unwrap();
    apart(&exact, &play(dt, locate, shot).0)
}

#[test]
fn error_is_proportional_to_the_step() {
    let (coarse, fine) = (error(1e-3, false), error(1e-4, false));
    assert!(coarse > 1e-4 && fine < 0.3 * coarse, "{coarse:e}, {fine:e}");
}

#[test]
fn events_located_within_the_step_are_as_exact_as_the_engine() {
    let error = error(1e-2, true);
    assert!(error < 1e-11, "{error:e}");
}

#[test]
fn a_fast_ball_passes_through_another_between_two_steps() {
    // 2 m/s at 0.1 s a step: the ball moves 0.2 m in a step, past a ball of 0.06 m.
    let kinds = |dt| {
        let (recording, _) = play(dt, false, "0,0,0,0,3");
        recording.events().iter().any(|event| event.kind == EventKind::BallBall(0, 2))
    };
    assert!(kinds(1e-3) && !kinds(0.2));
}

#[test]
fn late_events_leave_overlaps_and_they_are_reported() {
    let deepest = play(1e-2, false, "0,0,0,0,6").1.deepest_overlap;
    assert!(deepest > 1e-3, "{deepest}");
    assert!(play(1e-2, true, "0,0,0,0,6").1.deepest_overlap < 1e-9);
}

#[test]
fn stepped_shots_end_for_any_step_length() {
    for (dt, shot) in [(1.0, "0,0,0,0,6"), (0.3, "0,-0.5,0,40,8"), (0.1, "0.4,0.3,20,100,9")] {
        let (recording, stepped) = play(dt, false, shot);
        let end = recording.duration();
        assert!((0..3).all(|ball| recording.state(ball, end).velocity == DVec2::ZERO), "{dt}: not at rest");
        assert!(stepped.steps as f64 * dt < end + 2.0 * dt, "{dt}: steps after the end");
    }
}

/// Distance between the final positions of steps and engine, m, in a shot in which a ball jumps, hits another in the air and
/// hops.
fn error_of_a_jump(dt: f64, locate: bool) -> f64 {
    let table = Table { flight: Some(crate::table::Flight::default()), ..Table::default() };
    let layout = Layout::new([DVec2::new(-0.5, 0.0), DVec2::new(-0.28, 0.01), DVec2::new(0.9, 0.5)]);
    let cue = CueInputs::parse("0.1,0,40,0,3.5").unwrap();
    let exact = Recording::new(&table, &layout, &cue).unwrap();
    let (stepped, outcome) = record(Steps::new(dt, locate).unwrap(), &table, &layout, &cue);
    assert!(outcome.at_rest);
    if locate {
        let kinds = |shot: &Recording| shot.events().iter().map(|event| event.kind).collect::<Vec<_>>();
        assert_eq!(kinds(&exact), kinds(&stepped));
        let aloft = kinds(&exact).iter().filter(|kind| matches!(kind, EventKind::Jumps(_))).count();
        assert!(aloft >= 1 && kinds(&exact).contains(&EventKind::BallBall(0, 1)));
    }
    apart(&exact, &stepped)
}

#[test]
fn stepped_flights_with_located_events_match_the_engine() {
    let (coarse, fine) = (error_of_a_jump(1e-3, false), error_of_a_jump(1e-5, false));
    assert!(coarse > 1e-4 && fine < 0.3 * coarse, "{coarse:e}, {fine:e}");
    let located = error_of_a_jump(1e-2, true);
    assert!(located < 1e-10, "{located:e}");
}

#[test]
fn stepped_ball_shot_over_the_rail_leaves_the_table() {
    let table = Table { flight: Some(crate::table::Flight::default()), ..Table::default() };
    let layout = Layout::new([DVec2::new(0.9, 0.0), DVec2::new(0.0, 0.3), DVec2::new(0.0, -0.3)]);
    let cue = CueInputs::parse("0,0,30,0,9").unwrap();
    let (_, stepped) = record(Steps::new(1e-3, false).unwrap(), &table, &layout, &cue);
    assert_eq!((stepped.end.off_table, stepped.at_rest), ([true, false, false], true));
}

#[test]
fn unusable_step_is_named_in_the_error() {
    for dt in [0.0, -1.0, f64::NAN, 1e-12, 3.0] {
        assert!(Steps::new(dt, false).unwrap_err().to_string().contains(&number(dt)));
    }
}
