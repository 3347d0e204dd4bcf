//! The search for the shot that a player is most likely to make: sampling widely, a race on common random numbers, refinement.

use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

use super::{
    Source, Suggestion,
    candidates::{MIN_SPEED, neighbour, stratified, variation},
    elevated::raised,
    next::NextValue,
    pool::{Candidate, Race, keep, keep_leaders, suppose_the_worst},
    trial::{Course, Task},
};
use crate::{physics::CueInputs, platform::parallel};

/// Errors at which shots are tried, each time only those that are still among the better ones: two looks at what was
/// sampled, then the stages of the refinement.
const LOOKS: [usize; 5] = [8, 32, 96, 256, 768];
const FIRST_LOOK: usize = LOOKS[0];
const SECOND_LOOK: usize = LOOKS[1];
const THIRD_LOOK: usize = LOOKS[2];
const FOURTH_LOOK: usize = LOOKS[3];
const MOST_ERRORS: usize = LOOKS[4];

/// Errors in each stage of the refinement, the share of it at which the stage begins at the latest, and the neighbours of
/// each leader that are tried in a round.
const STAGES: [(usize, f64, usize); 3] = [(THIRD_LOOK, 0.0, 6), (FOURTH_LOOK, 0.4, 4), (MOST_ERRORS, 0.75, 3)];

/// How far each leader is moved to the middle of its points in a round of the refinement.
const STRETCHES: [f64; 2] = [1.0, 2.0];

/// Shares of what is left of the budget when the search begins, after which the sampling and the refinement end. The
/// rest is for judging the answer.
const SAMPLING_ENDS: f64 = 0.5;
const REFINEMENT_ENDS: f64 = 0.88;

/// Shots of the first round of sampling; each later one has twice as many, up to [`LARGEST_BATCH`].
const FIRST_BATCH: usize = 256;
const LARGEST_BATCH: usize = 4096;

/// How much softer than the softest shot that has made the point sampled strokes may be, and the speed from which on all are
/// tried in any case, m/s.
const SOFTER: f64 = 0.7;
const SOFT: f64 = 1.0;

/// One stroke in so many of the first rounds of sampling is a jump or a massé, and of the later ones where none of these is
/// among the better half of what stays in; none is where the best shot so far is made this often.
const ELEVATED_TRIED: [usize; 2] = [8, 64];
const ROUNDS_OF_ELEVATED: usize = 3;
const GOOD_WITHOUT: f64 = 0.9;

/// Shots that leave the sampling, besides the best of each kind.
const SHORTLIST: usize = 128;

/// A stage of successive halving (Jamieson and Talwalkar 2016): how many shots go on to it, besides the best of each kind.
struct Rung {
    most: usize,
    fewest: usize,
    /// Simulations left for each: where there are few, they go to the better shots.
    simulations: f64,
}

impl Rung {
    /// How many do when so many simulations are left.
    fn size(&self, simulations_left: f64) -> usize {
        ((simulations_left / self.simulations) as usize).clamp(self.fewest, self.most)
    }
}

/// Those after the second look, and those in the refinement.
const FAVOURITES: Rung = Rung { most: 64, fewest: 8, simulations: 160.0 };
const LEADERS: Rung = Rung { most: 10, fewest: 3, simulations: 640.0 };

/// Shots of each kind that stay in, however they stand, where there are as many leaders as can be; one where there are fewer.
const OF_EACH_KIND: usize = 3;

/// What a unit of effort costs in a shot's score: a player is not to strike with all force and a raised cue for the last
/// percent. In a plan it only decides between equals: where runs of
/// hundreds of points are at stake, layouts differ by less than a thousandth.
const EFFORT_PENALTY: f64 = 0.01;
const EFFORT_PENALTY_IN_A_PLAN: f64 = 0.0001;

/// Shots of one piece of work: enough that handing it out costs nothing.
const PIECE: usize = 32;

/// A search on its way.
pub struct Search<'a> {
    task: Task<'a>,
    threads: usize,
    /// The two moments as shares of the whole budget.
    sampling_ends: f64,
    refinement_ends: f64,
    rng: Xoshiro256PlusPlus,
    plan: bool,
    race: Race,
    pool: Vec<Candidate>,
    /// How many lead.
    leaders: usize,
}

