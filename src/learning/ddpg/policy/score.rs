//! What a policy earns on held-out layouts.

use super::{Policy, Proposal};
use crate::{
    game::Reward,
    learning::evaluation::{CONTACT_STEPS, Score},
    player::Skill,
    table::{Layout, Table},
};

/// Plays one shot on every layout.
pub fn score(policy: &Policy, table: &Table, reward: Reward, layouts: &[Layout]) -> Score {
    let mut played = Vec::with_capacity(layouts.len());
    // Small batches stay in the processor's cache.
    for layouts in layouts.chunks(64) {
        for (layout, proposals) in layouts.iter().zip(policy.proposals_for(table, layouts, &Skill::PERFECT)) {
            let first = reward.of(table, layout, &proposals[0].cue);
            let made = |earned: f64| earned >= 1.0;
            // On the `thesis` table a few proposals would take all the time, and next to none of those earn anything.
            let value = |proposal: &Proposal| reward.within(table, layout, &proposal.cue, CONTACT_STEPS);
            let rest = || proposals[1..].iter().any(|proposal| made(value(proposal)));
            played.push((first, made(first) || rest()));
        }
    }
    Score::of(&played)
}
