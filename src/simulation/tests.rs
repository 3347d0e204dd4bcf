//! Engine tests on tables with models that go beyond the thesis.

use std::ops::ControlFlow;

use glam::{DVec2, DVec3, Vec2Swizzles};

use super::{Constants, Event, EventKind, Observer, Rail, Segment, resting::Resting, simulate};
use crate::{
    physics::{BallState, CueInputs, Impulse, Motion, Rolling, rolling_spin, slip, strike},
    table::{Layout, RailModel, RailOverrides, Rails, Table},
};

/// Returns the final position of the cue ball on `match` with a nose of this restitution, which draw makes the ball climb.
fn end_at_a_dead_nose(rail_restitution: f64) -> DVec2 {
    let rail = Rails { model: RailModel::Nose, height: Some(0.037_36), ..Rails::default() };
    let table = Table { rail, rail_restitution, rail_friction: 0.3, ..Table::default() };
    let layout = Layout::parse("1.2,0 -0.5,0.3 -0.5,-0.3", &table).unwrap();
    let cue = CueInputs::parse("0,-0.4,0,10,3").unwrap();
    simulate(&table, &layout, &strike(&table, &cue), &mut Course::default()).layout(&table).balls[0]
}

#[test]
fn end_position_is_continuous_at_the_rebound_limit_of_the_nose() {
    // A nose that stops the ball presses it down and hits it again until its approach speed is zero.
    let ends = [0.0955, 0.096, 0.0965].map(end_at_a_dead_nose);
    assert!(ends[0].distance(ends[1]) < 1.2 * ends[1].distance(ends[2]), "{ends:?}");
}

/// Events of a shot, and the segments of the cue ball with their ends.
#[derive(Default)]
struct Course {
    events: Vec<Event>,
    pieces: Vec<(Segment, f64)>,
}

impl Observer for Course {
    fn wants_segments(&self) -> bool {
        true
    }

    fn event(&mut self, event: Event) -> ControlFlow<()> {
        self.events.push(event);
        ControlFlow::Continue(())
    }

    fn segment(&mut self, ball: usize, segment: &Segment, end: f64) {
        if ball == 0 {
            self.pieces.push((segment.clone(), end));
        }
    }
}

/// Plays a shot and returns the record of the cue ball and its final position; the other balls are in the far corners, unless `second`
/// gives a position.
fn played(table: &Table, from: DVec2, velocity: DVec2, spin: DVec3, second: Option<DVec2>) -> (Course, DVec2) {
    let corner = table.reach() - DVec2::splat(0.001);
    among(table, [from, second.unwrap_or(-corner), DVec2::new(-corner.x, corner.y)], velocity, spin)
}

/// As [`played`], with given positions of all balls.
fn among(table: &Table, balls: [DVec2; 3], velocity: DVec2, spin: DVec3) -> (Course, DVec2) {
    let layout = Layout::new(balls);
    let mut course = Course::default();
    let end = simulate(table, &layout, &Impulse::on_cloth(velocity, spin), &mut course);
    (course, end.balls[0].position)
}

fn rolled(table: &Table, from: DVec2, velocity: DVec2) -> (Course, DVec2) {
    played(table, from, velocity, rolling_spin(table.radius, velocity).extend(0.0), None)
}

#[test]
fn each_rail_has_its_own_constants() {
    let own = |e, mu| Some(RailOverrides { e: Some(e), mu: Some(mu), height: None });
    let (left, right, bottom, top) = (own(0.6, 0.0), own(0.7, 0.01), own(0.8, 0.02), own(0.9, 0.03));
    for model in [RailModel::Equator, RailModel::Nose] {
        let rail = Rails { model, left, right, bottom, top, ..Rails::default() };
        let table = Table { rail, ..Table::default() };
        for (rail, own) in Rail::ALL.into_iter().zip([left, right, bottom, top]) {
            let RailOverrides { e, mu, .. } = own.unwrap();
            // Straight at the rail, with enough sidespin for friction at its limit.
            let from = -0.5 * rail.normal() * table.reach();
            let (course, _) = played(&table, from, -rail.normal(), DVec3::new(0.0, 0.0, 80.0), None);
            let hit = course.events.iter().position(|event| matches!(event.kind, EventKind::BallRail(..))).unwrap();
            assert_eq!(course.events[hit].kind, EventKind::BallRail(0, rail));
            let at = course.events[hit].time;
            let before = course.pieces.iter().find(|(_, end)| *end == at).unwrap();
            let state = before.0.state_after(&Constants::of(&table), at - before.0.start);
            let speed = state.velocity.length();
            let slip = DVec2::new(state.spin.z, state.spin.truncate().dot(rail.normal().perp()));
            let after = course.pieces.iter().find(|(piece, _)| piece.start == at).unwrap().0.velocity;
            assert!((after.dot(rail.normal()) / speed - e.unwrap()).abs() < 1e-12, "{model:?}, {rail:?}: {after}");
            let aside = after.dot(rail.normal().perp()).abs();
            let known = mu.unwrap() * (1.0 + e.unwrap()) * speed * slip.x.abs() / slip.length();
            assert!((aside - known).abs() < 1e-12, "{model:?}, {rail:?}: {after}");
        }
    }
}

