//! Simultaneous impacts in the air do not depend on the numbering of balls and cushions.

use std::ops::ControlFlow;

use glam::{DVec2, DVec3};
use proptest::prelude::*;

use crate::{
    physics::{CueInputs, Impulse, SpatialState, strike},
    simulation::{AllSavings, End, Event, EventKind, Observer, Rail, engine::Engine, simulate},
    table::{BALLS, Layout, Table},
};

/// All events of a shot.
#[derive(Default)]
struct Events(Vec<Event>);

impl Observer for Events {
    fn event(&mut self, event: Event) -> ControlFlow<()> {
        self.0.push(event);
        ControlFlow::Continue(())
    }
}

/// Plays a shot.
fn play(table: &Table, layout: &Layout, impulse: &Impulse) -> (Vec<Event>, End) {
    let mut reported = Events::default();
    let end = simulate(table, layout, impulse, &mut reported);
    (reported.0, end)
}

/// Lets ball 0 go in the air, with the other balls at rest.
fn let_go(table: &Table, others: [DVec2; 2], state: &SpatialState) -> (Vec<Event>, End) {
    let layout = Layout::new([state.position.truncate(), others[0], others[1]]);
    let mut reported = Events::default();
    let mut engine = Engine::<AllSavings, Events>::new(table, &layout, &mut reported);
    let flow = engine.launch_in_space(0, 0.0, state);
    assert!(flow.is_continue() && engine.predict_ball(0.0, 0).is_continue());
    let time = engine.run_events(flow);
    let end = engine.finish(time);
    (reported.0, end)
}

/// Returns `place` mirrored at the line through the origin along the unit vector `along`.
fn mirrored(place: DVec2, along: DVec2) -> DVec2 {
    2.0 * place.dot(along) * along - place
}

/// Returns how far the end is from symmetry about the line through the origin along `along`: the cue ball's distance from it, and the
/// object balls' from each other's mirror images, m.
fn asymmetry(end: &End, along: DVec2) -> f64 {
    let [cue_ball, one, other] = end.balls.map(|ball| ball.position);
    cue_ball.perp_dot(along).abs().max(one.distance(mirrored(other, along)))
}

/// Plays a break into two balls that touch each other, along a line through the middle of the table, from the distance `back` behind the
/// contact with both, m, with the cue raised by `degrees`.
fn symmetric_break(along: DVec2, back: f64, degrees: f64, speed: f64) -> (Vec<Event>, End) {
    let table = Table::default();
    let beside = table.radius * along.perp();
    let from = -(3.0_f64.sqrt() * table.radius + back) * along;
    let layout = Layout::new([from, beside, -beside]);
    let cue = CueInputs::parse(&format!("0,0,{degrees},{},{speed}", along.to_angle().to_degrees())).unwrap();
    play(&table, &layout, &strike(&table, &cue))
}

/// Returns the balls that ball 0 hits at the time of its first impact with a ball, and whether it is in the air then.
fn first_hits(events: &[Event]) -> ([bool; BALLS], bool) {
    let hits = |event: &&Event| matches!(event.kind, EventKind::BallBall(0, _));
    let Some(first) = events.iter().find(hits) else { return ([false; BALLS], false) };
    let together = || events.iter().take_while(|event| event.time <= first.time);
    let hit = std::array::from_fn(|ball| together().any(|event| event.kind == EventKind::BallBall(0, ball)));
    let jumps = together().filter(|event| event.kind == EventKind::Jumps(0)).count();
    let lands = events.iter().take_while(|event| event.time < first.time);
    (hit, jumps > lands.filter(|event| event.kind == EventKind::Lands(0)).count())
}

/// Rounding is amplified by the impacts that follow, which are a few.
const SYMMETRIC: f64 = 1e-9;

#[test]
fn symmetric_break_of_a_frozen_triangle_with_a_raised_cue_stays_symmetric() {
    for degrees in [3.0, 0.5, 10.0, 30.0] {
        for speed in [0.5, 1.0, 3.0] {
            let (events, end) = symmetric_break(DVec2::X, 0.0, degrees, speed);
            assert_eq!(first_hits(&events), ([false, true, true], true), "{degrees}°, {speed} m/s: {events:?}");
            let off = asymmetry(&end, DVec2::X);
            assert!(off < SYMMETRIC, "{degrees}°, {speed} m/s: {off:e}, {end:?}");
        }
    }
}

#[test]
fn symmetric_break_by_a_hopping_ball_stays_symmetric() {
    for (back, degrees) in [(0.02, 3.0), (0.06, 3.0), (0.02, 10.0), (0.1, 10.0), (0.2, 10.0)] {
        let (events, end) = symmetric_break(DVec2::X, back, degrees, 2.0);
        assert_eq!(first_hits(&events), ([false, true, true], true), "{back} m, {degrees}°: {events:?}");
        let off = asymmetry(&end, DVec2::X);
        assert!(off < SYMMETRIC, "{back} m, {degrees}°: {off:e}, {end:?}");
    }
}

