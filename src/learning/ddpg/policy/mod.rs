//! A trained agent as a policy: it proposes shots for a layout by one pass through its networks, without the simulator.

pub mod calibration;
pub mod file;
pub(crate) mod library;

use std::sync::Arc;

use self::file::Origin;
pub(in crate::learning) use self::file::bundled_bytes;
pub use self::file::bundled_names;
use crate::{
    game::Reward,
    learning::{
        ddpg::{
            context::is_known_table,
            networks::Networks,
            observation::Observation,
            observation_batch::ContextualObservation,
            paths::{cue_inputs, playable},
        },
        evaluation::{CONTACT_STEPS, Score},
    },
    physics::CueInputs,
    platform::parallel::Team,
    player::Skill,
    table::{Layout, Table},
};

/// Largest number of proposals for a layout; only the best are kept. Nine heads make as many for the straight paths to a ball.
const MAX_PROPOSALS: usize = 36;

/// A shot that a policy proposes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Proposal {
    /// The stroke.
    pub cue: CueInputs,
    /// The critic's probability of success, 0 to 1.
    pub success: f64,
}

/// Trained networks that propose shots. Cheap to clone and to share between threads.
#[derive(Clone, Debug)]
pub struct Policy {
    pub(in crate::learning) networks: Networks,
    pub(in crate::learning) origin: Origin,
}

impl Policy {
    /// Origin of this policy.
    pub const fn origin(&self) -> &Origin {
        &self.origin
    }

    /// Whether the table's constants and the player's errors are inputs, so that probabilities are those of this player on this table.
    pub const fn has_context(&self) -> bool {
        self.origin.hyperparameters.context
    }

    /// Whether its probabilities are valid for a player with this skill: the skill is an input, and training included such players.
    pub fn is_valid_for(&self, skill: &Skill) -> bool {
        self.has_context() && (self.origin.hyperparameters.perfect < 1.0 || skill.scale() == 0.0)
    }

    /// Whether it was trained on tables like this one.
    pub fn is_trained_for(&self, table: &Table) -> bool {
        self.origin.table == table.name || (self.has_context() && is_known_table(table))
    }

    /// Returns the stroke with the highest probability of success for a player of this skill. Only a policy with a context uses the skill.
    pub fn propose(&self, table: &Table, layout: &Layout, skill: &Skill) -> CueInputs {
        self.proposals(table, layout, skill)[0].cue
    }

    /// Returns the proposals for a layout, at least one, the most probable first. These are every head's strokes for either object ball on
    /// either side; for policies with paths by a cushion, the most probable of those and of the strokes by a cushion. The cue is raised as
    /// far as rails and balls require. Strokes without room at any elevation have a probability of 0 and come last.
    ///
    /// # Panics
    /// Never: the networks' sizes are checked at loading, and candle has no other reason to fail.
    pub fn proposals(&self, table: &Table, layout: &Layout, skill: &Skill) -> Vec<Proposal> {
        self.proposals_by(&Team::ALONE, table, layout, skill)
    }

    /// As [`Policy::proposals`], computed by several threads.
    pub(crate) fn proposals_by(&self, team: &Team, table: &Table, layout: &Layout, skill: &Skill) -> Vec<Proposal> {
        let (shared, inputs, errors) = (Arc::new(table.clone()), self.origin.hyperparameters.inputs(), skill.scale());
        let observations = Observation::all(table, layout, inputs.rails_first);
        let parts: Vec<&[Observation]> = observations.chunks(observations.len().div_ceil(team.size())).collect();
        let proposals = team.map(&parts, |part| {
            let contextual = |observation: &Observation| ContextualObservation {
                observation: *observation,
                table: Arc::clone(&shared),
                errors,
            };
            let proposals = self.networks.proposals(inputs, part.iter().map(contextual).collect());
            proposals.expect("the sizes of the networks were checked when they were loaded")
        });
        let success = |logit: f32| {
            let success = self.origin.calibration.probability(f64::from(logit), errors);
            // NaN must neither win nor disturb the order.
            if success.is_nan() { 0.0 } else { success }
        };
        let rated = proposals.into_iter().flatten();
        let mut rated: Vec<_> =
            rated.map(|(observation, action, logit)| (observation, action, success(logit))).collect();
        rated.sort_by(|(.., a), (.., b)| b.total_cmp(a));
        rated.truncate(MAX_PROPOSALS);
        let mut strokes =
            team.map(&rated, |(observation, action, success)| match playable(table, layout, observation, *action) {
                Ok(cue) => Proposal { cue, success: *success },
                Err(_) => Proposal { cue: cue_inputs(table, observation, *action), success: 0.0 },
            });
        strokes.sort_by(|a, b| b.success.total_cmp(&a.success));
        strokes
    }

    /// Plays one shot on every layout and returns the score.
    pub(in crate::learning) fn score(&self, table: &Table, reward: Reward, layouts: &[Layout]) -> Score {
        let play = |layout| {
            let proposals = self.proposals(table, layout, &Skill::PERFECT);
            let first = reward.of_playable(table, layout, &proposals[0].cue, u32::MAX);
            (first, any_scores(table, reward, layout, first, &proposals[1..]))
        };
        Score::of(&layouts.iter().map(play).collect::<Vec<_>>())
    }
}

