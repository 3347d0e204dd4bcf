//! The expert of expert iteration (Anthony et al. 2017): a search with the simulator for strokes that the player makes more often than
//! the networks' proposals. It screens proposals and random strokes with the critic, then compares the best by simulated attempts.

use candle_core::Result;
use rand::{Rng, RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

use super::{
    action::{ACTIONS, Action, action_for_offset, action_for_speed},
    agent::Transition,
    context::Inputs,
    networks::Networks,
    observation::Observation,
    observation_batch::{ObservationBatch, action_rows},
    randomized_tables::{Context, RandomizedTables},
};
use crate::{game::Reward, statistics::normal_pair, table::Layout};

/// Random strokes that the expert tries in addition to the networks' proposals, once each and without errors.
const RANDOM_STROKES: usize = 2048;

/// Strokes that enter successive halving, in total and per observation: the critic's favourites among those that make the point without
/// errors.
const SCREENED: usize = 64;
const SCREENED_PER_OBSERVATION: usize = 12;

/// Rounds of successive halving: total attempts at each stroke by the end of the round, and strokes that remain after it. Then the
/// number of remaining strokes per observation.
const ROUNDS: [(usize, usize); 3] = [(16, 24), (32, 8), (64, 6)];
const LEFT_PER_OBSERVATION: usize = 2;

/// New attempts that measure the stored success of strokes that did not win.
const ATTEMPTS_FOR_OTHERS: usize = 8;

/// Neighbours drawn around each remaining stroke, neighbours that enter successive halving, and the standard deviations of the steps to
/// them, in units of half an action's range. The critic only selects the neighbours that enter. Attempts decide, so its errors cost time,
/// not correctness.
const NEIGHBOURS: usize = 24;
const SCREENED_NEIGHBOURS: usize = 24;
const STEPS: [f32; 3] = [0.12, 0.06, 0.03];

/// Share of the winner's mean reward that the best stroke of another observation must earn to be imitated, too.
const WORTH_IMITATING: f64 = 0.5;

/// Mean and standard deviation of the offset in diameters and of the logarithm of the speed in m/s, as in the strokes that players
/// make most often.
const OFFSET: [f64; 2] = [0.55, 0.3];
const LOG_SPEED: [f64; 2] = [0.85, 0.5];

/// Lowest tip position, as a number of the action: hardly any of those strokes is lower.
const LOWEST_TIP: f32 = -0.3;

/// A search on one layout in a given context.
#[derive(Clone, Copy, Debug)]
pub struct Expert<'a> {
    pub tables: &'a RandomizedTables,
    pub reward: Reward,
    pub inputs: Inputs,
    /// Networks whose critic screens the strokes before any attempt.
    pub networks: &'a Networks,
    pub layout: &'a Layout,
    pub context: Context,
}

/// A stroke in successive halving.
#[derive(Clone, Copy, Debug)]
struct Candidate {
    observation: Observation,
    action: Action,
    earned: f64,
    attempts: usize,
}

impl Candidate {
    const fn new(observation: Observation, action: Action) -> Self {
        Self { observation, action, earned: 0.0, attempts: 0 }
    }

    fn mean(&self) -> f64 {
        self.earned / self.attempts.max(1) as f64
    }
}

/// Result of a search.
#[derive(Clone, Debug, Default)]
pub struct SearchResult {
    /// The winner, and the best strokes of other observations that come near to it; the best one first.
    pub best: Vec<Transition>,
    /// Other strokes that reached successive halving.
    pub others: Vec<Transition>,
}

/// Keeps the first `left` of sorted candidates, but at most `per_observation` of one observation; returns the others. So successive
/// halving does not end with nearly equal strokes, and the heads imitate strokes of several observations.
fn truncate_diverse(candidates: &mut Vec<Candidate>, left: usize, per_observation: usize) -> Vec<Candidate> {
    let (mut kept, mut removed) = (Vec::<Candidate>::with_capacity(left), Vec::new());
    for candidate in candidates.drain(..) {
        let alike = kept.iter().filter(|other| other.observation == candidate.observation).count();
        let list = if kept.len() < left && alike < per_observation { &mut kept } else { &mut removed };
        list.push(candidate);
    }
    *candidates = kept;
    removed
}

