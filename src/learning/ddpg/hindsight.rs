//! Hindsight transition replay (Andrychowicz et al. 2017; thesis 6.1.1): a shot that made no point would have made
//! it had that ball lain on the cue ball's way. So it is put there, and the shot is remembered as a success.

use std::f64::consts::FRAC_PI_2;

use glam::DVec2;
use rand::{Rng, RngExt};

use super::{
    action::Action, observation::Observation, randomized_tables::Conditions, replay::Transition, ways::playable,
};
use crate::{
    game::Reward,
    learning::{cue_way::CueWay, evaluation::CONTACT_STEPS},
    table::{Layout, Table},
};

/// The shot of `action` in `observation`, which missed, with the second ball moved to where it makes the point. `None` where the
/// cue ball met no ball first, or the moved ball is in the way of the others or makes no point. The new outcome is played,
/// not supposed.
pub fn relabel(
    table: &Table,
    reward: Reward,
    (layout, observation, action): (&Layout, &Observation, Action),
    rng: &mut (impl Rng + ?Sized),
) -> Option<Transition> {
    let cue = playable(table, layout, observation, action).ok()?;
    let way = CueWay::of(table, layout, &cue);
    let (first, begin) = way.met?;
    // The ball that was not met is the one to move; the observation must call it the second.
    let second = 3 - first;
    if observation.mirror * observation.second != layout.balls[second] {
        return None;
    }
    let time = begin + (way.last - begin) * rng.random::<f64>();
    let [position, velocity] = way.at(time)?;
    let side = rng.random_range(-FRAC_PI_2..FRAC_PI_2);
    let target = position + 2.0 * table.radius * DVec2::from_angle(side).rotate(velocity.try_normalize()?);
    let mut moved = *layout;
    moved.balls[second] = target;
    moved.validate(table).ok()?;
    let observation = Observation { second: observation.mirror * target, ..*observation };
    // The moved ball may be in the cue's way.
    let is_same = playable(table, &moved, &observation, action) == Ok(cue);
    let success = is_same && reward.within(table, &moved, &cue, CONTACT_STEPS) >= 1.0;
    success.then_some(Transition { observation, conditions: Conditions::default(), action, success: 1.0 })
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
                    let Some(after) = relabel(&table, reward, (&layout, &observation, action), &mut rng) else {
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