impl<'a> Search<'a> {
    /// A search on a task, with so many threads; with a `plan` for the next point too. It shares out the time that is left
    /// now.
    pub fn new(task: Task<'a>, plan: bool, threads: usize, seed: u64) -> Self {
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
        let race = Race::new(MOST_ERRORS, rng.random());
        let begins = task.clock.used().min(1.0);
        let [sampling_ends, refinement_ends] =
            [SAMPLING_ENDS, REFINEMENT_ENDS].map(|share| begins + share * (1.0 - begins));
        Self { task, threads, sampling_ends, refinement_ends, rng, plan, race, pool: Vec::new(), leaders: LEADERS.most }
    }

    /// Looks for shots, starting from those that were `found` to make the point and from variations of `proposals`; the best
    /// comes first, and where something was found there is one, however little time. `tell` hears of every new leader.
    pub fn run(
        mut self,
        proposals: &[CueInputs],
        found: &[(Suggestion, Course)],
        tell: &mut dyn FnMut(&Candidate),
    ) -> Vec<Candidate> {
        self.task.until = self.task.clock.moment(self.sampling_ends);
        let weight = self.weight();
        let found: Vec<_> = found.iter().map(|(shot, course)| Candidate::of(*shot, course, weight)).collect();
        self.race.extend_to(self.task.worlds, SECOND_LOOK);
        self.pool = self.raced(&found, SECOND_LOOK);
        self.sample(proposals, tell);
        self.task.until = self.task.clock.moment(self.refinement_ends);
        self.narrow_down(tell);
        self.refine(tell);
        self.pool
    }

    fn sample(&mut self, proposals: &[CueInputs], tell: &mut dyn FnMut(&Candidate)) {
        let table = self.task.table;
        let mut shots = Vec::new();
        for cue in proposals.iter().take(4) {
            let varied =
                (0..16).map(|_| Suggestion { cue: variation(table, cue, &mut self.rng), source: Source::Variation });
            shots.extend(varied);
        }
        let (mut drawn, mut batch, mut softest, mut rounds) = (0, FIRST_BATCH, MIN_SPEED, 0);
        while self.task.clock.used() < self.sampling_ends || drawn == 0 {
            shots.extend((0..batch as u64).map(|n| Suggestion {
                cue: stratified(table, self.task.layout, self.task.rule, drawn + n, softest, &mut self.rng),
                source: Source::Search,
            }));
            keep(&mut self.pool, SHORTLIST, OF_EACH_KIND);
            let elevated = self.elevated(batch, rounds);
            shots.extend(elevated.into_iter().map(|cue| Suggestion { cue, source: Source::Search }));
            drawn += batch as u64;
            batch = (2 * batch).min(LARGEST_BATCH);
            rounds += 1;
            self.sample_batch(&shots);
            let speeds = self.pool.iter().map(|candidate| candidate.shot.cue.speed);
            softest = (SOFTER * speeds.fold(f64::INFINITY, f64::min)).clamp(MIN_SPEED, SOFT);
            shots.clear();
            self.tell(tell);
        }
    }

    /// Jumps and massés for a round of sampling with so many other strokes.
    fn elevated(&mut self, batch: usize, rounds: usize) -> Vec<CueInputs> {
        let is_good = self.pool.first().is_some_and(|best| best.tried >= SECOND_LOOK && best.rate() >= GOOD_WITHOUT);
        if !self.task.seeks_jumps() || is_good {
            return Vec::new();
        }
        let is_among = self.pool.iter().take(SHORTLIST / 2).any(|candidate| candidate.kind.raised);
        let one_in = ELEVATED_TRIED[usize::from(rounds >= ROUNDS_OF_ELEVATED && !is_among)];
        (0..batch / one_in).filter_map(|_| raised(self.task.table, self.task.layout, &mut self.rng)).collect()
    }

    /// What the hardest stroke and the steepest cue cost.
    const fn weight(&self) -> f64 {
        if self.plan { EFFORT_PENALTY_IN_A_PLAN } else { EFFORT_PENALTY }
    }

