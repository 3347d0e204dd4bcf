//! The expert of expert iteration (Anthony et al. 2017): from the networks' proposals and strokes here and there, a race on the
//! simulator finds strokes that the player makes more often than any that was proposed.

use rand::{Rng, RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

use super::{
    action::{ACTIONS, Action, ActionSpace, aim_at, speed_of},
    observation::Observation,
    replay::Transition,
    venues::{Conditions, Venues},
};
use crate::{game::Reward, statistics::normal_pair, table::Layout};

/// Strokes of its own that the expert tries beside the networks' proposals.
const TRIED: usize = 96;

/// Attempts at each stroke in the rounds of the race, and how many strokes stay for the next.
const ROUNDS: [(usize, usize); 3] = [(4, 24), (16, 6), (48, 4)];

/// Attempts by which the strokes that did not win are remembered.
const AGAIN: usize = 8;

/// Strokes beside each that is left, and how far from it they are: standard deviations in halves of an action's range.
const NEIGHBOURS: usize = 6;
const STEPS: [f32; 3] = [0.12, 0.06, 0.03];

/// Mean and standard deviation of the offset in diameters and of the logarithm of the speed in m/s: so are the strokes that players
/// make most often.
const OFFSET: [f64; 2] = [0.55, 0.3];
const LOG_SPEED: [f64; 2] = [0.85, 0.5];

/// Lowest place of the tip, as the action has it: hardly any of those strokes is struck lower.
const LOWEST: f32 = -0.3;

/// Where and by whom strokes are tried.
#[derive(Clone, Copy, Debug)]
pub struct Expert<'a> {
    /// Where runs are played.
    pub venues: &'a Venues,
    /// What earns a reward.
    pub reward: Reward,
    /// What the actions mean.
    pub space: ActionSpace,
    /// Whether ways to the first ball by a cushion are tried, too.
    pub rails_first: bool,
    /// The balls.
    pub layout: &'a Layout,
    /// Who plays on which table.
    pub conditions: Conditions,
}

/// A stroke in the race.
#[derive(Clone, Copy, Debug)]
struct Runner {
    observation: Observation,
    action: Action,
    earned: f64,
    attempts: usize,
}

impl Runner {
    const fn new(observation: Observation, action: Action) -> Self {
        Self { observation, action, earned: 0.0, attempts: 0 }
    }

    fn mean(&self) -> f64 {
        self.earned / self.attempts.max(1) as f64
    }

    const fn goes_by_rail(&self) -> bool {
        self.observation.rail.is_some()
    }
}

/// What a search found.
#[derive(Clone, Debug, Default)]
pub struct Found {
    /// The winner, and the best stroke of the other way to the first ball, straight or by a cushion; the best one first.
    pub best: Vec<Transition>,
    /// Others that went far.
    pub others: Vec<Transition>,
}

/// Leaves the first `left` of runners that stand in their order, the last of which makes room for the best of a way to the first ball,
/// straight or by a cushion, that would be lost; returns the others. So what heads are shown holds strokes of either way, though
/// one of them wins three searches of four.
fn leave(runners: &mut Vec<Runner>, left: usize) -> Vec<Runner> {
    let other = runners.iter().position(|runner| runner.goes_by_rail() != runners[0].goes_by_rail());
    if let Some(lost) = other.filter(|&lost| lost >= left) {
        runners.swap(left - 1, lost);
    }
    runners.split_off(left.min(runners.len()))
}

