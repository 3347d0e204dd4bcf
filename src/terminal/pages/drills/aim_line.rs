//! The aim line of a stroke: the cue ball's path up to its first contact with a ball or cushion.

use glam::DVec2;

use crate::{
    coach::{RailPoint, first_hit},
    physics::CueInputs,
    simulation::{EventKind, Recording},
    table::{Layout, Table},
    terminal::shot::FirstImpact,
};

/// Time between two points of the path, s: at 6 m/s a ball moves 12 mm in that time.
const STEP: f64 = 0.002;

/// The cue ball's path to its first contact.
#[derive(Clone, Debug, PartialEq)]
pub struct AimLine {
    /// Positions of its centre, m, from the start to the first contact or to rest.
    pub points: Vec<DVec2>,
    /// The first contact. If it is a cushion, the ball after it is not included.
    pub meeting: FirstImpact,
    /// The contact point on the cushion; `None` if the first contact is not a cushion.
    pub cushion: Option<RailPoint>,
}

impl AimLine {
    /// Computes the line of the stroke `cue`, including the effects of side and of a raised cue; `None` if the stroke cannot be
    /// simulated.
    pub fn of(table: &Table, layout: &Layout, cue: &CueInputs) -> Option<Self> {
        let recording = Recording::new(table, layout, cue).ok()?;
        let meeting = match FirstImpact::of(&recording, first_hit(table, &recording)) {
            FirstImpact::Rail(rail, _) => FirstImpact::Rail(rail, None),
            meeting => meeting,
        };
        let is_first =
            |kind| matches!(kind, EventKind::BallBall(0, _) | EventKind::BallRail(0, _) | EventKind::LeavesTable(0));
        let first = recording.events().iter().find(|event| is_first(event.kind));
        let end = first.map_or(recording.duration(), |event| event.time);
        let place = |time: f64| recording.state(0, time).position;
        let steps = (end / STEP).ceil() as u32;
        let times = (0..steps).map(|step| STEP * f64::from(step)).chain([end]);
        let cushion = match meeting {
            FirstImpact::Rail(rail, _) => Some(RailPoint::on(table, rail, place(end))),
            _ => None,
        };
        Some(Self { points: times.map(place).collect(), meeting, cushion })
    }

    /// Length of the path, m.
    pub fn length(&self) -> f64 {
        self.points.windows(2).map(|pair| pair[0].distance(pair[1])).sum()
    }

    /// Points on the path with a distance of `spacing` m, except on its last `free` m.
    pub fn dots(&self, spacing: f64, free: f64) -> Vec<DVec2> {
        let (mut dots, mut way, end) = (Vec::new(), 0.0, self.length() - free);
        for pair in self.points.windows(2) {
            let (before, step) = (way, pair[0].distance(pair[1]));
            way += step;
            let next = spacing * (dots.len() + 1) as f64;
            if next <= way.min(end) {
                dots.push(pair[0].lerp(pair[1], (next - before) / step));
            }
        }
        dots
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{simulation::Rail, terminal::Shot};
    use proptest::prelude::*;
    use rand::SeedableRng;
    use rand_xoshiro::Xoshiro256PlusPlus;

    proptest! {
        #[test]
        fn first_contact_matches_the_coachs_description(
            seed in any::<u64>(), degrees in -180.0..180.0_f64, side in -0.4..0.4_f64, raised in 0.0..30.0_f64,
        ) {
            let table = Table::default();
            let layout = Layout::random(&table, &mut Xoshiro256PlusPlus::seed_from_u64(seed));
            let (theta, phi) = (raised.to_radians(), degrees.to_radians());
            let cue = CueInputs { a: side, b: 0.1, theta, phi, speed: 3.0 };
            let line = AimLine::of(&table, &layout, &cue).unwrap();
            let shot = Shot::new(&table, &layout, cue, false, "yours").unwrap();
            match (line.meeting, shot.first_impact()) {
                (FirstImpact::Rail(one, None), FirstImpact::Rail(other, _)) => {
                    let cushion = shot.words.before.first().or(shot.words.between.first()).unwrap();
                    let mark = line.cushion.unwrap();
                    prop_assert_eq!((one, mark.rail), (other, cushion.rail));
                    prop_assert!((mark.diamond - cushion.diamond).abs() < 0.01, "{:?} {:?}", mark, cushion);
                }
                (one, other) => prop_assert_eq!(one, other),
            }
        }
    }

    #[test]
    fn side_changes_how_full_a_ball_is_hit() {
        let table = Table::default();
        let layout = Layout::parse("-0.7,0 0.5,-0.03 0.9,0.5", &table).unwrap();
        let fullness = |a: f64| {
            let cue = CueInputs { a, b: 0.0, theta: 0.0, phi: 0.0, speed: 3.0 };
            match AimLine::of(&table, &layout, &cue).unwrap().meeting {
                FirstImpact::Ball(hit) if hit.ball == 1 && hit.left => hit.fullness,
                met => panic!("{met:?}"),
            }
        };
        // The ball lies to the right of the line. Left side pushes the cue ball to the right, towards it.
        assert!(fullness(0.2) > fullness(0.0) + 0.02 && fullness(0.0) > fullness(-0.2) + 0.02);
    }

    #[test]
    fn aim_line_ends_at_first_contact_and_dots_before_it() {
        let table = Table::default();
        let layout = Layout::parse("2d,2d 7d,3.5d 1d,0.5d", &table).unwrap();
        let cue = CueInputs { a: 0.0, b: 0.0, theta: 0.0, phi: 90_f64.to_radians(), speed: 3.0 };
        let line = AimLine::of(&table, &layout, &cue).unwrap();
        let mark = line.cushion.unwrap();
        assert!(mark.rail == Rail::Top && (mark.diamond - 2.0).abs() < 1e-6, "{mark:?}");
        let way = table.reach().y - layout.balls[0].y;
        assert!((line.length() - way).abs() < 1e-6, "{}", line.length());
        let dots = line.dots(0.04, 0.05);
        assert_eq!(dots.len(), ((way - 0.05) / 0.04) as usize);
        assert!(dots.windows(2).all(|pair| (pair[0].distance(pair[1]) - 0.04).abs() < 1e-6));
        let soft = AimLine::of(&table, &layout, &CueInputs { speed: 0.1, ..cue }).unwrap();
        assert!(soft.meeting == FirstImpact::Nothing && soft.cushion.is_none() && soft.length() > 0.01);
    }
}