    /// Judges a batch of sampled strokes.
    fn sample_batch(&mut self, shots: &[Suggestion]) {
        // Who does not come near those who stay in is not looked at twice.
        let bar = self.pool.get(SHORTLIST / 2).map_or(0.0, |candidate| candidate.score() - 0.2);
        let (task, race, weight) = (&self.task, &self.race, self.weight());
        let pieces: Vec<&[Suggestion]> = shots.chunks(PIECE).collect();
        let judge = |shot: &Suggestion| {
            let candidate = Candidate::new(task, shot.cue, shot.source, weight)?;
            let candidate = race.go_on(task, &candidate, FIRST_LOOK)?;
            if candidate.score() < bar { Some(candidate) } else { race.go_on(task, &candidate, SECOND_LOOK) }
        };
        let found = parallel::map(self.threads, &pieces, |piece| {
            piece.iter().take_while(|_| !task.clock.is_past(task.until)).filter_map(judge).collect::<Vec<_>>()
        });
        self.pool.extend(found.into_iter().flatten());
    }

    /// Tries the best at more errors, the best of those at more still.
    fn narrow_down(&mut self, tell: &mut dyn FnMut(&Candidate)) {
        let left = self.simulations_left();
        self.leaders = LEADERS.size(left);
        let of_each = if self.leaders == LEADERS.most { OF_EACH_KIND } else { 1 };
        for (errors, best) in [(SECOND_LOOK, FAVOURITES.size(left)), (THIRD_LOOK, self.leaders)] {
            self.race.extend_to(self.task.worlds, errors);
            keep(&mut self.pool, 2 * best, of_each);
            self.pool = self.raced(&self.pool, errors);
            let steps: Vec<_> = self.pool.iter().map(|parent| (*parent, parent.middle(&self.task, 1.0))).collect();
            let found = parallel::map(self.threads, &steps, |(parent, cue)| self.beside(parent, *cue, errors));
            self.pool.extend(found.into_iter().flatten());
            if self.plan && errors == SECOND_LOOK {
                self.look_ahead();
            }
            keep_leaders(&mut self.pool, best, of_each);
            self.tell(tell);
        }
    }

    /// The simulations that fit in before the refinement ends, as far as is known by now.
    fn simulations_left(&self) -> f64 {
        let used = self.task.clock.used();
        self.task.clock.simulations() as f64 * (self.refinement_ends / used - 1.0).max(0.0)
    }

    /// Finds out how easy the next point is after each of the pool.
    fn look_ahead(&mut self) {
        self.pool = parallel::map(self.threads, &self.pool, |candidate| {
            self.race.look_ahead(&self.task, candidate).unwrap_or(*candidate)
        });
        suppose_the_worst(&mut self.pool);
    }

    /// The candidates tried at so many errors; those that time did not suffice for are left as they are.
    fn raced(&self, candidates: &[Candidate], errors: usize) -> Vec<Candidate> {
        parallel::map(self.threads, candidates, |candidate| {
            self.race.go_on(&self.task, candidate, errors).unwrap_or(*candidate)
        })
    }

    /// Looks around the leaders, at first far, then near.
    fn refine(&mut self, tell: &mut dyn FnMut(&Candidate)) {
        let mut stage = 0;
        loop {
            let used = self.task.clock.used();
            if used >= self.refinement_ends || self.pool.is_empty() {
                break;
            }
            let progress = (used - self.sampling_ends) / (self.refinement_ends - self.sampling_ends);
            if self.pool[0].is_flawless() && self.pool[0].tried >= STAGES[stage].0 {
                // There is nothing to improve that these errors could show.
                if stage + 1 == STAGES.len() && !self.plan {
                    break;
                }
                stage = (stage + 1).min(STAGES.len() - 1);
            }
            stage = STAGES.iter().rposition(|(_, begins, _)| progress >= *begins).unwrap_or(0).max(stage);
            let (errors, _, neighbours) = STAGES[stage];
            self.race.extend_to(self.task.worlds, errors);
            self.pool = self.raced(&self.pool, errors);
            keep_leaders(&mut self.pool, self.leaders, 1);
            let scale = 1.0 - 0.8 * progress.max(0.0);
            let mut tries = Vec::with_capacity(self.pool.len() * neighbours);
            for parent in &self.pool {
                tries.extend(STRETCHES.map(|stretch| (*parent, parent.middle(&self.task, stretch))));
                for _ in 0..neighbours {
                    tries.push((*parent, neighbour(self.task.table, &parent.shot.cue, scale, &mut self.rng)));
                }
            }
            let found = parallel::map(self.threads, &tries, |(parent, cue)| self.beside(parent, *cue, errors));
            self.pool.extend(found.into_iter().flatten());
            keep_leaders(&mut self.pool, self.leaders, 1);
            self.tell(tell);
        }
    }

