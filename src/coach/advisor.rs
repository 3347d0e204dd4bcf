//! The recommender: what it is asked, how it looks for a shot, and what it answers.

use std::{
    fmt,
    ops::ControlFlow,
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
    time::{Duration, Instant},
};

use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;
use serde::Serialize;

use super::search::{anything, variation};
use crate::{
    game::{Referee, Reward, Rule, Tally},
    learning::{Policy, PolicyError},
    physics::{CueInputs, strike},
    simulation::{Event, Observer, watch},
    table::{Layout, LayoutError, Table},
};

/// Variations tried of each of the policy's favourites.
const VARIATIONS: u32 = 64;

/// How many of the policy's favourites are varied.
const FAVOURITES: usize = 4;

/// What the coach is asked for.
#[derive(Clone, Debug)]
pub struct Request {
    /// What counts as a point.
    pub rule: Rule,
    /// Time to look for a shot.
    pub budget: Duration,
    /// Seed of the search: the same request finds the same shot.
    pub seed: u64,
    /// Set from another thread, it ends the search.
    pub cancel: Arc<AtomicBool>,
}

impl Default for Request {
    fn default() -> Self {
        Self { rule: Rule::default(), budget: Duration::from_millis(500), seed: 0, cancel: Arc::default() }
    }
}

/// Where a shot comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Source {
    /// The policy's own shot.
    Policy,
    /// The policy's direction and speed with another tip position and elevation (thesis 5.1): in JSON a search too.
    #[serde(rename = "search")]
    Variation,
    /// The wider search.
    Search,
}

impl fmt::Display for Source {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.pad(match self {
            Self::Policy => "policy",
            Self::Variation => "variation",
            Self::Search => "search",
        })
    }
}

/// A shot and where it comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Suggestion {
    /// The stroke.
    pub cue: CueInputs,
    /// Who thought of it.
    pub source: Source,
}

/// The coach's answer.
#[derive(Clone, Debug)]
pub struct Recommendation {
    /// The stroke: it makes the point if `solved`, else it is the best attempt.
    pub cue: CueInputs,
    /// Whether it makes the point, by simulation.
    pub solved: bool,
    /// Where it comes from.
    pub source: Source,
    /// Other strokes that make the point, the policy's favourites first.
    pub alternatives: Vec<Suggestion>,
    /// The critic's probability that the policy's favourite makes a point, where there is a policy.
    pub policy_success: Option<f64>,
    /// Shots simulated.
    pub simulations: u64,
    /// Time taken.
    pub elapsed: Duration,
}

/// A coach for one table. Cheap to share between threads.
#[derive(Clone, Debug)]
pub struct Coach {
    table: Table,
    policies: Vec<Policy>,
}

impl Coach {
    /// A coach with the policies that are bundled for this table, if there are any; without, it searches.
    ///
    /// # Errors
    /// Where a bundled policy is damaged.
    pub fn new(table: Table) -> Result<Self, PolicyError> {
        let bundled = Rule::ALL.into_iter().filter_map(|rule| Policy::bundled(&table, rule));
        let policies = bundled.collect::<Result<_, _>>()?;
        Ok(Self { table, policies })
    }

    /// The same coach with one other policy, which it asks whatever the rule is.
    #[must_use]
    pub fn with_policy(self, policy: Policy) -> Self {
        Self { policies: vec![policy], ..self }
    }

    /// The policy that it asks under `rule`: the one that was trained for it, else any, for a shot that makes some point is
    /// a good start of a search.
    pub fn policy(&self, rule: Rule) -> Option<&Policy> {
        let trained_for = |policy: &&Policy| policy.origin().reward == Reward::for_rule(rule);
        self.policies.iter().find(trained_for).or(self.policies.first())
    }

    /// The table that it knows.
    pub const fn table(&self) -> &Table {
        &self.table
    }

    /// The policy's own shot under `rule`, unchecked; `None` where there is no policy.
    pub fn policy_shot(&self, layout: &Layout, rule: Rule) -> Option<CueInputs> {
        self.policy(rule).map(|policy| policy.propose(&self.table, layout))
    }

    /// Looks for a shot that makes the point. The shot never oversteps the table's miscue limit.
    ///
    /// # Errors
    /// Where the layout is impossible.
    pub fn recommend(&self, layout: &Layout, request: &Request) -> Result<Recommendation, LayoutError> {
        layout.validate(&self.table)?;
        Ok(Attempt::new(&self.table, layout, request).run(self.policy(request.rule)))
    }
}

/// How good a shot is that makes no point: object balls met, then cushions on the way as far as the rule wants them.
type Merit = (u32, u32);

/// One search for a shot.
struct Attempt<'a> {
    table: &'a Table,
    layout: &'a Layout,
    request: &'a Request,
    start: Instant,
    simulations: u64,
    best: Option<(Merit, Suggestion)>,
    solutions: Vec<Suggestion>,
}

impl<'a> Attempt<'a> {
    fn new(table: &'a Table, layout: &'a Layout, request: &'a Request) -> Self {
        let start = Instant::now();
        Self { table, layout, request, start, simulations: 0, best: None, solutions: Vec::new() }
    }

