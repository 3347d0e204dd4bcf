//! Learning from demonstrations (Vecerik et al. 2017; thesis 6.1.2): the expert is a search that tries shots on the
//! simulator until one makes the point.

use rand::{Rng, RngExt};

use super::{
    action::{ACTIONS, Action, ActionSpace},
    observation::{OBSERVATIONS, Observation},
    randomized_tables::Conditions,
    replay::Transition,
    ways::playable,
};
use crate::{
    game::Reward,
    learning::evaluation::CONTACT_STEPS,
    table::{Layout, Table},
};

/// Shots that the expert tries on a layout before it gives up.
const TRIES: usize = 200;

/// A shot that makes the point on `layout`, found by trying shots at random; `None` where none is found.
pub fn demonstrate(
    table: &Table,
    reward: Reward,
    space: ActionSpace,
    layout: &Layout,
    rng: &mut (impl Rng + ?Sized),
) -> Option<Transition> {
    (0..TRIES).find_map(|_| {
        let observation = Observation::new(layout, rng.random_range(0..OBSERVATIONS));
        let mut action: Action = [0.0; ACTIONS];
        action[..space.actions()].fill_with(|| rng.random_range(-1.0..=1.0));
        let cue = playable(table, layout, &observation, action).ok()?;
        let earned = reward.within(table, layout, &cue, CONTACT_STEPS);
        (earned >= 1.0).then_some(Transition { observation, conditions: Conditions::default(), action, success: 1.0 })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_xoshiro::Xoshiro256PlusPlus;

    #[test]
    fn the_expert_shows_shots_that_make_the_point() {
        let (table, mut rng) = (Table::default(), Xoshiro256PlusPlus::seed_from_u64(32));
        let mut shown = 0;
        for _ in 0..30 {
            let layout = Layout::random(&table, &mut rng);
            let Some(shot) = demonstrate(&table, Reward::R3, ActionSpace::PhiV, &layout, &mut rng) else {
                continue;
            };
            shown += 1;
            let cue = playable(&table, &layout, &shot.observation, shot.action).unwrap();
            assert_eq!(Reward::R3.of(&table, &layout, &cue), 1.0);
        }
        assert!(shown > 20, "{shown}");
    }
}