impl Expert<'_> {
    /// Strokes that went far in the race that began with `proposals`. Each has the share of attempts in which it was made, attempts
    /// that did not decide the race: what wins has had luck. None where no stroke ever earned anything.
    pub fn search(&self, proposals: &[(Observation, Action)], rng: &mut (impl Rng + ?Sized)) -> Found {
        let seed = rng.random();
        let mut runners: Vec<Runner> =
            proposals.iter().map(|&(observation, action)| Runner::new(observation, action)).collect();
        runners.extend((0..TRIED).map(|_| {
            let table = self.venues.table(self.conditions);
            let observation = Observation::random(table, self.layout, self.rails_first, rng);
            Runner::new(observation, self.stroke(rng))
        }));
        let mut seen = Vec::new();
        for (attempts, left) in ROUNDS {
            self.race(&mut runners, attempts, seed);
            let out = leave(&mut runners, left);
            seen.extend(out.into_iter().filter(|runner| runner.attempts >= ROUNDS[1].0));
        }
        for step in STEPS {
            let parents = runners.clone();
            let mut children: Vec<Runner> = parents
                .iter()
                .flat_map(|parent| [parent; NEIGHBOURS])
                .map(|parent| Runner::new(parent.observation, self.beside(parent.action, step, rng)))
                .collect();
            self.race(&mut children, ROUNDS[1].0, seed);
            leave(&mut children, ROUNDS[1].1);
            runners.extend(children);
            self.race(&mut runners, ROUNDS[2].0, seed);
            seen.extend(leave(&mut runners, ROUNDS[2].1));
        }
        let again = |runner: &Runner, attempts| {
            let mut again = [Runner::new(runner.observation, runner.action)];
            self.race(&mut again, attempts, !seed);
            self.transition(&again[0])
        };
        if runners.first().is_none_or(|winner| winner.earned == 0.0) {
            return Found::default();
        }
        let (mut best, mut others) = (Vec::<Runner>::new(), Vec::new());
        for runner in runners {
            let is_new_way = best.iter().all(|better| better.goes_by_rail() != runner.goes_by_rail());
            let strokes = if is_new_way && runner.earned > 0.0 { &mut best } else { &mut others };
            strokes.push(runner);
        }
        others.extend(seen);
        let [best, others] = [(best, ROUNDS[2].0), (others, AGAIN)]
            .map(|(strokes, attempts)| strokes.iter().map(|stroke| again(stroke, attempts)).collect());
        Found { best, others }
    }

    /// Makes attempts at every stroke until each has so many, with the same errors for all, and puts the best first.
    fn race(&self, runners: &mut [Runner], attempts: usize, seed: u64) {
        for runner in runners.iter_mut() {
            for attempt in runner.attempts..attempts {
                let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed.wrapping_add(attempt as u64));
                let shot = (&runner.observation, runner.action);
                runner.earned += self.venues.attempt(self.reward, self.layout, shot, self.conditions, &mut rng);
            }
            runner.attempts = runner.attempts.max(attempts);
        }
        runners.sort_by(|a, b| b.mean().total_cmp(&a.mean()));
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
        action[self.space.actions()..ACTIONS].fill(0.0);
        action
    }

    fn transition(&self, runner: &Runner) -> Transition {
        let success = (runner.mean() / self.reward.highest()) as f32;
        Transition { observation: runner.observation, conditions: self.conditions, action: runner.action, success }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{learning::ddpg::context::Inputs, table::Table};
    use std::sync::Arc;

    #[test]
    fn what_the_expert_finds_is_made_more_often_than_what_was_proposed() {
        let (table, mut rng) = (Arc::new(Table::default()), Xoshiro256PlusPlus::seed_from_u64(41));
        let inputs = Inputs { space: ActionSpace::Full, context: true, closed_form: true, rails_first: false };
        let venues = Venues::new(&table, inputs, 1);
        let reward = Reward::R3;
        let [mut proposed, mut found] = [0.0; 2];
        for _ in 0..12 {
            let layout = Layout::random(&table, &mut rng);
            let conditions = Conditions { venue: 0, errors: 3.7 };
            let space = ActionSpace::Full;
            let expert = Expert { venues: &venues, reward, space, rails_first: false, layout: &layout, conditions };
            let proposal = Runner::new(Observation::new(&layout, 0), expert.stroke(&mut rng));
            let strokes = expert.search(&[(proposal.observation, proposal.action)], &mut rng);
            let winner = strokes.best.first().unwrap();
            let mut again = [proposal, Runner::new(winner.observation, winner.action)];
            expert.race(&mut again[..1], 100, 7);
            expert.race(&mut again[1..], 100, 7);
            proposed += again[0].mean();
            found += again[1].mean();
            // What is said of the winner holds.
            assert!((again[1].mean() - f64::from(winner.success)).abs() < 0.35, "{winner:?} {:?}", again[1]);
        }
        assert!(found > 5.0 && found > proposed + 3.0, "{found} found, {proposed} proposed, of 12");
    }

    #[test]
    fn the_best_of_either_way_stays_in_the_race() {
        let (table, mut rng) = (Arc::new(Table::default()), Xoshiro256PlusPlus::seed_from_u64(41));
        let ways = Observation::every(&table, &Layout::random(&table, &mut rng), true);
        let [straight, by_rail] =
            [false, true].map(|by_rail| *ways.iter().find(|way| way.rail.is_some() == by_rail).unwrap());
        let race = |ways: &[Observation]| {
            let mut runners: Vec<Runner> = (ways.iter().zip(0..))
                .map(|(way, earned)| Runner { earned: -f64::from(earned), ..Runner::new(*way, [0.0; ACTIONS]) })
                .collect();
            let out = leave(&mut runners, 2);
            assert_eq!(runners.len() + out.len(), ways.len());
            runners.iter().map(|runner| (runner.goes_by_rail(), -runner.earned)).collect::<Vec<_>>()
        };
        assert_eq!(race(&[straight; 4]), [(false, 0.0), (false, 1.0)]);
        assert_eq!(race(&[straight, by_rail, straight]), [(false, 0.0), (true, 1.0)]);
        assert_eq!(race(&[straight, straight, straight, by_rail, by_rail]), [(false, 0.0), (true, 3.0)]);
        assert_eq!(race(&[by_rail, by_rail, straight]), [(true, 0.0), (false, 2.0)]);
        assert_eq!(race(&[straight]), [(false, 0.0)]);
    }
}
