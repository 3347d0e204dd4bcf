//! Points under every rule, in layouts that are constructed so that anybody can count: the object balls are put in the cue ball's path
//! after a given number of cushions.

use carom::{
    game::{Rule, scores},
    physics::CueInputs,
    simulation::{EventKind, Recording},
    table::{Layout, Table},
};
use glam::DVec2;

/// Returns the contacts of the cue ball in order: 1 and 2 are object balls, 0 is a cushion.
fn course(recording: &Recording) -> Vec<usize> {
    let met = |kind: EventKind| match kind {
        EventKind::BallBall(0, ball) => Some(ball),
        EventKind::BallRail(0, _) => Some(0),
        _ => None,
    };
    recording.events().iter().filter_map(|event| met(event.kind)).collect()
}

fn play(table: &Table, balls: [DVec2; 3], shot: &CueInputs) -> Recording {
    Recording::new(table, &Layout::new(balls), shot).unwrap()
}

/// Returns position and direction of the cue ball, halfway in time between its contact `number` (0 is the stroke) and the next one.
fn cue_ball_after(recording: &Recording, number: usize) -> (DVec2, DVec2) {
    let of_cue = |kind: EventKind| matches!(kind, EventKind::BallBall(0, _) | EventKind::BallRail(0, _));
    let meetings = recording.events().iter().filter(|event| of_cue(event.kind)).map(|event| event.time);
    let times: Vec<f64> = [0.0].into_iter().chain(meetings).collect();
    let state = recording.state(0, 0.5 * (times[number] + times[number + 1]));
    (state.position, state.velocity.normalize())
}

/// Builds a shot that zigzags between the long cushions. Ball 1 is in its path after `before` cushions, hit thin, and ball 2 after
/// `between` more cushions, hit full.
fn build_shot(table: &Table, before: usize, between: usize) -> ([DVec2; 3], CueInputs) {
    let shot = CueInputs::parse("0,0,0,70,5").unwrap();
    let away = [DVec2::new(-1.35, -0.65), DVec2::new(-1.35, 0.65)];
    let cue = DVec2::new(-0.9, -0.3);
    let diameter = 2.0 * table.radius;
    let (place, way) = cue_ball_after(&play(table, [cue, away[0], away[1]], &shot), before);
    let aside = 0.95 * diameter;
    let first = place + way * (diameter * diameter - aside * aside).sqrt() + way.perp() * aside;
    let (place, way) = cue_ball_after(&play(table, [cue, first, away[1]], &shot), before + 1 + between);
    ([cue, first, place + way * diameter], shot)
}

#[test]
fn cushions_count_anywhere_before_the_second_ball() {
    let table = Table::preset("textbook").unwrap();
    for (before, between) in [(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2), (3, 0), (2, 1), (1, 2), (0, 3)] {
        let (balls, shot) = build_shot(&table, before, between);
        let expected = [vec![0; before], vec![1], vec![0; between], vec![2]].concat();
        let course = course(&play(&table, balls, &shot));
        assert!(course.starts_with(&expected), "{before} and {between}: {course:?}");
        let cushions = before + between;
        let layout = Layout::new(balls);
        let points = Rule::ALL.map(|rule| scores(rule, &table, &layout, &shot));
        assert_eq!(points, [true, cushions >= 1, cushions >= 3], "{before} and {between}");
    }
}

#[test]
fn cushions_after_the_second_ball_do_not_count() {
    let table = Table::preset("textbook").unwrap();
    for between in [0, 2] {
        let (balls, shot) = build_shot(&table, 0, between);
        let course = course(&play(&table, balls, &shot));
        let rest = &course[course.iter().position(|&met| met == 2).unwrap()..];
        assert!(rest.contains(&0), "there is a cushion after it: {course:?}");
        assert!(!scores(Rule::ThreeCushion, &table, &Layout::new(balls), &shot));
    }
}

#[test]
fn hitting_the_same_ball_twice_is_no_point() {
    let table = Table::preset("textbook").unwrap();
    // Straight at a ball in front of the short cushion: that ball comes back and is met again.
    let balls = [DVec2::new(0.0, 0.0), DVec2::new(1.2, 0.0), DVec2::new(-1.2, 0.6)];
    let shot = CueInputs::parse("0,0.3,0,0,3").unwrap();
    let course = course(&play(&table, balls, &shot));
    assert!(course.iter().filter(|&&met| met == 1).count() >= 2 && !course.contains(&2), "{course:?}");
    assert!(!Rule::ALL.iter().any(|&rule| scores(rule, &table, &Layout::new(balls), &shot)));
}

/// Under the UMB rules, a player whose ball is frozen to another may play away from it, or have the balls spotted. Touching does not count
/// as a contact: after playing away, the frozen ball must be met again. (Playing onto it is a foul under those rules; here the impact
/// counts, because the simulator has no fouls.)
#[test]
fn a_frozen_ball_counts_only_after_a_new_contact() {
    let table = Table::preset("textbook").unwrap();
    let frozen = DVec2::new(-2.0 * table.radius, 0.0);
    let away = CueInputs::parse("0,0,0,0,1.2").unwrap();
    // The other ball is met, and the cue ball stays there: one ball.
    let balls = [DVec2::ZERO, frozen, DVec2::new(0.6, 0.0)];
    let met = course(&play(&table, balls, &away));
    assert!(met.contains(&2) && !met.contains(&1), "{met:?}");
    assert!(!scores(Rule::StraightRail, &table, &Layout::new(balls), &away));
    // Met again after a cushion, it counts: the other ball is behind it, a little to the side.
    let hard = CueInputs::parse("0,0,0,0,4").unwrap();
    let balls = [DVec2::ZERO, frozen, DVec2::new(-0.6, 0.6)];
    assert_eq!(course(&play(&table, balls, &hard))[..2], [0, 1]);
    // Played onto, it is met at once.
    let onto = CueInputs::parse("0,0,0,180,3").unwrap();
    assert_eq!(course(&play(&table, balls, &onto))[0], 1);
}