#[test]
fn constants_of_every_rail_equal_those_of_all_rails() {
    let own = Some(RailOverrides { e: None, mu: Some(0.45), height: None });
    let dead = Table { rail_restitution: 0.0, rail_friction: 0.45, ..Table::preset("thesis").unwrap() };
    let rail = Rails { left: own, right: own, bottom: own, top: own, ..dead.rail };
    let each = Table { rail, rail_friction: 0.2, ..dead.clone() };
    for step in 0..40 {
        // Struck into a dead cushion with sidespin, the ball slides along it.
        let (angle, spin) = (0.15 * f64::from(step), DVec3::new(3.0, 80.0 - 4.0 * f64::from(step), -5.0));
        let [all, each] = [&dead, &each].map(|table| {
            let (course, end) = played(table, DVec2::new(1.1, 0.1), DVec2::from_angle(angle), spin, None);
            (course.events, end)
        });
        assert_eq!(all, each, "{step}");
    }
}

#[test]
fn edge_of_a_band_at_a_cushion_changes_nothing() {
    let table = Table::default();
    let rolling = Rolling::of(&table);
    let speed = 1.0;
    let (deceleration, end) = rolling.band(speed);
    let length = (speed * speed - end * end) / (2.0 * deceleration);
    let reach = table.reach().x;
    let hit = |from: f64| {
        let (course, stop) = rolled(&table, DVec2::new(from, 0.1), DVec2::X * speed);
        let first = course.events[0];
        assert_eq!(first.kind, EventKind::BallRail(0, Rail::Right), "{from}");
        let rails = course.events.iter().filter(|event| matches!(event.kind, EventKind::BallRail(..))).count();
        (first.time, stop, rails)
    };
    let (time, stop, rails) = hit(reach - length + 1e-9);
    assert!((time - (speed - end) / deceleration).abs() < 1e-7);
    for offset in -40..=40 {
        let (other, place, count) = hit(reach - length + 4e-17 * f64::from(offset).powi(3));
        assert!((other - time).abs() < 1e-8 && place.distance(stop) < 1e-7 && count == rails, "offset {offset}");
    }
}

#[test]
fn slow_balls_stop_where_the_law_says() {
    let table = Table::default();
    let least = Rolling::of(&table).least;
    for speed in [2.7e-2, 1e-2, 1e-3, 1e-5, 1e-7] {
        let (course, stop) = rolled(&table, DVec2::ZERO, DVec2::new(0.6, 0.8) * speed);
        let stops = course.events.iter().filter(|event| matches!(event.kind, EventKind::RollingStationary(0)));
        assert_eq!((stops.count(), course.events.len()), (1, 1), "{speed}");
        // With a resistance of c0 + c1 v, c1 v much smaller than c0.
        let growth = table.rolling_growth * speed / least;
        let known = speed * speed / least * (0.5 - growth / 3.0 + growth * growth / 4.0);
        assert!((stop.length() / known - 1.0).abs() < 1e-3, "{speed}: {} {known}", stop.length());
        assert!(stop.perp_dot(DVec2::new(0.6, 0.8)).abs() < 1e-15);
    }
}

#[test]
fn last_band_stops_a_ball_without_a_jump() {
    // A ball that stops in a band that ends close to rest must not be moved back by its remaining speed. The last band starts here.
    let table = Table::default();
    for step in 0..2000 {
        let speed = 0.0273 + 1e-7 * f64::from(step);
        let (course, stop) = rolled(&table, DVec2::ZERO, DVec2::X * speed);
        let (last, end) = &course.pieces[course.pieces.len() - 2];
        assert_eq!(last.motion, Motion::Rolling);
        assert!(last.position_after(end - last.start).distance(stop) < 1e-15, "{speed}");
    }
}

