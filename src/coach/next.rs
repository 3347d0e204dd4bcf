//! What comes next: the probability of the point after this one, by looking at where the balls may come to rest.

use std::ops::ControlFlow;

use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;

use super::{
    candidates::{neighbour, stratified},
    crew,
    errors::{Errors, spread},
    pool::Candidate,
    trial::Task,
};
use crate::{
    game::Tally,
    learning::Policy,
    physics::{CueInputs, strike},
    simulation::{Event, Observer, Patience, simulate},
    table::Layout,
};

/// Rounds of the outlook: so many candidates, looked at from so many layouts that each may leave.
const ROUNDS: [(usize, usize); 3] = [(32, 3), (12, 12), (4, 48)];

/// Candidates further behind the leader than this are not looked at: no position makes up for so many misses.
const LAG: f64 = 0.03;

/// Shots of the net that is cast on a layout.
const NET: u64 = 160;

/// Errors by which shots on a layout are judged, and how many of them stay in each time.
const LOOKS: [(usize, usize); 3] = [(8, 6), (16, 3), (32, 2)];

/// Looks one shot ahead.
pub struct Outlook<'a> {
    task: Task<'a>,
    policy: Option<&'a Policy>,
    threads: usize,
    seed: u64,
    errors: Vec<Errors>,
}

/// A candidate and the layouts that it may leave.
struct Prospect {
    candidate: Candidate,
    /// Sum of the next point's probabilities, and layouts looked at.
    next: f64,
    looked: usize,
    /// Errors used up.
    drawn: usize,
}

impl Prospect {
    fn next(&self) -> f64 {
        if self.looked == 0 { 0.0 } else { self.next / self.looked as f64 }
    }

    /// Probability of two points in a row.
    fn value(&self) -> f64 {
        self.candidate.rate() * self.next()
    }
}

impl<'a> Outlook<'a> {
    /// An outlook from a task.
    pub fn new(task: Task<'a>, policy: Option<&'a Policy>, threads: usize, seed: u64) -> Self {
        let most = ROUNDS.map(|(_, layouts)| layouts).iter().sum::<usize>();
        Self { task, policy, threads, seed, errors: spread(2 * most, seed ^ 0x6e65_7874) }
    }

    /// Puts the candidate first that most often makes this point and the next, and orders those that were looked at
    /// behind it; returns the probability of its next point. Without time for a look, everything stays as it is.
    pub fn rank(&self, pool: &mut Vec<Candidate>) -> Option<f64> {
        let bar = pool.first()?.rate() - LAG;
        let (near, far): (Vec<_>, Vec<_>) = pool.drain(..).partition(|candidate| candidate.rate() >= bar);
        let mut prospects: Vec<Prospect> =
            near.into_iter().map(|candidate| Prospect { candidate, next: 0.0, looked: 0, drawn: 0 }).collect();
        let mut out = Vec::new();
        for (count, layouts) in ROUNDS {
            if prospects.len() > count {
                out.splice(0..0, prospects.split_off(count));
            }
            self.look(&mut prospects, layouts);
            prospects.sort_by(|a, b| b.value().total_cmp(&a.value()));
        }
        let next = prospects.first().filter(|best| best.looked > 0).map(Prospect::next);
        pool.extend(prospects.into_iter().chain(out).map(|prospect| prospect.candidate).chain(far));
        next
    }

    /// Looks at `layouts` more layouts that each of the prospects may leave, as far as time allows. All are looked at
    /// under the same errors, and none counts unless all do.
    fn look(&self, prospects: &mut [Prospect], layouts: usize) {
        let mut left = Vec::new();
        for (index, prospect) in prospects.iter_mut().enumerate() {
            let end = (prospect.drawn + layouts).min(self.errors.len());
            left.extend(
                self.errors[prospect.drawn..end].iter().map(|errors| (index, prospect.candidate.shot.cue, *errors)),
            );
            prospect.drawn = end;
        }
        let chances = crew::map(self.threads, &left, |(index, cue, errors)| {
            let stroke = self.task.skill.stroke(self.task.table.radius, cue, errors);
            // A miss leaves nothing to go on from.
            let layout = self.leaves(&stroke)?;
            (!self.task.clock.is_past(self.task.until)).then(|| (*index, self.chance(&layout)))
        });
        if self.task.clock.is_past(self.task.until) {
            return;
        }
        for (index, chance) in chances.into_iter().flatten() {
            prospects[index].next += chance;
            prospects[index].looked += 1;
        }
    }

    /// Where a stroke leaves the balls if it makes the point.
    fn leaves(&self, stroke: &CueInputs) -> Option<Layout> {
        let task = &self.task;
        if stroke.tip_offset_squared() > task.table.miscue_limit {
            return None;
        }
        let mut whole = Whole { tally: Tally::default(), patience: Patience(task.patience), given_up: false };
        let end = simulate(task.table, task.layout, &strike(task.table, stroke), &mut whole);
        task.clock.count(1);
        (whole.tally.is_point(task.rule) && !whole.given_up).then(|| end.layout())
    }

    /// How often the player makes the best shot that a short search finds on `layout`.
    fn chance(&self, layout: &Layout) -> f64 {
        let task = Task { layout, ..self.task };
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(self.seed);
        let proposals = self.policy.map_or_else(Vec::new, |policy| policy.proposals(task.table, layout));
        let mut shots: Vec<CueInputs> = proposals.iter().map(|proposal| proposal.cue).collect();
        shots.extend((0..NET).map(|n| stratified(task.table, layout, n, &mut rng)));
        task.clock.count(shots.len() as u64);
        shots.retain(|cue| task.makes(cue) == Some(true));
        let mut best = 0.0;
        let mut standing: Vec<(f64, CueInputs)> = shots.into_iter().map(|cue| (0.0, cue)).collect();
        for (round, (errors, stay)) in LOOKS.into_iter().enumerate() {
            if round > 0 {
                let near: Vec<_> = standing
                    .iter()
                    .flat_map(|(_, cue)| [*cue; 4])
                    .map(|cue| (0.0, neighbour(task.table, &cue, 0.5, &mut rng)))
                    .collect();
                standing.extend(near);
            }
            for (share, cue) in &mut standing {
                let (made, tried) = task.attempts(cue, &self.errors[..errors]);
                *share = made as f64 / tried.max(1) as f64;
            }
            standing.sort_by(|a, b| b.0.total_cmp(&a.0));
            standing.truncate(stay);
            best = standing.first().map_or(0.0, |(share, _)| *share);
        }
        best
    }
}

/// Watches a shot to its end.
struct Whole {
    tally: Tally,
    patience: Patience,
    given_up: bool,
}

impl Observer for Whole {
    fn event(&mut self, event: Event) -> ControlFlow<()> {
        self.tally.note(&event);
        ControlFlow::Continue(())
    }

    fn contact_step(&mut self) -> ControlFlow<()> {
        let flow = self.patience.step();
        self.given_up |= flow.is_break();
        flow
    }
}
