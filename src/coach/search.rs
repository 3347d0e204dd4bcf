//! Search for the shot that a player is most likely to make: wide sampling, a race on common random numbers, refinement.

use std::{mem::replace, ops::Range};

use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

use super::{
    Source, Suggestion,
    candidates::{MIN_SPEED, stratified, variation},
    elevated::random_elevated_stroke,
    first::VARIED_PROPOSALS,
    pool::{ATTEMPTS_PER_BLOCK, Candidate, Race, retain_best},
    refinement::Refinement,
    trial::Task,
};
use crate::{game::Tally, physics::CueInputs, platform::parallel::Team};

/// Blocks of errors at which sampled shots are tried: first all shots, then those that still rank well.
const FIRST_PASS_BLOCKS: usize = 2;
const SECOND_PASS_BLOCKS: usize = 8;

/// Shares of the budget left at the start of the search, after which the sampling and the refinement end. The rest is
/// for judging the answer.
const SAMPLING_END: f64 = 0.5;
const REFINEMENT_END: f64 = 0.88;

/// Shots in the first round of sampling; each later round has twice as many, up to [`LARGEST_BATCH`].
const FIRST_BATCH: u64 = 256;
const LARGEST_BATCH: u64 = 4096;

/// Minimum shots in a round of sampling when few simulations are left.
const SMALLEST_BATCH: u64 = 64;

/// Variations of each of the policy's best proposals.
const VARIATIONS_OF_EACH: u64 = 16;

/// Sampled strokes may be softer than the softest successful shot by this factor. All speeds from [`ALWAYS_TRIED_SPEED`] on, m/s, are
/// always tried.
const SOFTER_FACTOR: f64 = 0.7;
const ALWAYS_TRIED_SPEED: f64 = 1.0;

/// One stroke in `ELEVATED_INTERVALS[0]` is a jump or a massé in the first [`ELEVATED_ROUNDS`] rounds of sampling. Later
/// it is one in `ELEVATED_INTERVALS[1]`, unless a jump or massé is in the better half of the pool. None is tried once the
/// best shot is made as often as [`GOOD_MAKE_RATE`].
const ELEVATED_INTERVALS: [u64; 2] = [8, 64];
const ELEVATED_ROUNDS: usize = 3;
const GOOD_MAKE_RATE: f64 = 0.9;

/// Shots that are kept after sampling, in addition to the best of each kind.
const SHORTLIST: usize = 128;

/// Shots of each kind that enter the refinement, whatever their rank.
const KEPT_OF_EACH_KIND: usize = 1;

/// Shots of each kind that are kept during sampling.
const SAMPLED_OF_EACH_KIND: usize = 3;

/// Cost of a unit of effort in a shot's score: a player should not need full power and a raised cue for the last
/// percent. In a plan it only breaks ties: at stake are runs of hundreds of points, and layouts differ by less than a
/// thousandth.
const EFFORT_PENALTY: f64 = 0.01;
const EFFORT_PENALTY_IN_A_PLAN: f64 = 0.0001;

/// Shots in one work item of a thread: enough to make the scheduling cost negligible.
const CHUNK_SIZE: usize = 32;

/// The state of a search.
pub struct Search<'a> {
    task: Task<'a>,
    team: &'a Team,
    /// The end times of the two stages, as shares of the whole budget.
    sampling_end: f64,
    refinement_end: f64,
    rng: Xoshiro256PlusPlus,
    plan: bool,
    race: Race,
    pool: Vec<Candidate>,
}

impl<'a> Search<'a> {
    /// Creates a search for `task` on the threads of `team`. With `plan`, the next point counts too. The time that is
    /// left now is divided among the stages.
    pub fn new(task: Task<'a>, plan: bool, team: &'a Team, seed: u64) -> Self {
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
        let race = Race::new(rng.random());
        let begins = task.clock.used_share().min(1.0);
        let [sampling_end, refinement_end] =
            [SAMPLING_END, REFINEMENT_END].map(|share| begins + share * (1.0 - begins));
        Self { task, team, sampling_end, refinement_end, rng, plan, race, pool: Vec::new() }
    }