/// The object balls leave as mirror images, whatever line they are struck along: their gaps then differ by rounding.
#[test]
fn break_with_a_raised_cue_along_any_line_hits_both_balls_at_once() {
    for index in 0..40 {
        let along = DVec2::from_angle(0.16 * f64::from(index) + 0.01);
        for (back, degrees) in [(0.0, 3.0), (0.05, 6.0), (0.3, 25.0)] {
            let (events, _) = symmetric_break(along, back, degrees, 2.0);
            let (hit, flies) = first_hits(&events);
            assert_eq!((hit, flies), ([false, true, true], true), "{along}, {back} m, {degrees}°: {events:?}");
        }
    }
}

#[test]
fn ball_that_lands_between_two_balls_drives_them_apart_symmetrically() {
    let table = Table::default();
    for beside in [1.0, 1.3, 1.6, 1.9] {
        for (height, speed) in [(0.1, 0.0), (0.08, 0.3), (0.06, 1.0)] {
            let others = [1.0, -1.0].map(|side| DVec2::new(0.0, side * beside * table.radius));
            // Above the middle when it touches both.
            let (down, touches) = (0.5, table.radius * (4.0 - beside * beside).sqrt());
            let squared = down * down + 2.0 * table.gravity * (height - touches);
            let falls = (squared.sqrt() - down) / table.gravity;
            let state = SpatialState {
                position: DVec3::new(-speed * falls, 0.0, height),
                velocity: DVec3::new(speed, 0.0, -down),
                spin: DVec3::new(0.0, 20.0, 0.0),
            };
            let (events, end) = let_go(&table, others, &state);
            assert_eq!(first_hits(&events).0, [false, true, true], "{beside}, {height}, {speed}: {events:?}");
            let off = asymmetry(&end, DVec2::X);
            assert!(off < SYMMETRIC, "{beside}, {height}, {speed}: {off:e}, {end:?}");
        }
    }
}

#[test]
fn ball_in_the_air_hits_both_noses_of_a_corner_together() {
    let table = Table { length: 1.5, width: 1.5, ..Table::default() };
    for (height, climb) in [(0.0, 0.3), (0.01, 0.0), (0.02, 0.4)] {
        let state = SpatialState {
            position: DVec3::new(0.55, 0.55, height),
            velocity: DVec3::new(1.5, 1.5, climb),
            spin: DVec3::ZERO,
        };
        let (events, end) = let_go(&table, [DVec2::new(-0.5, 0.1), DVec2::new(0.1, -0.5)], &state);
        let hit = |rail| events.iter().find(|event| event.kind == EventKind::BallRail(0, rail)).map(|event| event.time);
        assert!(hit(Rail::Right).is_some() && hit(Rail::Right) == hit(Rail::Top), "{height}, {climb}: {events:?}");
        let place = end.balls[0].position;
        assert!((place.x - place.y).abs() < SYMMETRIC, "{height}, {climb}: {place}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    /// Ball 0 is struck, with a raised cue, at two balls that it touches and that may touch each other.
    #[test]
    fn exchanging_the_object_balls_exchanges_the_results(
        turn in -3.1..3.1f64,
        // 60° is a frozen triangle; at 180° the balls lie in a row.
        between in prop_oneof![Just(60.0_f64.to_radians()), 1.05..3.0f64],
        aside in -0.9..0.9f64,
        (a, b) in (-0.3..0.3f64, -0.3..0.3f64),
        theta in 0.02..0.6f64,
        speed in 0.3..2.0f64,
        place in [-0.3..0.3f64, -0.2..0.2f64],
    ) {
        let table = Table::default();
        let from = DVec2::from_array(place);
        let ball = |angle: f64| from + 2.0 * table.radius * DVec2::from_angle(turn + angle);
        let balls = [from, ball(0.5 * between), ball(-0.5 * between)];
        let cue = CueInputs { a, b, theta, phi: turn + 0.5 * between * aside, speed };
        let impulse = strike(&table, &cue);
        let (events, end) = play(&table, &Layout::new(balls), &impulse);
        let (others, exchanged) = play(&table, &Layout::new([balls[0], balls[2], balls[1]]), &impulse);
        // Longer shots amplify rounding.
        if events.len() > 24 {
            return Ok(());
        }
        prop_assert_eq!(events.len(), others.len());
        for (ball, other) in [(0, 0), (1, 2), (2, 1)] {
            let apart = end.balls[ball].position.distance(exchanged.balls[other].position);
            prop_assert!(apart < 1e-9, "ball {}: {:e}, {:?} {:?}", ball, apart, events, others);
        }
    }
}
