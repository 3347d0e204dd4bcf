//! Hindsight transition replay (Andrychowicz et al. 2017; thesis 6.1.1): a shot that made no point would have made
//! it had that ball lain on the cue ball's way. So it is put there, and the shot is remembered as a success.

use std::{f64::consts::FRAC_PI_2, ops::ControlFlow};

use glam::DVec2;
use rand::{Rng, RngExt};

use super::{
    action::Action, first_contact::playable, observation::Observation, replay::Transition, venues::Conditions,
};
use crate::{
    game::Reward,
    physics::strike,
    simulation::{Event, EventKind, Observer, Segment, StepBudget, watch},
    table::{Layout, Table},
};

/// The shot of `action` in `observation`, which missed, with the second ball moved to where it makes the point. `None` where the
/// cue ball met no ball first, or the moved ball is in the way of the others or makes no point. The new outcome is played,
/// with at most `patience` steps of resting contacts, not supposed.
pub fn relabel(
    table: &Table,
    reward: Reward,
    (layout, observation, action): (&Layout, &Observation, Action),
    patience: u32,
    rng: &mut (impl Rng + ?Sized),
) -> Option<Transition> {
    let cue = playable(table, layout, observation, action).ok()?;
    let mut way = Way { met: None, last: 0.0, segments: Vec::new(), patience: StepBudget(patience) };
    watch(table, layout, &strike(table, &cue), &mut way);
    let (first, begin) = way.met?;
    // The ball that was not met is the one to move; the observation must call it the second.
    let second = 3 - first;
    if observation.mirror * observation.second != layout.balls[second] {
        return None;
    }
    let time = begin + (way.last - begin) * rng.random::<f64>();
    let (segment, _) = way.segments.iter().find(|(segment, end)| segment.start <= time && time <= *end)?;
    let (position, velocity) =
        (segment.position_after(time - segment.start), segment.velocity_after(time - segment.start));
    let side = rng.random_range(-FRAC_PI_2..FRAC_PI_2);
    let target = position + 2.0 * table.radius * DVec2::from_angle(side).rotate(velocity.try_normalize()?);
    let mut moved = *layout;
    moved.balls[second] = target;
    moved.validate(table).ok()?;
    let observation = Observation { second: observation.mirror * target, ..*observation };
    // The moved ball may be in the cue's way.
    let is_same = playable(table, &moved, &observation, action) == Ok(cue);
    let success = is_same && reward.within(table, &moved, &cue, patience) >= 1.0;
    success.then_some(Transition { observation, conditions: Conditions::default(), action, success: 1.0 })
}

/// Keeps the cue ball's way after it has met its first ball.
struct Way {
    /// The ball that it met first, and when.
    met: Option<(usize, f64)>,
    /// When the last segment ends, s.
    last: f64,
    /// Pieces of the way and when they end, s.
    segments: Vec<(Segment, f64)>,
    patience: StepBudget,
}

impl Observer for Way {
    const SEGMENTS: bool = true;

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
            self.last = end;
        }
    }

    fn contact_step(&mut self) -> ControlFlow<()> {
        self.patience.step()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::learning::ddpg::observation::OBSERVATIONS;
    use rand::SeedableRng;
    use rand_xoshiro::Xoshiro256PlusPlus;

    #[test]
    fn a_relabelled_shot_makes_the_point_and_differs_only_in_the_second_ball() {
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(31);
        for name in crate::table::PRESETS {
            let table = Table::preset(name).unwrap();
            for reward in [Reward::R3, Reward::OneCushion] {
                let mut found = 0;
                for case in 0..200 {
                    let layout = Layout::random(&table, &mut rng);
                    let observation = Observation::new(&layout, case % OBSERVATIONS);
                    let action = std::array::from_fn(|_| rng.random_range(-1.0..1.0));
                    let Some(after) = relabel(&table, reward, (&layout, &observation, action), 20, &mut rng) else {
                        continue;
                    };
                    found += 1;
                    assert_eq!(
                        (after.observation.cue, after.observation.first, after.action),
                        (observation.cue, observation.first, action)
                    );
                    let balls = [after.observation.cue, after.observation.first, after.observation.second]
                        .map(|ball| observation.mirror * ball);
                    let moved = Layout::new(balls);
                    moved.validate(&table).unwrap();
                    let cue = playable(&table, &moved, &after.observation, action).unwrap();
                    assert_eq!(reward.of(&table, &moved, &cue), 1.0);
                }
                assert!(found > 20, "{name} {reward}: {found}");
            }
        }
    }
}