    /// Searches from the successful shots in `found` and from variations of `proposals`. Returns the candidates, best
    /// first; never empty if `found` is not empty, however little time there is. Calls `on_leader` for every new leader.
    pub fn run(
        mut self,
        proposals: &[CueInputs],
        found: &[(Suggestion, Tally)],
        on_leader: &mut dyn FnMut(&Candidate),
    ) -> Vec<Candidate> {
        self.task.deadline = self.task.clock.deadline(self.sampling_end);
        let weight = self.weight();
        // The first shot of a former answer was the recommendation, which keeps its status; its other shots are
        // ordinary candidates.
        let mut former = false;
        let candidate = |(shot, tally): &(Suggestion, Tally)| {
            let is_other = shot.source == Source::Former && replace(&mut former, true);
            let source = if is_other { Source::Search } else { shot.source };
            Candidate::of(Suggestion { source, ..*shot }, tally, weight)
        };
        let found: Vec<_> = found.iter().map(candidate).collect();
        self.race.extend_to(self.task.worlds, SECOND_PASS_BLOCKS);
        let raced =
            |candidate: &Candidate| self.race.advance(&self.task, candidate, SECOND_PASS_BLOCKS).unwrap_or(*candidate);
        self.pool = self.team.map(&found, raced);
        self.sample(proposals, on_leader);
        self.refine(on_leader)
    }

    fn sample(&mut self, proposals: &[CueInputs], on_leader: &mut dyn FnMut(&Candidate)) {
        let Task { table, layout, rule, first, .. } = self.task;
        let varied = &proposals[..proposals.len().min(VARIED_PROPOSALS)];
        let variations = |numbers: Range<u64>, rng: &mut Xoshiro256PlusPlus| {
            numbers.map(|n| variation(table, &varied[n as usize % varied.len()], rng)).collect()
        };
        self.try_strokes(0..VARIATIONS_OF_EACH * varied.len() as u64, Source::Variation, variations);
        let begun = self.task.clock.simulations();
        let (mut drawn, mut batch, mut softest, mut rounds) = (0, FIRST_BATCH, MIN_SPEED, 0);
        while self.task.clock.used_share() < self.sampling_end || drawn == 0 {
            retain_best(&mut self.pool, SHORTLIST, SAMPLED_OF_EACH_KIND);
            let one_in = self.elevated_tried(rounds);
            let strokes = |numbers: Range<u64>, rng: &mut Xoshiro256PlusPlus| {
                let usual = numbers.clone().map(|n| stratified(table, layout, rule, first, n, softest, rng));
                let mut strokes: Vec<_> = usual.collect();
                let elevated = numbers.filter(|n| one_in.is_some_and(|one_in| n.is_multiple_of(one_in)));
                strokes.extend(elevated.filter_map(|_| random_elevated_stroke(table, layout, rng)));
                strokes
            };
            // If simulations limit the search, a larger batch would take its simulations from the refinement.
            let of_a_stroke = (self.task.clock.simulations() - begun) as f64 / (drawn as f64).max(1.0);
            let room = self.task.clock.remaining_simulations(self.sampling_end) / of_a_stroke.max(1.0);
            let count = batch.min((room as u64).max(SMALLEST_BATCH));
            self.try_strokes(drawn..drawn + count, Source::Search, strokes);
            drawn += count;
            batch = (2 * batch).min(LARGEST_BATCH);
            rounds += 1;
            let speeds = self.pool.iter().map(|candidate| candidate.shot.cue.speed);
            softest = (SOFTER_FACTOR * speeds.fold(f64::INFINITY, f64::min)).clamp(MIN_SPEED, ALWAYS_TRIED_SPEED);
            self.report_leader(on_leader);
        }
    }

    /// Returns after how many usual strokes a jump or massé is added in this round of sampling; `None` if none is.
    fn elevated_tried(&self, round: usize) -> Option<u64> {
        let is_good = self.pool.first().is_some_and(|best| {
            best.tried >= ATTEMPTS_PER_BLOCK * SECOND_PASS_BLOCKS && best.own_rate.share >= GOOD_MAKE_RATE
        });
        if !self.task.seeks_jumps() || is_good {
            return None;
        }
        let is_among = self.pool.iter().take(SHORTLIST / 2).any(|candidate| candidate.kind.raised);
        Some(ELEVATED_INTERVALS[usize::from(round >= ELEVATED_ROUNDS && !is_among)])
    }

    /// Returns the weight of the effort in a shot's score.
    const fn weight(&self) -> f64 {
        if self.plan { EFFORT_PENALTY_IN_A_PLAN } else { EFFORT_PENALTY }
    }

