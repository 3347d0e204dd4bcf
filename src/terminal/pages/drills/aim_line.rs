//! Where the line of aim leads: the straight line to the first ball or cushion, and nothing beyond it.

use glam::DVec2;

use crate::{
    coach::{Hit, RailPoint, line_of_aim},
    simulation::Rail,
    table::{BALLS, Layout, Table},
};

/// What the line meets first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AimTarget {
    /// An object ball, and how.
    Ball(Hit),
    /// A cushion, where the line goes on to its nose: the mark by which players aim.
    Cushion(RailPoint),
}

/// The line of aim.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AimLine {
    /// The cue ball's centre where it meets something, m.
    pub end: DVec2,
    /// How far it goes to there, m.
    pub way: f64,
    /// What it meets.
    pub target: AimTarget,
}

/// The line of aim in the direction `phi`, rad. A cue ball that is struck with side and a raised cue swerves off it.
pub fn aim_line(table: &Table, layout: &Layout, phi: f64) -> AimLine {
    let (start, direction) = (layout.balls[0], DVec2::from_angle(phi));
    let diameter = 2.0 * table.radius;
    let ball = (1..BALLS).filter_map(|ball| {
        let towards = layout.balls[ball] - start;
        let (along, aside) = (direction.dot(towards), direction.perp_dot(towards));
        let is_met = along > 0.0 && aside.abs() < diameter;
        is_met.then(|| (ball, (along - (diameter * diameter - aside * aside).sqrt()).max(0.0), aside))
    });
    let ball = ball.min_by(|one, other| one.1.total_cmp(&other.1));
    let room = Rail::ALL.map(|rail| {
        let approach = -direction.dot(rail.normal());
        let room = start.dot(rail.normal()) + table.reach().dot(rail.normal().abs());
        // A line along a cushion never meets it.
        if approach > 1e-12 { room.max(0.0) / approach } else { f64::INFINITY }
    });
    let room = room.into_iter().fold(f64::INFINITY, f64::min);
    if let Some((ball, way, aside)) = ball.filter(|ball| ball.1 <= room) {
        let end = start + way * direction;
        let hit = Hit { ball, place: end, fullness: 1.0 - aside.abs() / diameter, left: aside < 0.0 };
        return AimLine { end, way, target: AimTarget::Ball(hit) };
    }
    let [mark, _] = line_of_aim(table, layout, phi);
    AimLine { end: start + room * direction, way: room, target: AimTarget::Cushion(mark) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        coach::{aim, first_hit},
        physics::CueInputs,
        simulation::{EventKind, Recording},
    };
    use proptest::prelude::*;
    use rand::SeedableRng;
    use rand_xoshiro::Xoshiro256PlusPlus;

    proptest! {
        #[test]
        fn a_plain_stroke_meets_what_the_line_says(seed in any::<u64>(), degrees in -180.0..180.0_f64) {
            let table = Table::default();
            let layout = Layout::random(&table, &mut Xoshiro256PlusPlus::seed_from_u64(seed));
            // Level, in the middle: the simulated ball runs straight.
            let cue = CueInputs { a: 0.0, b: 0.0, theta: 0.0, phi: degrees.to_radians(), speed: 5.0 };
            let recording = Recording::new(&table, &layout, &cue).unwrap();
            let aim_line = aim_line(&table, &layout, cue.phi);
            let first = recording.events().iter()
                .find(|event| matches!(event.kind, EventKind::BallBall(0, _) | EventKind::BallRail(0, _)));
            let first = first.expect("5 m/s reach the other end of the table");
            prop_assert!(recording.state(0, first.time).position.distance(aim_line.end) < 1e-6);
            match (first.kind, aim_line.target) {
                (EventKind::BallBall(_, ball), AimTarget::Ball(hit)) => {
                    let real = first_hit(&table, &recording).unwrap();
                    prop_assert_eq!((ball, real.left), (hit.ball, hit.left));
                    prop_assert!((real.fullness - hit.fullness).abs() < 1e-3, "{:?} {:?}", real, hit);
                }
                // A stroke is given by the same number everywhere.
                (EventKind::BallRail(..), AimTarget::Cushion(mark)) =>
                    prop_assert_eq!(mark, aim(&table, &layout, &cue).unwrap().ahead),
                other => prop_assert!(false, "{:?}", other),
            }
        }
    }

    #[test]
    fn a_cushion_is_marked_where_the_line_meets_its_nose_not_where_the_ball_stops() {
        let table = Table::default();
        let layout = Layout::parse("2d,2d 7d,3.5d 1d,0.5d", &table).unwrap();
        let aim_line = aim_line(&table, &layout, 45_f64.to_radians());
        let AimTarget::Cushion(mark) = aim_line.target else { panic!("a ball is met") };
        // Two diamonds up are two to the right; the ball's centre stops a radius short of the cushion.
        assert!(mark.rail == Rail::Top && (mark.diamond - 4.0).abs() < 1e-9, "{mark:?}");
        assert!((aim_line.end.y - table.reach().y).abs() < 1e-9 && aim_line.end.x < -0.5 * table.radius);
    }
}