    /// A neighbour of a leader, tried at so many errors; `None` where it falls behind, or time runs out.
    fn beside(&self, parent: &Candidate, cue: CueInputs, errors: usize) -> Option<Candidate> {
        let Self { task, race, .. } = self;
        if task.clock.is_past(task.until) {
            return None;
        }
        let source = if parent.shot.source == Source::Search { Source::Search } else { Source::Variation };
        // Until it is known, what comes next is what comes after the parent.
        let next = NextValue::Supposed(parent.next.value());
        let mut candidate = Candidate { next, ..Candidate::new(task, cue, source, self.weight())? };
        for look in LOOKS.into_iter().take_while(|look| *look <= errors) {
            if candidate.tried > 0 && candidate.score() < parent.score() - slack(candidate.tried) {
                return None;
            }
            candidate = race.go_on(task, &candidate, look)?;
            if self.plan && look == SECOND_LOOK {
                candidate = race.look_ahead(task, &candidate)?;
            }
        }
        (candidate.tried == errors).then_some(candidate)
    }

    fn tell(&self, tell: &mut dyn FnMut(&Candidate)) {
        let tried = self.pool.iter().filter(|candidate| candidate.tried > 0);
        if let Some(best) = tried.max_by(|a, b| a.score().total_cmp(&b.score())) {
            tell(best);
        }
    }
}

/// By how much a shot may lag behind its parent after so many errors and still be followed.
fn slack(tried: usize) -> f64 {
    0.5 / (tried as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        coach::{Doubt, Skill, clock::Clock, draws::Worlds, first::Attempt, trial::CONTACT_STEPS},
        game::Rule,
        table::{Layout, Table},
    };
    use std::{sync::atomic::AtomicBool, thread, time::Duration};

    #[test]
    fn a_search_that_begins_late_shares_out_what_is_left_of_the_time() {
        let (table, cancel, budget) = (Table::default(), AtomicBool::new(false), Duration::from_secs(2));
        let layout = Layout::opening(&table);
        let clock = Clock::start(budget, u64::MAX, &cancel);
        let task = Task {
            table: &table,
            layout: &layout,
            rule: Rule::StraightRail,
            skill: Skill::EXPERT,
            jumps: true,
            worlds: &Worlds::new(&table, &layout, Doubt::NONE),
            clock: &clock,
            until: clock.moment(1.0),
            patience: CONTACT_STEPS,
        };
        let found = Attempt::new(task).run(&[], 1);
        // As if the first shot had been hard to find.
        thread::sleep(budget.mul_f64(0.5).saturating_sub(clock.elapsed()));
        let mut told = 0;
        let pool = Search::new(task, false, 2, 1).run(&[], &found.solutions, &mut |_| told += 1);
        assert!(pool[0].tried > SECOND_LOOK && told > 1, "{told} {:?}", pool[0]);
        assert!(pool.iter().any(|candidate| candidate.shot != found.solutions[0].0), "{pool:?}");
        // No time at all: what was found is all there is.
        cancel.store(true, std::sync::atomic::Ordering::Relaxed);
        let pool = Search::new(task, true, 2, 1).run(&[], &found.solutions, &mut |_| panic!("nothing is known"));
        assert_eq!(pool.iter().map(|candidate| candidate.shot).collect::<Vec<_>>(), [found.solutions[0].0]);
        assert_eq!(pool[0].next.known(), None);
    }
}
