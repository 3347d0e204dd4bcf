//! Hindsight relabelling (Andrychowicz et al. 2017; thesis 6.1.1): a shot that hits one object ball makes the point if the other
//! object ball is moved onto the cue ball's path.

use std::ops::ControlFlow;

use glam::DVec2;
use rand::{Rng, RngExt};

use crate::{
    game::Reward,
    learning::evaluation::CONTACT_STEPS,
    physics::{CueInputs, strike},
    simulation::{Event, EventKind, Observer, Segment, StepBudget, watch},
    table::{Layout, Table},
};

/// Number of moments drawn for one shot.
const MOMENTS: usize = 20;

/// Length of the time after the first hit from which the moments are drawn, s. Hardly any cue ball still rolls at its end.
const HORIZON: f64 = 8.0;

/// Cue-ball speed from which a drawn moment is always accepted, m/s. Below it the probability is proportional to the speed, so that
/// the positions are uniform along the path and not concentrated where the ball is slow.
const FULL_ACCEPTANCE_SPEED: f64 = 5.0;

/// Returns copies of `layout` in which the object ball that `cue` hits last or not at all is moved to where the shot makes the point.
/// A simulation verifies each of them.
///
/// The positions are uniform in the area that the cue ball sweeps, except that an area swept twice counts twice, and their number
/// grows with the area. This resembles drawing very many layouts and keeping those in which this shot succeeds. Positions with
/// another distribution would train the agent on layouts that do not occur.
pub fn layouts(
    table: &Table,
    reward: Reward,
    layout: &Layout,
    cue: &CueInputs,
    rng: &mut (impl Rng + ?Sized),
) -> Vec<Layout> {
    let mut path = CuePath { first_hit: None, segments: Vec::new(), contact_steps: StepBudget(CONTACT_STEPS) };
    watch(table, layout, &strike(table, cue), &mut path);
    let Some((first, begin)) = path.first_hit else { return Vec::new() };
    let mut draw = || {
        let [moment, speed, across] = rng.random::<[f64; 3]>();
        let [position, velocity] = path.at(begin + HORIZON * moment)?;
        let direction = velocity.try_normalize().filter(|_| velocity.length() >= FULL_ACCEPTANCE_SPEED * speed)?;
        // The ball's lateral offset from the path is uniform; in units of two radii it is the sine of the impact angle.
        let side = DVec2::from_angle((2.0 * across - 1.0).asin());
        let mut moved = *layout;
        moved.balls[3 - first] = position + 2.0 * table.radius * side.rotate(direction);
        moved.validate(table).ok()?;
        (reward.of_playable(table, &moved, cue, CONTACT_STEPS) >= 1.0).then_some(moved)
    };
    (0..MOMENTS).filter_map(|_| draw()).collect()
}

/// The cue ball's path in a shot after its first hit of an object ball.
#[derive(Debug)]
struct CuePath {
    /// The object ball that the cue ball hits first, and the time, s.
    first_hit: Option<(usize, f64)>,
    /// Segments of the path with their end times, s.
    segments: Vec<(Segment, f64)>,
    contact_steps: StepBudget,
}

impl CuePath {
    /// Returns the cue ball's position (m) and velocity (m/s) at `time`; `None` before the first hit and after the path's end.
    fn at(&self, time: f64) -> Option<[DVec2; 2]> {
        let (segment, _) = self.segments.iter().find(|(segment, end)| segment.start <= time && time <= *end)?;
        Some([segment.position_after(time - segment.start), segment.velocity_after(time - segment.start)])
    }
}

impl Observer for CuePath {
    fn wants_segments(&self) -> bool {
        true
    }

    fn event(&mut self, event: Event) -> ControlFlow<()> {
        if let EventKind::BallBall(0, ball) = event.kind
            && self.first_hit.is_none()
        {
            self.first_hit = Some((ball, event.time));
        }
        ControlFlow::Continue(())
    }

    fn segment(&mut self, ball: usize, segment: &Segment, end: f64) {
        if ball == 0 && self.first_hit.is_some() {
            self.segments.push((segment.clone(), end));
        }
    }

    fn contact_step(&mut self) -> ControlFlow<()> {
        self.contact_steps.step()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::learning::thesis::carom::cue_inputs;
    use rand::SeedableRng;
    use rand_xoshiro::Xoshiro256PlusPlus;

    #[test]
    fn moving_the_missed_ball_makes_the_point() {
        let (table, mut rng) = (Table::preset("thesis").unwrap(), Xoshiro256PlusPlus::seed_from_u64(31));
        let mut found = 0;
        for _ in 0..300 {
            let layout = Layout::random(&table, &mut rng);
            let cue = cue_inputs([rng.random_range(-1.0..1.0), rng.random_range(-1.0..1.0)]);
            for moved in layouts(&table, Reward::R3, &layout, &cue, &mut rng) {
                found += 1;
                assert_eq!(Reward::R3.of(&table, &moved, &cue), 1.0);
                let same = (0..3).filter(|ball| moved.balls[*ball] == layout.balls[*ball]).count();
                assert!(same == 2 && moved.balls[0] == layout.balls[0], "{moved:?}");
            }
        }
        assert!(found > 15, "{found}");
    }

    #[test]
    fn positions_are_distributed_like_successful_random_layouts() {
        // One fixed shot at a ball, and the third ball anywhere. The test compares its distance from the cue ball when the point is made.
        let (table, mut rng) = (Table::preset("thesis").unwrap(), Xoshiro256PlusPlus::seed_from_u64(32));
        let cue = cue_inputs([0.0, 0.2]);
        let layout = |third| Layout::new([DVec2::new(-0.8, 0.0), DVec2::new(-0.3, 0.03), third]);
        let mut draw = |count: usize| -> Vec<Layout> {
            let drawn = (0..count).map(|_| layout(Layout::random(&table, &mut rng).balls[2]));
            drawn.filter(|layout| layout.validate(&table).is_ok()).collect()
        };
        let (mut drawn, started) = (draw(40_000), draw(3_000));
        drawn.retain(|layout| Reward::R3.of(&table, layout, &cue) >= 1.0);
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(33);
        let moved: Vec<Layout> =
            started.iter().flat_map(|layout| layouts(&table, Reward::R3, layout, &cue, &mut rng)).collect();
        let mean = |layouts: &[Layout]| {
            layouts.iter().map(|layout| layout.balls[0].distance(layout.balls[2])).sum::<f64>() / layouts.len() as f64
        };
        assert!(drawn.len() > 200 && moved.len() > 200, "{} {}", drawn.len(), moved.len());
        // The means differ a little, because a position that the path passes twice counts twice.
        assert!((mean(&drawn) / mean(&moved) - 1.0).abs() < 0.1, "{} {}", mean(&drawn), mean(&moved));
    }
}
