//! Hindsight (Andrychowicz et al. 2017; thesis 6.1.1): a shot that met one ball would have made the point, had the other lain
//! on the cue ball's way.

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

/// Moments of a shot that are tried.
const MOMENTS: usize = 20;

/// They are drawn from so long a time after the first meeting, s: hardly any cue ball still rolls then.
const HORIZON: f64 = 8.0;

/// Speed from which a moment is always taken, m/s. Slower ones are taken as seldom as they are slow, so that places lie evenly
/// along the way and not where the ball dawdles.
const ALWAYS: f64 = 5.0;

/// `layout` with the ball that `cue` met last or not at all moved to where the shot makes the point; each is played to be sure.
/// The places are uniform in the area that the cue ball sweeps, but that those count twice which it passes twice, and the more the
/// larger that is: about as if a great many layouts had been drawn and those kept in which this very shot succeeds. Places chosen
/// otherwise teach about layouts that do not come up.
pub fn layouts(
    table: &Table,
    reward: Reward,
    layout: &Layout,
    cue: &CueInputs,
    rng: &mut (impl Rng + ?Sized),
) -> Vec<Layout> {
    let way = CueWay::of(table, layout, cue);
    let Some((first, begin)) = way.met else { return Vec::new() };
    let mut place = || {
        let [moment, speed, across] = rng.random::<[f64; 3]>();
        let [position, velocity] = way.at(begin + HORIZON * moment)?;
        let direction = velocity.try_normalize().filter(|_| velocity.length() >= ALWAYS * speed)?;
        // A ball that lies anywhere across the way is met at the angle whose sine says how far aside.
        let side = DVec2::from_angle((2.0 * across - 1.0).asin());
        let mut moved = *layout;
        moved.balls[3 - first] = position + 2.0 * table.radius * side.rotate(direction);
        moved.validate(table).ok()?;
        (reward.within(table, &moved, cue, CONTACT_STEPS) >= 1.0).then_some(moved)
    };
    (0..MOMENTS).filter_map(|_| place()).collect()
}

/// The cue ball's way in a shot after it has met its first ball.
#[derive(Debug)]
struct CueWay {
    /// The ball that the cue ball met first, and when, s.
    met: Option<(usize, f64)>,
    /// Pieces of the way and when they end, s.
    segments: Vec<(Segment, f64)>,
    patience: StepBudget,
}

impl CueWay {
    /// Plays a shot, with at most [`CONTACT_STEPS`] steps of resting contacts.
    fn of(table: &Table, layout: &Layout, cue: &CueInputs) -> Self {
        let mut way = Self { met: None, segments: Vec::new(), patience: StepBudget(CONTACT_STEPS) };
        watch(table, layout, &strike(table, cue), &mut way);
        way
    }

    /// Where the cue ball was at `time` and how fast, m and m/s; nothing before its first meeting or after its end.
    fn at(&self, time: f64) -> Option<[DVec2; 2]> {
        let (segment, _) = self.segments.iter().find(|(segment, end)| segment.start <= time && time <= *end)?;
        Some([segment.position_after(time - segment.start), segment.velocity_after(time - segment.start)])
    }
}

impl Observer for CueWay {
    fn wants_segments(&self) -> bool {
        true
    }

    fn event(&mut self, event: Event) -> ControlFlow<()> {
        if let EventKind::BallBall(0, ball) = event.kind
            && self.met.is_none()
        {
            self.met = Some((ball, event.time));
        }
        ControlFlow::Continue(())
    }

    fn segment(&mut self, ball: usize, segment: &Segment, end: f64) {
        if ball == 0 && self.met.is_some() {
            self.segments.push((segment.clone(), end));
        }
    }

    fn contact_step(&mut self) -> ControlFlow<()> {
        self.patience.step()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::learning::thesis::carom::cue_inputs;
    use rand::SeedableRng;
    use rand_xoshiro::Xoshiro256PlusPlus;

    #[test]
    fn a_shot_makes_the_point_once_the_ball_that_it_missed_is_moved() {
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
    fn places_are_as_random_layouts_in_which_the_shot_succeeds_have_them() {
        // One shot at a ball; the third anywhere. Where the point is made, how far from the cue ball does it lie?
        let (table, mut rng) = (Table::preset("thesis").unwrap(), Xoshiro256PlusPlus::seed_from_u64(32));
        let cue = cue_inputs([0.0, 0.2]);
        let layout = |third| Layout::new([DVec2::new(-0.8, 0.0), DVec2::new(-0.3, 0.03), third]);
        let mut draw = |count: usize, found: &mut dyn FnMut(Layout)| {
            for _ in 0..count {
                let layout = layout(Layout::random(&table, &mut rng).balls[2]);
                if layout.validate(&table).is_ok() {
                    found(layout);
                }
            }
        };
        let (mut drawn, mut started) = (Vec::new(), Vec::new());
        draw(40_000, &mut |layout| {
            if Reward::R3.of(&table, &layout, &cue) >= 1.0 {
                drawn.push(layout);
            }
        });
        draw(3_000, &mut |layout| started.push(layout));
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(33);
        let moved: Vec<Layout> =
            started.iter().flat_map(|layout| layouts(&table, Reward::R3, layout, &cue, &mut rng)).collect();
        let mean = |layouts: &[Layout]| {
            layouts.iter().map(|layout| layout.balls[0].distance(layout.balls[2])).sum::<f64>() / layouts.len() as f64
        };
        assert!(drawn.len() > 200 && moved.len() > 200, "{} {}", drawn.len(), moved.len());
        // A place that the way passes twice counts twice: it is not quite the same.
        assert!((mean(&drawn) / mean(&moved) - 1.0).abs() < 0.1, "{} {}", mean(&drawn), mean(&moved));
    }
}