impl Expert<'_> {
    /// Runs the search, starting with `proposals`, and returns the strokes that reached successive halving. The success of each comes from
    /// new attempts, because the winner's attempts in successive halving were lucky. Empty if no stroke earned anything.
    pub fn search(&self, proposals: &[(Observation, Action)], rng: &mut (impl Rng + ?Sized)) -> Result<SearchResult> {
        let seed = rng.random();
        let tried = (0..RANDOM_STROKES).map(|_| {
            let table = self.tables.table(self.context);
            (Observation::random(table, self.layout, self.inputs.rails_first, rng), self.random_stroke(rng))
        });
        let all: Vec<_> = proposals.iter().copied().chain(tried).collect();
        // Keeps the strokes that make the point without errors.
        let without_errors = Context { errors: 0.0, ..self.context };
        let mut candidates: Vec<Candidate> =
            all.into_iter().map(|(observation, action)| Candidate::new(observation, action)).collect();
        candidates.retain(|Candidate { observation, action, .. }| {
            self.tables.attempt(self.reward, self.layout, (observation, *action), without_errors, rng) >= 1.0
        });
        self.sort_by_critic(&mut candidates)?;
        truncate_diverse(&mut candidates, SCREENED, SCREENED_PER_OBSERVATION);
        let mut removed = Vec::new();
        for (attempts, left) in ROUNDS {
            self.halving_round(&mut candidates, attempts, seed);
            removed.extend(truncate_diverse(&mut candidates, left, LEFT_PER_OBSERVATION));
        }
        for step in STEPS {
            let parents = candidates.clone();
            let mut children: Vec<Candidate> = parents
                .iter()
                .flat_map(|parent| [parent; NEIGHBOURS])
                .map(|parent| Candidate::new(parent.observation, self.neighbour(parent.action, step, rng)))
                .collect();
            self.sort_by_critic(&mut children)?;
            children.truncate(SCREENED_NEIGHBOURS);
            self.halving_round(&mut children, ROUNDS[1].0, seed);
            // Neighbours that the critic overrated are stored too, so that it learns from them.
            removed.extend(children.split_off(ROUNDS[1].1.min(children.len())));
            candidates.extend(children);
            self.halving_round(&mut candidates, ROUNDS[2].0, seed);
            removed.extend(truncate_diverse(&mut candidates, ROUNDS[2].1, LEFT_PER_OBSERVATION));
        }
        let again = |candidate: &Candidate, attempts| {
            let mut again = [Candidate::new(candidate.observation, candidate.action)];
            self.halving_round(&mut again, attempts, !seed);
            let success = (again[0].mean() / self.reward.max_value()) as f32;
            Transition { observation: candidate.observation, context: self.context, action: candidate.action, success }
        };
        let Some(winner) = candidates.first().copied().filter(|winner| winner.earned > 0.0) else {
            return Ok(SearchResult::default());
        };
        let (mut best, mut others) = (Vec::<Candidate>::new(), removed);
        for candidate in candidates {
            let is_new_observation = best.iter().all(|better| better.observation != candidate.observation);
            let is_imitated = is_new_observation && candidate.mean() >= WORTH_IMITATING * winner.mean();
            let strokes = if is_imitated { &mut best } else { &mut others };
            strokes.push(candidate);
        }
        let [best, others] = [(best, ROUNDS[2].0), (others, ATTEMPTS_FOR_OTHERS)]
            .map(|(strokes, attempts)| strokes.iter().map(|stroke| again(stroke, attempts)).collect());
        Ok(SearchResult { best, others })
    }

    /// Sorts candidates by the critic's prediction, the best first.
    fn sort_by_critic(&self, candidates: &mut Vec<Candidate>) -> Result<()> {
        if candidates.is_empty() {
            return Ok(());
        }
        let observations =
            candidates.iter().map(|candidate| self.tables.contextual(candidate.observation, self.context)).collect();
        let actions: Vec<Action> = candidates.iter().map(|candidate| candidate.action).collect();
        let observed = ObservationBatch::new(self.inputs, observations)?;
        let rows = action_rows(self.inputs.space, &actions)?;
        let logits =
            self.networks.critic.forward_frozen(&observed.with_actions(&rows)?)?.flatten_all()?.to_vec1::<f32>()?;
        let mut rated: Vec<(Candidate, f32)> = candidates.drain(..).zip(logits).collect();
        rated.sort_by(|(_, a), (_, b)| b.total_cmp(a));
        candidates.extend(rated.into_iter().map(|(candidate, _)| candidate));
        Ok(())
    }

    /// Plays one round of successive halving (Karnin et al. 2013): simulates attempts at every stroke until each has `attempts`, with the
    /// same errors for all strokes, and sorts by the mean reward, the best first.
    fn halving_round(&self, candidates: &mut [Candidate], attempts: usize, seed: u64) {
        for candidate in candidates.iter_mut() {
            for attempt in candidate.attempts..attempts {
                let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed.wrapping_add(attempt as u64));
                let shot = (&candidate.observation, candidate.action);
                candidate.earned += self.tables.attempt(self.reward, self.layout, shot, self.context, &mut rng);
            }
            candidate.attempts = candidate.attempts.max(attempts);
        }
        candidates.sort_by(|a, b| b.mean().total_cmp(&a.mean()));
    }

    /// Draws a stroke like those that players choose, with a level cue.
    fn random_stroke(&self, rng: &mut (impl Rng + ?Sized)) -> Action {
        let [offset, log_speed] = normal_pair(rng);
        let all = [
            action_for_offset(OFFSET[0] + OFFSET[1] * offset).clamp(-1.0, 1.0),
            action_for_speed((LOG_SPEED[0] + LOG_SPEED[1] * log_speed).exp()).clamp(-1.0, 1.0),
            rng.random_range(-1.0..=1.0),
            rng.random_range(LOWEST_TIP..=1.0),
            -1.0,
        ];
        self.masked(all)
    }

    /// Draws a neighbour of `action`: all numbers but the elevation move by normal steps of standard deviation `step`.
    fn neighbour(&self, action: Action, step: f32, rng: &mut (impl Rng + ?Sized)) -> Action {
        let [[a, b], [c, d]] = [normal_pair(rng), normal_pair(rng)];
        let mut near = action;
        for (value, normal) in near.iter_mut().zip([a, b, c, d]) {
            *value = (*value + step * normal as f32).clamp(-1.0, 1.0);
        }
        self.masked(near)
    }

    /// Sets the numbers that the action space does not use to zero.
    fn masked(&self, mut action: Action) -> Action {
        action[self.inputs.space.actions()..ACTIONS].fill(0.0);
        action
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        learning::ddpg::{action::ActionSpace, hyperparameters::Hyperparameters},
        table::Table,
    };
    use std::sync::Arc;

    #[test]
    fn the_search_improves_on_the_proposals() {
        let (table, mut rng) = (Arc::new(Table::default()), Xoshiro256PlusPlus::seed_from_u64(41));
        let hyper = Hyperparameters { actions: ActionSpace::Full, context: true, ..Hyperparameters::default() };
        let (inputs, networks) = (hyper.inputs(), &Networks::random(&hyper, &mut rng).unwrap());
        let tables = RandomizedTables::new(&table, inputs, 1);
        let reward = Reward::R3;
        let [mut proposed, mut found] = [0.0; 2];
        for _ in 0..12 {
            let layout = Layout::random(&table, &mut rng);
            let context = Context { table: 0, errors: 3.7 };
            let expert = Expert { tables: &tables, reward, inputs, networks, layout: &layout, context };
            let proposal = Candidate::new(Observation::new(&layout, 0), expert.random_stroke(&mut rng));
            let strokes = expert.search(&[(proposal.observation, proposal.action)], &mut rng).unwrap();
            let winner = strokes.best.first().unwrap();
            let mut again = [proposal, Candidate::new(winner.observation, winner.action)];
            expert.halving_round(&mut again[..1], 100, 7);
            expert.halving_round(&mut again[1..], 100, 7);
            proposed += again[0].mean();
            found += again[1].mean();
            // The reported success of the winner is right.
            assert!((again[1].mean() - f64::from(winner.success)).abs() < 0.35, "{winner:?} {:?}", again[1]);
        }
        assert!(found > 5.0 && found > proposed + 3.0, "{found} found, {proposed} proposed, of 12");
    }

    #[test]
    fn strokes_of_several_observations_stay_among_the_candidates() {
        let (table, mut rng) = (Arc::new(Table::default()), Xoshiro256PlusPlus::seed_from_u64(41));
        let observations = Observation::all(&table, &Layout::random(&table, &mut rng), true);
        let halved = |numbers: &[usize], left| {
            let mut candidates: Vec<Candidate> =
                numbers.iter().map(|&number| Candidate::new(observations[number], [0.0; ACTIONS])).collect();
            let removed = truncate_diverse(&mut candidates, left, 2);
            let number =
                |candidate: &Candidate| observations.iter().position(|one| *one == candidate.observation).unwrap();
            [candidates, removed].map(|candidates| candidates.iter().map(number).collect::<Vec<_>>())
        };
        assert_eq!(halved(&[0, 1, 2], 2), [vec![0, 1], vec![2]]);
        assert_eq!(halved(&[5, 5, 5, 5, 1, 5, 0], 3), [vec![5, 5, 1], vec![5, 5, 5, 0]]);
        assert_eq!(halved(&[7, 7, 7], 3), [vec![7, 7], vec![7]]);
    }
}