    /// Judges the strokes with these numbers. They are drawn in pieces, each with its own random generator.
    fn try_strokes(
        &mut self,
        numbers: Range<u64>,
        source: Source,
        draw: impl Fn(Range<u64>, &mut Xoshiro256PlusPlus) -> Vec<CueInputs> + Sync,
    ) {
        // A shot that ranks far behind the kept shots gets no second look.
        let bar = self.pool.get(SHORTLIST / 2).map_or(0.0, |candidate| candidate.score() - 0.2);
        let (task, race, weight, seed) = (&self.task, &self.race, self.weight(), self.rng.random::<u64>());
        let pieces: Vec<_> =
            numbers.clone().step_by(CHUNK_SIZE).map(|from| from..numbers.end.min(from + CHUNK_SIZE as u64)).collect();
        let judge = |cue: CueInputs| {
            let candidate = Candidate::new(task, cue, source, weight)?;
            let candidate = race.advance(task, &candidate, FIRST_PASS_BLOCKS)?;
            if candidate.score() < bar { Some(candidate) } else { race.advance(task, &candidate, SECOND_PASS_BLOCKS) }
        };
        let is_time_left = || !task.clock.is_past(task.deadline);
        let found = self.team.map(&pieces, |piece| {
            if !is_time_left() {
                return Vec::new();
            }
            let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed.wrapping_add(piece.start));
            let strokes = draw(piece.clone(), &mut rng).into_iter();
            strokes.take_while(|_| is_time_left()).filter_map(judge).collect()
        });
        self.pool.extend(found.into_iter().flatten());
    }

    /// Refines the best candidates.
    fn refine(mut self, on_leader: &mut dyn FnMut(&Candidate)) -> Vec<Candidate> {
        self.task.deadline = self.task.clock.deadline(self.refinement_end);
        let size = Refinement::size(self.task.clock.remaining_simulations(self.refinement_end), SHORTLIST);
        retain_best(&mut self.pool, size, KEPT_OF_EACH_KIND);
        let weight = self.weight();
        let Self { task, team, refinement_end: end, plan, race, pool, .. } = self;
        Refinement { task, team, end, plan, weight, race }.run(&pool, on_leader)
    }

    fn report_leader(&self, on_leader: &mut dyn FnMut(&Candidate)) {
        let tried = self.pool.iter().filter(|candidate| candidate.tried > 0);
        if let Some(best) = tried.max_by(|a, b| a.score().total_cmp(&b.score())) {
            on_leader(best);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        coach::{Doubt, Skill, clock::Clock, draws::Worlds, first::FirstShots},
        game::Rule,
        table::{Layout, Table},
    };
    use std::{sync::atomic::AtomicBool, thread, time::Duration};

    #[test]
    fn sampling_leaves_simulations_for_the_refinement() {
        let (table, cancel, team) = (Table::default(), AtomicBool::new(false), Team::of(2));
        let layout = Layout::opening(&table);
        let worlds = Worlds::new(&table, &layout, Doubt::NONE);
        for (rule, simulations) in Rule::ALL.into_iter().flat_map(|rule| [4_000, 10_000, 25_000].map(|n| (rule, n))) {
            let clock = Clock::start(Duration::from_secs(600), simulations, &cancel);
            let task = Task::new(&table, &layout, rule, Skill::EXPERT, &worlds, &clock);
            let mut search = Search::new(task, false, &team, 1);
            search.task.deadline = clock.deadline(search.sampling_end);
            search.race.extend_to(task.worlds, SECOND_PASS_BLOCKS);
            search.sample(&[], &mut |_| ());
            let used = clock.used_share();
            assert!((SAMPLING_END..1.25 * SAMPLING_END).contains(&used), "{rule:?}, {simulations}: {used}");
        }
    }

    #[test]
    fn late_search_divides_the_remaining_time() {
        let (table, cancel, budget) = (Table::default(), AtomicBool::new(false), Duration::from_secs(2));
        let team = Team::of(2);
        let layout = Layout::opening(&table);
        let worlds = Worlds::new(&table, &layout, Doubt::NONE);
        let clock = Clock::start(budget, u64::MAX, &cancel);
        let task = Task::new(&table, &layout, Rule::StraightRail, Skill::EXPERT, &worlds, &clock);
        let found = FirstShots::find(task, &[], &[], 1);
        // Simulates a first shot that was hard to find.
        thread::sleep(budget.mul_f64(0.5).saturating_sub(clock.elapsed()));
        let mut reported = 0;
        let pool = Search::new(task, false, &team, 1).run(&[], &found.solutions, &mut |_| reported += 1);
        assert!(pool[0].own_rate.attempts > 100.0 && reported > 1, "{reported} {:?}", pool[0]);
        assert!(pool.iter().any(|candidate| candidate.shot != found.solutions[0].0), "{pool:?}");
        // Without any time left, the result is what was found before.
        cancel.store(true, std::sync::atomic::Ordering::Relaxed);
        let pool = Search::new(task, true, &team, 1).run(&[], &found.solutions, &mut |_| panic!("nothing is known"));
        assert_eq!(pool.iter().map(|candidate| candidate.shot).collect::<Vec<_>>(), [found.solutions[0].0]);
        assert_eq!(pool[0].next.known(), None);
    }
}