/// Whether any proposal earns a reward of 1 or more: the first, whose reward is `first`, or one of the `others`.
pub fn any_scores(table: &Table, reward: Reward, layout: &Layout, first: f64, others: &[Proposal]) -> bool {
    // With a limit on contact steps: on the `thesis` table a few proposals would take all the time, and hardly any of them earns anything.
    first >= 1.0 || others.iter().any(|proposal| reward.of_playable(table, layout, &proposal.cue, CONTACT_STEPS) >= 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        game::Rule,
        learning::evaluation::{HELD_OUT_SEED, held_out_layouts},
        physics::has_room,
        simulation::{EventKind, Recording},
    };
    use glam::DVec2;
    use rand::SeedableRng;
    use rand_xoshiro::Xoshiro256PlusPlus;

    pub fn bundled() -> Policy {
        Policy::bundled(&Table::default(), Rule::StraightRail).unwrap().unwrap()
    }

    #[test]
    fn proposals_are_valid_strokes_sorted_by_probability() {
        let table = Table::default();
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(11);
        let layouts: Vec<_> = (0..20).map(|_| Layout::random(&table, &mut rng)).collect();
        let policy = bundled();
        for layout in &layouts {
            let proposals = policy.proposals(&table, layout, &Skill::PERFECT);
            for threads in [3, 64] {
                let together = policy.proposals_by(&Team::of(threads), &table, layout, &Skill::PERFECT);
                assert_eq!(proposals, together, "the proposals do not depend on the number of threads");
            }
            assert_eq!(proposals[0].cue, policy.propose(&table, layout, &Skill::PERFECT));
            assert!(proposals.is_sorted_by(|a, b| a.success >= b.success));
            for proposal in proposals {
                proposal.cue.validate().unwrap();
            }
        }
    }

    #[test]
    fn proposals_without_cue_room_count_as_missed() {
        let (table, reward) = (Table::default(), Reward::ThreeCushion);
        let policy = Policy::bundled(&table, Rule::ThreeCushion).unwrap().unwrap();
        // On this held-out layout only a stroke without room would make the point.
        let layouts = &held_out_layouts(&table, 583, HELD_OUT_SEED)[582..];
        let proposals = policy.proposals(&table, &layouts[0], &Skill::PERFECT);
        let made = proposals.iter().filter(|proposal| reward.of(&table, &layouts[0], &proposal.cue) >= 1.0);
        let has_room: Vec<bool> = made.map(|proposal| has_room(&table, &layouts[0], &proposal.cue)).collect();
        assert!(has_room.contains(&false) && !has_room.contains(&true), "a new policy needs another test layout");
        assert_eq!(policy.score(&table, reward, layouts).best_of_k, 0.0);
    }

    #[test]
    fn a_policy_recognises_its_training_table() {
        let (table, thesis) = (Table::default(), Table::preset("thesis").unwrap());
        let mut policy = Policy::bundled_for(&table, Rule::ThreeCushion, true).unwrap().unwrap();
        assert!(policy.has_context() && policy.is_trained_for(&table) && !policy.is_trained_for(&thesis));
        policy.origin.table = "thesis".to_owned();
        assert!(policy.is_trained_for(&thesis));
    }

    #[test]
    fn invalid_layouts_still_give_strokes() {
        let policy = bundled();
        let table = Table::default();
        for layout in [[DVec2::NAN; 3], [DVec2::ZERO; 3], [DVec2::INFINITY; 3]] {
            let proposals = policy.proposals(&table, &Layout::new(layout), &Skill::PERFECT);
            assert!(proposals.iter().all(|proposal| proposal.success >= 0.0));
        }
    }

    #[test]
    fn some_strokes_for_players_with_errors_hit_a_cushion_first() {
        let table = Table::default();
        let policy = Policy::bundled_for(&table, Rule::ThreeCushion, true).unwrap().unwrap();
        let meets_rail_first = |layout: &Layout, cue: &CueInputs| {
            let recording = Recording::new(&table, layout, cue).unwrap();
            let mut met = recording.events().iter().map(|event| event.kind);
            matches!(met.find(|kind| !matches!(kind, EventKind::SlidingRolling(_))), Some(EventKind::BallRail(0, _)))
        };
        let proposed = held_out_layouts(&table, 40, 9).into_iter().map(|layout| {
            let proposals = policy.proposals(&table, &layout, &Skill::CLUB);
            proposals.iter().filter(|proposal| meets_rail_first(&layout, &proposal.cue)).count()
        });
        let proposed: Vec<usize> = proposed.collect();
        let (layouts, strokes) = (proposed.iter().filter(|count| **count > 0).count(), proposed.iter().sum::<usize>());
        assert!(layouts >= 10 && strokes >= 40, "{strokes} strokes on {layouts} of 40 layouts");
    }
}
