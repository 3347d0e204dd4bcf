//! Where the line of aim leads: the straight line to the first ball or cushion, and nothing beyond it.

use glam::DVec2;

use crate::{
    coach::Hit,
    simulation::Rail,
    table::{BALLS, Layout, Table},
};

/// What the line meets first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Meets {
    /// An object ball, and how.
    Ball(Hit),
    /// A cushion, at so many diamonds: 0 to 8 from the left on a long one, 0 to 4 from below on a short one.
    Cushion(Rail, f64),
}

/// The line of aim.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sight {
    /// The cue ball's centre where it meets something, m.
    pub end: DVec2,
    /// How far it goes to there, m.
    pub way: f64,
    /// What it meets.
    pub meets: Meets,
}

/// The line of aim in the direction `phi`, rad. A cue ball that is struck with side and a raised cue swerves off it.
pub fn sight(table: &Table, layout: &Layout, phi: f64) -> Sight {
    let (start, direction) = (layout.balls[0], DVec2::from_angle(phi));
    let diameter = 2.0 * table.radius;
    let ball = (1..BALLS).filter_map(|ball| {
        let towards = layout.balls[ball] - start;
        let (along, aside) = (direction.dot(towards), direction.perp_dot(towards));
        let is_met = along > 0.0 && aside.abs() < diameter;
        is_met.then(|| (ball, (along - (diameter * diameter - aside * aside).sqrt()).max(0.0), aside))
    });
    let ball = ball.min_by(|one, other| one.1.total_cmp(&other.1));
    let cushion = Rail::ALL.map(|rail| {
        let approach = -direction.dot(rail.normal());
        let room = start.dot(rail.normal()) + table.reach().dot(rail.normal().abs());
        // A line along a cushion never meets it.
        (rail, if approach > 1e-12 { room.max(0.0) / approach } else { f64::INFINITY })
    });
    let (rail, room) = cushion.into_iter().fold((Rail::Left, f64::INFINITY), |a, b| if b.1 < a.1 { b } else { a });
    if let Some((ball, way, aside)) = ball.filter(|ball| ball.1 <= room) {
        let end = start + way * direction;
        let hit = Hit { ball, place: end, fullness: 1.0 - aside.abs() / diameter, left: aside < 0.0 };
        return Sight { end, way, meets: Meets::Ball(hit) };
    }
    let end = start + room * direction;
    let along = match rail {
        Rail::Left | Rail::Right => end.y + 0.5 * table.width,
        Rail::Bottom | Rail::Top => end.x + 0.5 * table.length,
    };
    Sight { end, way: room, meets: Meets::Cushion(rail, along / table.diamond()) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{coach::first_hit, physics::CueInputs, simulation::Recording};
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
            let sight = sight(&table, &layout, cue.phi);
            let first = recording.events().iter().find(|event| matches!(event.kind,
                crate::simulation::EventKind::BallBall(0, _) | crate::simulation::EventKind::BallRail(0, _)));
            let first = first.expect("5 m/s reach the other end of the table");
            prop_assert!(recording.state(0, first.time).position.distance(sight.end) < 1e-6);
            match (first.kind, sight.meets) {
                (crate::simulation::EventKind::BallBall(_, ball), Meets::Ball(hit)) => {
                    let real = first_hit(&table, &recording).unwrap();
                    prop_assert_eq!((ball, real.left), (hit.ball, hit.left));
                    prop_assert!((real.fullness - hit.fullness).abs() < 1e-3, "{:?} {:?}", real, hit);
                }
                (crate::simulation::EventKind::BallRail(_, rail), Meets::Cushion(met, _)) => prop_assert_eq!(rail, met),
                other => prop_assert!(false, "{:?}", other),
            }
        }
    }

    #[test]
    fn cushions_are_counted_in_diamonds_from_the_lower_left_corner() {
        let table = Table::default();
        let layout = Layout::parse("2d,2d 7d,3.5d 1d,0.5d", &table).unwrap();
        let Meets::Cushion(rail, diamond) = sight(&table, &layout, 0.0).meets else { panic!("a ball is met") };
        assert_eq!((rail, diamond), (Rail::Right, 2.0));
    }
}