    fn run(mut self, policy: Option<&Policy>) -> Recommendation {
        let proposals = policy.map_or_else(Vec::new, |policy| policy.proposals(self.table, self.layout));
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(self.request.seed);
        for proposal in &proposals {
            self.play(proposal.cue, Source::Policy);
        }
        'variations: for proposal in proposals.iter().take(FAVOURITES) {
            for _ in 0..VARIATIONS {
                if self.is_over() {
                    break 'variations;
                }
                self.play(variation(self.table, &proposal.cue, &mut rng), Source::Variation);
            }
        }
        while !self.is_over() {
            self.play(anything(self.table, self.layout, &mut rng), Source::Search);
        }
        let policy_success = proposals.first().map(|proposal| proposal.success);
        self.answer(policy_success)
    }

    /// Whether a shot has been found, or time is up.
    fn is_over(&self) -> bool {
        !self.solutions.is_empty() || self.is_out_of_time()
    }

    fn is_out_of_time(&self) -> bool {
        self.start.elapsed() >= self.request.budget || self.request.cancel.load(Ordering::Relaxed)
    }

    fn play(&mut self, cue: CueInputs, source: Source) {
        let mut hurried = Hurried { referee: Referee::default(), attempt: self };
        watch(self.table, self.layout, &strike(self.table, &cue), &mut hurried);
        let tally = hurried.referee.tally;
        self.simulations += 1;
        let suggestion = Suggestion { cue, source };
        if tally.is_point(self.request.rule) {
            self.solutions.push(suggestion);
        } else {
            let merit = merit(&tally, self.request.rule);
            if self.best.is_none_or(|(best, _)| merit > best) {
                self.best = Some((merit, suggestion));
            }
        }
    }

    fn answer(self, policy_success: Option<f64>) -> Recommendation {
        let mut solutions = self.solutions.into_iter();
        let found = solutions.next();
        // With no time at all and no policy, nothing was tried: a plain stroke at the first ball is the attempt.
        let plain = || {
            let phi = (self.layout.balls[1] - self.layout.balls[0]).to_angle();
            Suggestion { cue: CueInputs { a: 0.0, b: 0.0, theta: 0.0, phi, speed: 2.0 }, source: Source::Search }
        };
        let Suggestion { cue, source } = found.or(self.best.map(|(_, shot)| shot)).unwrap_or_else(plain);
        Recommendation {
            cue,
            solved: found.is_some(),
            source,
            alternatives: solutions.collect(),
            policy_success,
            simulations: self.simulations,
            elapsed: self.start.elapsed(),
        }
    }
}

/// A referee who gives a shot up when time is up: one with a stiff contact can take seconds.
struct Hurried<'a> {
    referee: Referee,
    attempt: &'a Attempt<'a>,
}

impl Observer for Hurried<'_> {
    const ENDS: bool = Referee::ENDS;

    fn event(&mut self, event: Event) -> ControlFlow<()> {
        self.referee.event(event)
    }

    fn contact_step(&mut self) -> ControlFlow<()> {
        if self.attempt.is_out_of_time() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

fn merit(tally: &Tally, rule: Rule) -> Merit {
    let met = tally.met.iter().map(|&met| u32::from(met)).sum();
    let cushions = if tally.met_both() { tally.cushions_before_second } else { tally.cushions };
    (met, cushions.min(rule.cushions()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::game::scores;

    #[test]
    fn what_is_called_solved_makes_the_point_under_every_rule() {
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(21);
        for name in crate::table::PRESETS {
            let coach = Coach::new(Table::preset(name).unwrap()).unwrap();
            for rule in Rule::ALL {
                let request = Request { rule, budget: Duration::from_secs(20), ..Request::default() };
                let layout = Layout::random(coach.table(), &mut rng);
                let advice = coach.recommend(&layout, &request).unwrap();
                assert!(advice.solved, "{name} {rule}");
                for cue in advice.alternatives.iter().map(|shot| &shot.cue).chain([&advice.cue]) {
                    assert!(scores(rule, coach.table(), &layout, cue));
                    cue.validate_tip(coach.table().miscue_limit).unwrap();
                }
            }
        }
    }

    #[test]
    fn the_same_request_gets_the_same_answer() {
        let coach = Coach::new(Table::default()).unwrap();
        let layout = Layout::opening(coach.table());
        let request = Request { rule: Rule::ThreeCushion, budget: Duration::from_secs(20), ..Request::default() };
        let cue = coach.recommend(&layout, &request).unwrap().cue;
        assert_eq!(coach.recommend(&layout, &request).unwrap().cue, cue);
    }

    #[test]
    fn without_time_there_is_still_an_attempt_and_it_is_not_called_a_solution() {
        let coach = Coach { table: Table::preset("thesis").unwrap(), policies: Vec::new() };
        let request = Request { rule: Rule::ThreeCushion, budget: Duration::ZERO, ..Request::default() };
        let advice = coach.recommend(&Layout::opening(coach.table()), &request).unwrap();
        advice.cue.validate().unwrap();
        assert!(!advice.solved && advice.alternatives.is_empty());
        assert_eq!(advice.simulations, 0);
    }

    #[test]
    fn a_cancelled_search_ends() {
        let coach = Coach { table: Table::default(), policies: Vec::new() };
        let request = Request { budget: Duration::from_secs(3600), rule: Rule::ThreeCushion, ..Request::default() };
        request.cancel.store(true, Ordering::Relaxed);
        let advice = coach.recommend(&Layout::opening(coach.table()), &request).unwrap();
        assert!(!advice.solved && advice.simulations == 0);
    }

    #[test]
    fn an_impossible_layout_is_refused() {
        let coach = Coach::new(Table::default()).unwrap();
        let layout = Layout::new([glam::DVec2::ZERO; 3]);
        assert!(matches!(coach.recommend(&layout, &Request::default()), Err(LayoutError::Overlap { .. })));
    }
}
