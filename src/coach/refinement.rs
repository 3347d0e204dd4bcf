//! The refinement stage of a search: successive halving (Jamieson and Talwalkar 2016) of strokes that climb from round
//! to round towards a higher make rate.

use super::{
    Source, Suggestion,
    evidence::{Distribution, Evidence, Trial},
    next::{MAX_POINTS, MIN_POINTS, NextValue},
    pool::{ATTEMPTS_PER_BLOCK, Candidate, Race, assign_worst_next_value},
    trial::Task,
};
use crate::{physics::CueInputs, platform::parallel::Team};

/// Strokes that are intended within this distance of each other, in standard errors, are merged: they would climb to
/// the same optimum.
const MERGE_DISTANCE: f64 = 1.0;

/// One stroke enters the refinement per this number of remaining simulations, in addition to the best of each kind.
const SIMULATIONS_PER_STROKE: f64 = 100.0;
const MIN_STROKES: usize = 24;

/// Rate of the halving: after the share p of the time, n^(1 - `HALVING_RATE` p) of n strokes are left. The best one thus has the
/// last part of the time alone.
const HALVING_RATE: f64 = 1.2;

/// Blocks per stroke in a round.
const MIN_BLOCKS: usize = 2;
const MAX_BLOCKS: usize = 256;

/// Maximum blocks of a stroke in total: its make rate is then known to half a percent.
const MAX_TOTAL_BLOCKS: usize = 4096;

/// In a plan, the next point is estimated from one successful attempt per this number of attempts in a round: each
/// needs several attempts, and each is simulated to its end.
const ATTEMPTS_PER_POINT: usize = 16;

/// Share by which another shot must be better than the former recommendation to replace it: a player who asks again
/// does not want another shot for a tiny gain that may be chance.
pub const MIN_IMPROVEMENT: f64 = 0.02;

/// Blocks in one work item of a thread.
const CHUNK_SIZE: usize = 4;

/// Attempts after which a stroke that has never missed, within [`CERTAIN_MISS_RATE`], is good enough to end the search early.
const CERTAIN_ATTEMPTS: f64 = 576.0;
const CERTAIN_MISS_RATE: f64 = 1e-4;

/// A stroke that is being improved, and the attempts at it.
struct Climber {
    best: Candidate,
    distribution: Distribution,
    evidence: Evidence,
    /// Blocks of the race that it has used.
    blocks: usize,
}

impl Climber {
    /// Updates the make rates from the evidence.
    fn update_rates(&mut self) {
        [self.best.own_rate, self.best.larger_error_rate] = self.evidence.rates(&self.distribution);
    }

    fn is_former(&self) -> bool {
        self.best.shot.source == Source::Former
    }

    fn is_certain(&self) -> bool {
        let Candidate { own_rate: own, larger_error_rate: larger, .. } = self.best;
        own.attempts >= CERTAIN_ATTEMPTS && own.share.min(larger.share) >= 1.0 - CERTAIN_MISS_RATE
    }
}

/// Sorts by score, best first (stable).
fn sort(climbers: &mut [Climber]) {
    climbers.sort_by(|a, b| b.best.score().total_cmp(&a.best.score()));
}

/// Moves the former recommendation to the front unless another stroke is better by enough.
fn prefer_former(climbers: &mut [Climber]) {
    let bar = climbers.first().map_or(0.0, |best| (1.0 - MIN_IMPROVEMENT) * best.best.score());
    if let Some(position) = climbers.iter().position(|climber| climber.is_former() && climber.best.score() >= bar) {
        climbers[..=position].rotate_right(1);
    }
}

/// Keeps the former recommendation in the race to the end; otherwise a few unlucky attempts at it would make the new
/// recommendation worse. Returns how many climbers go on, given that the best `live` do.
fn keep_former(climbers: &mut [Climber], live: usize) -> usize {
    match climbers.iter().position(Climber::is_former) {
        Some(position) if position >= live => {
            climbers[live..=position].rotate_right(1);
            live + 1
        }
        _ => live,
    }
}

/// The settings of a refinement.
pub struct Refinement<'a> {
    /// The problem for which strokes are tried.
    pub task: Task<'a>,
    /// The threads that work.
    pub team: &'a Team,
    /// The share of the budget at which it ends.
    pub end: f64,
    /// Whether the next point counts too.
    pub plan: bool,
    /// Cost of effort in a shot's score.
    pub weight: f64,
    /// The random errors of all attempts.
    pub race: Race,
}