#[test]
fn course_on_a_slope_is_continuous_and_ends_at_rest() {
    for name in ["match", "textbook"] {
        let table = Table { tilt: DVec2::new(-6e-4, 8e-4), ..Table::preset(name).unwrap() };
        let (velocity, spin) = (DVec2::new(0.9, 0.1), DVec3::new(20.0, -10.0, 30.0));
        let (course, _) = played(&table, DVec2::new(-1.2, -0.3), velocity, spin, None);
        let constants = Constants::of(&table);
        for pair in course.pieces.windows(2) {
            let ((one, end), (other, _)) = (&pair[0], &pair[1]);
            assert!(one.position_after(end - one.start).distance(other.position) < 1e-14);
            if one.motion == Motion::Sliding && other.motion == Motion::Rolling {
                let last = one.state_after(&constants, end - one.start);
                assert!(last.velocity.distance(other.velocity) < 1e-14);
                assert!(slip(table.radius, last.velocity, last.spin).length() < 1e-14);
            }
        }
        assert!(matches!(course.events.last().unwrap().kind, EventKind::RollingStationary(0)), "{name}");
        let bends = course.pieces.iter().filter(|(piece, _)| piece.motion == Motion::Rolling);
        assert!(bends.clone().count() > 8 && bends.count() < 60);
    }
}

#[test]
fn ball_rolling_down_a_slope_collides_at_the_surface() {
    // The path of the roll bends by some centimetres: on a straight line, the ball would hit the other one elsewhere or not at all.
    let table = Table { tilt: DVec2::new(0.0, 1e-3), ..Table::preset("textbook").unwrap() };
    for aside in [0.0, 0.01, 0.03, 0.05] {
        let second = DVec2::new(0.7, aside);
        let velocity = DVec2::new(0.6, 0.0);
        let spin = rolling_spin(table.radius, velocity).extend(0.0);
        let (course, _) = played(&table, DVec2::new(-0.8, 0.0), velocity, spin, Some(second));
        let met = course.events.iter().find(|event| event.kind == EventKind::BallBall(0, 1)).unwrap();
        let (piece, end) = course.pieces.iter().find(|(_, end)| *end == met.time).unwrap();
        let gap = piece.position_after(end - piece.start).distance(second) - 2.0 * table.radius;
        assert!(gap.abs() < 1e-14, "{aside}: {gap:e}");
    }
}

/// Returns shots all over the table, as `(cue ball's position, its velocity, its spin, position of a second ball)`.
fn shots() -> impl Iterator<Item = (DVec2, DVec2, DVec3, DVec2)> {
    (0..40).map(|index| {
        let turn = DVec2::from_angle(0.7 + 2.4 * f64::from(index));
        let speed = 0.1 + 0.07 * f64::from(index);
        let spin = DVec3::new(30.0 * turn.y, 40.0 * turn.x, 60.0 * turn.x * turn.y);
        (DVec2::new(0.9, 0.4) * turn, speed * turn.perp(), spin, -DVec2::new(1.1, 0.5) * turn)
    })
}

#[test]
fn on_a_slope_no_energy_is_gained() {
    // With 1 mm/s² as filmed, and with ten times as much.
    for (name, tilt) in [("match", DVec2::new(-6e-4, 8e-4)), ("textbook", DVec2::new(6e-3, 8e-3))] {
        let table = Table { tilt, ..Table::preset(name).unwrap() };
        let constants = Constants::of(&table);
        for (from, velocity, spin, _) in shots() {
            let (course, _) = played(&table, from, velocity, spin, None);
            // Until a collision with another ball transfers energy.
            let met = course.events.iter().find(|event| matches!(event.kind, EventKind::BallBall(..)));
            let until = met.map_or(f64::INFINITY, |event| event.time);
            let pieces = course.pieces.iter().filter(|(_, end)| *end <= until);
            let energies = pieces.flat_map(|(piece, end)| {
                [0.0, end - piece.start].map(|time| {
                    let state = piece.state_after(&constants, time.min(1e9));
                    state.specific_energy(table.radius) - tilt.dot(state.position)
                })
            });
            let mut last = f64::INFINITY;
            for energy in energies {
                // At the junctions of stretches, the transverse speed is only correct to first order in the slope.
                assert!(energy < last + 1e-5, "{name}, {from}, {velocity}: {energy} after {last}");
                last = energy;
            }
        }
    }
}

#[test]
fn mirrored_shot_on_a_mirrored_slope_ends_mirrored() {
    let tilt = DVec2::new(-6e-4, 8e-4);
    let mirror = DVec2::new(1.0, -1.0);
    for name in ["match", "textbook"] {
        let mut judged = 0;
        let [table, mirrored] = [tilt, mirror * tilt].map(|tilt| Table { tilt, ..Table::preset(name).unwrap() });
        for (from, velocity, spin, second) in shots() {
            let balls = [from, second, DVec2::new(-1.2, 0.5)];
            let (course, end) = among(&table, balls, velocity, spin);
            // Spin is an axial vector.
            let turned = DVec3::new(-spin.x, spin.y, -spin.z);
            let (image, image_end) = among(&mirrored, balls.map(|ball| mirror * ball), mirror * velocity, turned);
            // Longer shots amplify rounding errors.
            if course.events.len() < 12 {
                judged += 1;
                assert_eq!(course.events.len(), image.events.len(), "{name}, {from}");
                assert!(end.distance(mirror * image_end) < 1e-9, "{name}, {from}: {end} {image_end}");
            }
        }
        assert!(judged > 10, "{judged}");
    }
}

