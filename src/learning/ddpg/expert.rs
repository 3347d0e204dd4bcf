//! The expert of expert iteration (Anthony et al. 2017): a search on the simulator for strokes that the player makes more often than any
//! that the networks propose. Of these proposals and random strokes it keeps the critic's favourites, and compares them by attempts.

use candle_core::Result;
use rand::{Rng, RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

use super::{
    action::{ACTIONS, Action, aim_at, speed_of},
    agent::Transition,
    context::Inputs,
    networks::Networks,
    observation::Observation,
    observation_batch::{ObservationBatch, action_rows},
    randomized_tables::{Conditions, RandomizedTables},
};
use crate::{game::Reward, statistics::normal_pair, table::Layout};

/// Strokes of its own that the expert tries beside the networks' proposals, once each and as they are meant.
const TRIED: usize = 2048;

/// Of those that make the point then, the critic's favourites take part in successive halving: so many, and so many of one way to look at the layout.
const SCREENED: usize = 64;
const SCREENED_OF_ONE_WAY: usize = 12;

/// Attempts at each stroke by the end of each round of successive halving, and how many strokes stay for the next, so many of one way.
const ROUNDS: [(usize, usize); 3] = [(16, 24), (32, 8), (64, 6)];
const LEFT_OF_ONE_WAY: usize = 2;

/// Attempts by which the strokes that did not win are remembered.
const AGAIN: usize = 8;

/// Neighbours that are drawn around each stroke that is left, how many of all of them enter successive halving, and the standard deviations of the
/// steps to them, in halves of an action's range. The critic only picks which neighbours enter; attempts decide, so its errors cost time,
/// not correctness.
const NEIGHBOURS: usize = 24;
const FAVOURITES: usize = 24;
const STEPS: [f32; 3] = [0.12, 0.06, 0.03];

/// Part of the winner's points that the best stroke of another way must make to be shown, too.
const WORTH_SHOWING: f64 = 0.5;

/// Mean and standard deviation of the offset in diameters and of the logarithm of the speed in m/s: so are the strokes that players
/// make most often.
const OFFSET: [f64; 2] = [0.55, 0.3];
const LOG_SPEED: [f64; 2] = [0.85, 0.5];

/// Lowest place of the tip, as the action has it: hardly any of those strokes is struck lower.
const LOWEST: f32 = -0.3;

/// Where and by whom strokes are tried.
#[derive(Clone, Copy, Debug)]
pub struct Expert<'a> {
    pub tables: &'a RandomizedTables,
    pub reward: Reward,
    pub inputs: Inputs,
    /// The critic that chooses between strokes before any attempt is made.
    pub networks: &'a Networks,
    pub layout: &'a Layout,
    pub conditions: Conditions,
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

/// What a search found.
#[derive(Clone, Debug, Default)]
pub struct Found {
    /// The winner, and the best strokes of other ways to look at the layout that come near to it; the best one first.
    pub best: Vec<Transition>,
    /// Others that went far.
    pub others: Vec<Transition>,
}

/// Leaves the first `left` of candidates that stand in their order, but no more than `of_one_way` that look at the layout alike; returns the
/// others. So successive halving does not end between strokes that are nearly the same, and heads are shown strokes of several ways.
fn leave(candidates: &mut Vec<Candidate>, left: usize, of_one_way: usize) -> Vec<Candidate> {
    let (mut stay, mut out) = (Vec::<Candidate>::with_capacity(left), Vec::new());
    for candidate in candidates.drain(..) {
        let alike = stay.iter().filter(|other| other.observation == candidate.observation).count();
        let side = if stay.len() < left && alike < of_one_way { &mut stay } else { &mut out };
        side.push(candidate);
    }
    *candidates = stay;
    out
}

impl Expert<'_> {
    /// Strokes that went far in successive halving that began with `proposals`. Each has the share of attempts in which it was made, attempts
    /// that did not decide successive halving: what wins has had luck. None where no stroke ever earned anything.
    pub fn search(&self, proposals: &[(Observation, Action)], rng: &mut (impl Rng + ?Sized)) -> Result<Found> {
        let seed = rng.random();
        let tried = (0..TRIED).map(|_| {
            let table = self.tables.table(self.conditions);
            (Observation::random(table, self.layout, self.inputs.rails_first, rng), self.stroke(rng))
        });
        let all: Vec<_> = proposals.iter().copied().chain(tried).collect();
        // Those that make the point where nobody errs.
        let steady = Conditions { errors: 0.0, ..self.conditions };
        let mut scores_as_meant = |(observation, action): &(Observation, Action)| {
            self.tables.attempt(self.reward, self.layout, (observation, *action), steady, rng) >= 1.0
        };
        let mut candidates: Vec<Candidate> = all
            .into_iter()
            .filter(&mut scores_as_meant)
            .map(|(observation, action)| Candidate::new(observation, action))
            .collect();
        self.judge(&mut candidates)?;
        leave(&mut candidates, SCREENED, SCREENED_OF_ONE_WAY);
        let mut seen = Vec::new();
        for (attempts, left) in ROUNDS {
            self.halving_round(&mut candidates, attempts, seed);
            seen.extend(leave(&mut candidates, left, LEFT_OF_ONE_WAY));
        }
        for step in STEPS {
            let parents = candidates.clone();
            let mut children: Vec<Candidate> = parents
                .iter()
                .flat_map(|parent| [parent; NEIGHBOURS])
                .map(|parent| Candidate::new(parent.observation, self.beside(parent.action, step, rng)))
                .collect();
            self.judge(&mut children)?;
            children.truncate(FAVOURITES);
            self.halving_round(&mut children, ROUNDS[1].0, seed);
            // Those that the critic liked in vain it has to know better.
            seen.extend(children.split_off(ROUNDS[1].1.min(children.len())));
            candidates.extend(children);
            self.halving_round(&mut candidates, ROUNDS[2].0, seed);
            seen.extend(leave(&mut candidates, ROUNDS[2].1, LEFT_OF_ONE_WAY));
        }
        let again = |candidate: &Candidate, attempts| {
            let mut again = [Candidate::new(candidate.observation, candidate.action)];
            self.halving_round(&mut again, attempts, !seed);
            let success = (again[0].mean() / self.reward.highest()) as f32;
            Transition {
                observation: candidate.observation,
                conditions: self.conditions,
                action: candidate.action,
                success,
            }
        };
        let Some(winner) = candidates.first().copied().filter(|winner| winner.earned > 0.0) else {
            return Ok(Found::default());
        };
        let (mut best, mut others) = (Vec::<Candidate>::new(), seen);
        for candidate in candidates {
            let is_new_way = best.iter().all(|better| better.observation != candidate.observation);
            let is_shown = is_new_way && candidate.mean() >= WORTH_SHOWING * winner.mean();
            let strokes = if is_shown { &mut best } else { &mut others };
            strokes.push(candidate);
        }
        let [best, others] = [(best, ROUNDS[2].0), (others, AGAIN)]
            .map(|(strokes, attempts)| strokes.iter().map(|stroke| again(stroke, attempts)).collect());
        Ok(Found { best, others })
    }

    /// Puts the critic's favourites first.
    fn judge(&self, candidates: &mut Vec<Candidate>) -> Result<()> {
        if candidates.is_empty() {
            return Ok(());
        }
        let seen =
            candidates.iter().map(|candidate| self.tables.seen(candidate.observation, self.conditions)).collect();
        let actions: Vec<Action> = candidates.iter().map(|candidate| candidate.action).collect();
        let observed = ObservationBatch::new(self.inputs, seen)?;
        let rows = action_rows(self.inputs.space, &actions)?;
        let logits =
            self.networks.critic.forward_frozen(&observed.with_actions(&rows)?)?.flatten_all()?.to_vec1::<f32>()?;
        let mut liked: Vec<(Candidate, f32)> = candidates.drain(..).zip(logits).collect();
        liked.sort_by(|(_, a), (_, b)| b.total_cmp(a));
        candidates.extend(liked.into_iter().map(|(candidate, _)| candidate));
        Ok(())
    }

    /// One round of successive halving (Karnin et al. 2013): makes attempts at every stroke until each has so many, with the same errors
    /// for all, and puts the best first.
    fn halving_round(&self, candidates: &mut [Candidate], attempts: usize, seed: u64) {
        for candidate in candidates.iter_mut() {
            for attempt in candidate.attempts..attempts {
                let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed.wrapping_add(attempt as u64));
                let shot = (&candidate.observation, candidate.action);
                candidate.earned += self.tables.attempt(self.reward, self.layout, shot, self.conditions, &mut rng);
            }
            candidate.attempts = candidate.attempts.max(attempts);
        }
        candidates.sort_by(|a, b| b.mean().total_cmp(&a.mean()));
    }

    /// A stroke as players choose it.
    fn stroke(&self, rng: &mut (impl Rng + ?Sized)) -> Action {
        let [aside, faster] = normal_pair(rng);
        let all = [
            aim_at(OFFSET[0] + OFFSET[1] * aside).clamp(-1.0, 1.0),
            speed_of((LOG_SPEED[0] + LOG_SPEED[1] * faster).exp()).clamp(-1.0, 1.0),
            rng.random_range(-1.0..=1.0),
            rng.random_range(LOWEST..=1.0),
            -1.0,
        ];
        self.used(all)
    }

    fn beside(&self, action: Action, step: f32, rng: &mut (impl Rng + ?Sized)) -> Action {
        let [[a, b], [c, d]] = [normal_pair(rng), normal_pair(rng)];
        let mut near = action;
        for (value, normal) in near.iter_mut().zip([a, b, c, d]) {
            *value = (*value + step * normal as f32).clamp(-1.0, 1.0);
        }
        self.used(near)
    }

    /// The numbers that the space uses, the others nought.
    fn used(&self, mut action: Action) -> Action {
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
    fn what_the_expert_finds_is_made_more_often_than_what_was_proposed() {
        let (table, mut rng) = (Arc::new(Table::default()), Xoshiro256PlusPlus::seed_from_u64(41));
        let hyper = Hyperparameters { actions: ActionSpace::Full, context: true, ..Hyperparameters::default() };
        let (inputs, networks) = (hyper.inputs(), &Networks::random(&hyper, &mut rng).unwrap());
        let tables = RandomizedTables::new(&table, inputs, 1);
        let reward = Reward::R3;
        let [mut proposed, mut found] = [0.0; 2];
        for _ in 0..12 {
            let layout = Layout::random(&table, &mut rng);
            let conditions = Conditions { table: 0, errors: 3.7 };
            let expert = Expert { tables: &tables, reward, inputs, networks, layout: &layout, conditions };
            let proposal = Candidate::new(Observation::new(&layout, 0), expert.stroke(&mut rng));
            let strokes = expert.search(&[(proposal.observation, proposal.action)], &mut rng).unwrap();
            let winner = strokes.best.first().unwrap();
            let mut again = [proposal, Candidate::new(winner.observation, winner.action)];
            expert.halving_round(&mut again[..1], 100, 7);
            expert.halving_round(&mut again[1..], 100, 7);
            proposed += again[0].mean();
            found += again[1].mean();
            // What is said of the winner holds.
            assert!((again[1].mean() - f64::from(winner.success)).abs() < 0.35, "{winner:?} {:?}", again[1]);
        }
        assert!(found > 5.0 && found > proposed + 3.0, "{found} found, {proposed} proposed, of 12");
    }

    #[test]
    fn strokes_of_several_ways_stay_among_the_candidates() {
        let (table, mut rng) = (Arc::new(Table::default()), Xoshiro256PlusPlus::seed_from_u64(41));
        let ways = Observation::every(&table, &Layout::random(&table, &mut rng), true);
        let halved = |numbers: &[usize], left| {
            let mut candidates: Vec<Candidate> =
                numbers.iter().map(|&number| Candidate::new(ways[number], [0.0; ACTIONS])).collect();
            let out = leave(&mut candidates, left, 2);
            let number = |candidate: &Candidate| ways.iter().position(|way| *way == candidate.observation).unwrap();
            [candidates, out].map(|candidates| candidates.iter().map(number).collect::<Vec<_>>())
        };
        assert_eq!(halved(&[0, 1, 2], 2), [vec![0, 1], vec![2]]);
        assert_eq!(halved(&[5, 5, 5, 5, 1, 5, 0], 3), [vec![5, 5, 1], vec![5, 5, 5, 0]]);
        assert_eq!(halved(&[7, 7, 7], 3), [vec![7, 7], vec![7]]);
    }
}