impl Refinement<'_> {
    /// Returns the number of strokes that enter a refinement with this number of simulations, at most `most`.
    pub fn size(simulations: f64, most: usize) -> usize {
        ((simulations / SIMULATIONS_PER_STROKE) as usize).clamp(MIN_STROKES, most)
    }

    /// Refines the best of a pool and returns them, best first. Calls `on_leader` for every new leader.
    pub fn run(mut self, pool: &[Candidate], on_leader: &mut dyn FnMut(&Candidate)) -> Vec<Candidate> {
        let mut climbers = self.merged(pool);
        let all = climbers.len() as f64;
        let rounds = libm::log2(all).ceil() + 1.0;
        let begins = self.task.clock.used_share();
        let mut live = climbers.len();
        for round in 0.. {
            let used = self.task.clock.used_share();
            if used >= self.end || live == 0 {
                break;
            }
            let round = f64::from(round);
            let progress = ((used - begins) / (self.end - begins)).max(round / rounds);
            let simulations = self.task.clock.remaining_simulations(self.end) / (rounds - round).max(1.0);
            let blocks = simulations / ATTEMPTS_PER_BLOCK as f64;
            // With more simulations than one stroke can use, others may still improve.
            let fewest = (blocks / MAX_BLOCKS as f64).ceil().max(1.0);
            live = live.min(libm::pow(all, 1.0 - HALVING_RATE * progress).max(fewest).ceil() as usize);
            live = keep_former(&mut climbers, live);
            let each = ((blocks / live as f64) as usize).clamp(MIN_BLOCKS, MAX_BLOCKS);
            self.climb(&mut climbers[..live], each);
            if !self.attempt(&mut climbers[..live], each) {
                break;
            }
            sort(&mut climbers[..live]);
            prefer_former(&mut climbers[..live]);
            on_leader(&climbers[0].best);
            if climbers[0].is_certain() && !self.plan {
                break;
            }
        }
        climbers.into_iter().map(|climber| climber.best).collect()
    }

    /// Merges the strokes of a pool that are alike, with all attempts at them.
    fn merged(&self, pool: &[Candidate]) -> Vec<Climber> {
        let mut climbers: Vec<Climber> = Vec::new();
        for candidate in pool {
            let distribution = self.distribution(&candidate.shot.cue);
            let made = |(n, (errors, size)): (usize, _)| (errors, size, candidate.points >> n & 1 == 1);
            let blocks = candidate.tried / ATTEMPTS_PER_BLOCK;
            let trials: Vec<Trial> = self.race.errors(0..blocks).enumerate().map(made).collect();
            let climber = |source| {
                let shot = Suggestion { source, ..candidate.shot };
                let best = Candidate { shot, ..*candidate };
                let mut climber = Climber { best, distribution, evidence: Evidence::default(), blocks };
                climber.evidence.add(&distribution, &trials);
                climber
            };
            // The former recommendation stays as it is, because it has climbed before; a copy of it climbs on.
            let mut source = candidate.shot.source;
            if source == Source::Former {
                climbers.push(climber(source));
                source = Source::Search;
            }
            let near = climbers
                .iter_mut()
                .find(|climber| !climber.is_former() && climber.distribution.distance(&distribution) < MERGE_DISTANCE);
            if let Some(near) = near {
                near.evidence.add(&distribution, &trials);
                near.update_rates();
            } else {
                climbers.push(climber(source));
            }
        }
        sort(&mut climbers);
        climbers
    }

    fn distribution(&self, cue: &CueInputs) -> Distribution {
        Distribution::new(&self.task.skill, self.task.table.radius, cue)
    }

    /// Moves each stroke to where the attempts so far make the point more often. In a plan, estimates the next point
    /// with a precision that matches `each` blocks of attempts.
    fn climb(&self, climbers: &mut [Climber], each: usize) {
        let Self { task, race, .. } = self;
        let points = (ATTEMPTS_PER_BLOCK * each / ATTEMPTS_PER_POINT).clamp(MIN_POINTS, MAX_POINTS);
        let moved = self.team.map(climbers, |climber| {
            let Climber { best, distribution, evidence, .. } = climber;
            let source = if best.shot.source == Source::Search { Source::Search } else { Source::Variation };
            let ways = evidence.improved_strokes(task.table, task.skill, distribution);
            let mut ways = ways.into_iter().filter(|_| !climber.is_former());
            let moved = ways.find_map(|cue| Candidate::new(task, cue, source, self.weight)).unwrap_or(*best);
            // Until it is estimated, the next value is the old one.
            let next = NextValue::Assumed(best.next.value());
            let moved = Candidate { next, ..moved };
            if self.plan { race.estimate_next_point(task, &moved, points).unwrap_or(moved) } else { moved }
        });
        for (climber, best) in climbers.iter_mut().zip(moved) {
            (climber.distribution, climber.best) = (self.distribution(&best.shot.cue), best);
        }
        if self.plan {
            assign_worst_next_value(climbers.iter_mut().map(|climber| &mut climber.best));
        }
    }

    /// Tries each stroke at `each` more blocks of errors. Returns whether anything was tried.
    fn attempt(&mut self, climbers: &mut [Climber], each: usize) -> bool {
        let wanted = |climber: &Climber| climber.blocks..(climber.blocks + each).min(MAX_TOTAL_BLOCKS);
        let most = climbers.iter().map(|climber| wanted(climber).end).max().unwrap_or(0);
        self.race.extend_to(self.task.worlds, most);
        let Self { task, race, .. } = &*self;
        let pieces: Vec<_> = climbers
            .iter()
            .enumerate()
            .flat_map(|(index, climber)| {
                let blocks = wanted(climber);
                let end = blocks.end;
                blocks.step_by(CHUNK_SIZE).map(move |begin| (index, begin..(begin + CHUNK_SIZE).min(end)))
            })
            .collect();
        let tried = self
            .team
            .map(&pieces, |(index, blocks)| race.attempts(task, &climbers[*index].best.shot.cue, blocks.clone()));
        let tried: Vec<_> =
            pieces.into_iter().zip(tried).filter_map(|((index, _), tried)| Some((index, tried?))).collect();
        for (index, climber) in climbers.iter_mut().enumerate() {
            let own: Vec<Trial> =
                tried.iter().filter(|(of, _)| *of == index).flat_map(|(_, trials)| trials).copied().collect();
            climber.blocks = wanted(climber).end;
            if !own.is_empty() {
                climber.evidence.add(&climber.distribution, &own);
            }
            climber.update_rates();
        }
        !tried.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use std::{sync::atomic::AtomicBool, time::Duration};

    use super::*;
    use crate::{
        coach::{Doubt, Skill, clock::Clock, draws::Worlds, evidence::Rate, first::FirstShots, make_probability},
        game::{Rule, Tally},
        table::{Layout, Opening, Table},
    };

    #[test]
    fn former_recommendation_stays_unless_clearly_beaten() {
        let climber = |(share, source)| {
            let cue = CueInputs { a: 0.0, b: 0.2, theta: 0.0, phi: 0.0, speed: 2.0 };
            let best = Candidate::of(Suggestion { cue, source }, &Tally::default(), 0.0);
            let best = Candidate { own_rate: Rate { share, attempts: 100.0 }, ..best };
            let distribution = Distribution::new(&Skill::CLUB, Table::default().radius, &cue);
            Climber { best, distribution, evidence: Evidence::default(), blocks: 0 }
        };
        for (others, is_first) in [([0.8, 0.6], false), ([0.705, 0.701], true), ([0.6, 0.5], true)] {
            let [one, two] = others.map(|share| (share, Source::Search));
            let mut climbers: Vec<Climber> = [one, (0.7, Source::Former), two].map(climber).into();
            sort(&mut climbers);
            prefer_former(&mut climbers);
            let shares: Vec<f64> = climbers.iter().map(|climber| climber.best.own_rate.share).collect();
            assert_eq!(climbers[0].is_former(), is_first, "{shares:?}");
            assert!(shares[usize::from(is_first)..].is_sorted_by(|one, other| one > other), "{shares:?}");
        }
    }

    #[test]
    fn edge_strokes_climb_and_similar_strokes_are_merged() {
        let layout = Layout::opening(&Table::default());
        let table = Table { opening: Opening::Thesis, ..Table::default() };
        let (cancel, skill, rule) = (AtomicBool::new(false), Skill::CLUB, Rule::StraightRail);
        let worlds = Worlds::new(&table, &layout, Doubt::NONE);
        let [unlimited, clock] =
            [u64::MAX, 4000].map(|simulations| Clock::start(Duration::from_secs(60), simulations, &cancel));
        let task = Task::new(&table, &layout, rule, skill, &worlds, &clock);
        let mut race = Race::new(1);
        race.extend_to(&worlds, 8);
        // Directions around a shot that makes the point and that make it too; the first is at the edge.
        let found = FirstShots::find(Task { clock: &unlimited, ..task }, &[], &[], 1).solutions[0].0.cue;
        let turned = |n: i32| CueInputs { phi: found.phi + 0.1 * f64::from(n) * skill.at(&found).phi, ..found };
        let made = (-40..=0).filter_map(|n| Candidate::new(&task, turned(n), Source::Search, 0.0));
        let pool: Vec<_> = made.take(2).map(|candidate| race.advance(&task, &candidate, 8).unwrap()).collect();
        let refinement = Refinement { task, team: &Team::of(2), end: 1.0, plan: false, weight: 0.0, race };
        let merged = refinement.merged(&pool);
        assert_eq!((merged.len(), merged[0].blocks), (1, 8));
        assert!(merged[0].best.own_rate.attempts > 40.0, "both have 24: {:?}", merged[0].best);
        let mut reported = 0;
        let refined = refinement.run(&pool, &mut |_| reported += 1);
        let chance = |cue: CueInputs| make_probability(skill, rule, &table, &layout, &cue, 4000, 1).rate;
        let [before, after] = [pool[0].shot.cue, refined[0].shot.cue].map(chance);
        assert!(after > before + 0.01 && reported > 1, "{before} {after}");
        assert!((refined[0].own_rate.share - after).abs() < 0.04, "{:?} {after}", refined[0]);
    }
}