#[test]
fn ball_rolling_along_the_lower_rail_comes_to_rest() {
    for name in ["match", "textbook", "thesis"] {
        let table = Table { tilt: DVec2::new(0.0, 2e-3), ..Table::preset(name).unwrap() };
        let reach = table.reach();
        for gap in [0.0, 1e-12, 1e-6, 1e-3] {
            for aside in [0.0, 1e-9, 1e-3, -1e-3] {
                let (course, stop) = rolled(&table, DVec2::new(-1.0, reach.y - gap), DVec2::new(0.5, aside));
                assert!(stop.y <= reach.y + 1e-12 && stop.y > reach.y - 0.02, "{name}, {gap}, {aside}: {stop}");
                assert!(course.events.len() <= 30, "{name}, {gap}, {aside}: {} events", course.events.len());
                // The rail, against which the ball leans, slows it down slightly.
                let (_, level) =
                    rolled(&Table { tilt: DVec2::ZERO, ..table.clone() }, DVec2::new(-1.0, 0.0), DVec2::X * 0.5);
                assert!((stop.x - level.x).abs() < 0.04 * (level.x + 1.0), "{name}, {gap}, {aside}: {stop} {level}");
            }
        }
    }
}

/// If two balls hit opposite cushions at the same moment, the second impact, which is as slow as the end of a chatter, must not be absorbed
/// by the resting contact of the first.
#[test]
fn contact_closing_faster_than_the_tolerance_does_not_rest() {
    let table = Table::preset("thesis").unwrap();
    let constants = Constants::of(&table);
    let rests = |closing: f64| {
        let mut balls = [DVec2::ZERO, DVec2::new(0.5, 0.0), DVec2::new(-0.5, 0.0)].map(BallState::at_rest);
        balls[0] = BallState {
            position: DVec2::new(0.0, table.reach().y),
            velocity: DVec2::new(0.4, closing),
            spin: DVec3::new(-80.0, 0.0, 0.0),
        };
        let (resting, ..) = Resting::begin(&table, &constants, 0.0, &balls, [true; 3], None, f64::INFINITY);
        resting.is_some_and(|resting| resting.members[0])
    };
    assert!(rests(0.0) && rests(constants.tolerance.opening));
    assert!(!rests(2.5e-10));
}

/// A ball that rolls exactly into the corner of a square table hits both cushions at once, independent of their numbering: mirrored at the
/// diagonal, with the opposite sidespin, the shot is the same.
#[test]
fn ball_in_a_corner_hits_both_cushions_together() {
    let table = Table { length: 1.5, width: 1.5, rail_friction: 0.2, ..Table::preset("thesis").unwrap() };
    let velocity = DVec2::splat(1.0);
    let ends = [90.0, -90.0].map(|side| {
        let balls = [DVec2::splat(0.4), DVec2::new(-0.5, 0.1), DVec2::new(0.1, -0.5)];
        let (course, end) = among(&table, balls, velocity, rolling_spin(table.radius, velocity).extend(side));
        let met: Vec<_> = course.events[..2].iter().map(|event| event.time).collect();
        assert!(matches!(course.events[1].kind, EventKind::BallRail(0, _)) && met[0] == met[1], "{:?}", course.events);
        end
    });
    assert!(ends[0].distance(ends[1].yx()) < 1e-12, "{ends:?}");
}

/// At 2 mm/s, a difference of the gaps that rounding could make is a difference of the times that is far above their rounding.
#[test]
fn slow_ball_hits_two_balls_at_once_whatever_the_computed_times() {
    for name in ["match", "textbook"] {
        let table = Table::preset(name).unwrap();
        let back = 3.0_f64.sqrt() * table.radius + 1e-5;
        let velocity = DVec2::new(2e-3, 0.0);
        for later in [0.0, 4e-15, -4e-15] {
            let balls = [DVec2::new(-back, 0.0), DVec2::new(0.0, table.radius), DVec2::new(later, -table.radius)];
            let (course, end) = among(&table, balls, velocity, rolling_spin(table.radius, velocity).extend(0.0));
            let met = |ball| course.events.iter().find(|event| event.kind == EventKind::BallBall(0, ball));
            let [one, other] = [1, 2].map(|ball| met(ball).map(|event| event.time));
            assert!(one.is_some() && one == other && end.y.abs() < 1e-14, "{name}, {later}: {end} {:?}", course.events);
        }
    }
}
