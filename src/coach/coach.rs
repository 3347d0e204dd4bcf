//! The recommender: finds the shot that a given player makes most often, from a layout and a request.

use std::{
    sync::{Arc, OnceLock, atomic::AtomicBool},
    time::{Duration, Instant},
};

use super::{
    Improvement, Recommendation, Request, Shooter, Skill,
    clock::Clock,
    draws::{Draws, Worlds},
    first::FirstShots,
    judging::robust_answer,
    search::Search,
    trial::{Task, UNLIMITED_STEPS, with_unlimited_task},
};
use crate::{
    game::Rule,
    learning::Policy,
    physics::CueInputs,
    platform::parallel::Team,
    statistics::SuccessRate,
    table::{Layout, LayoutError, Table},
};

/// Minimum time for judging the answer, even after the budget is used up. If other programs delay a thread, the answer
/// would otherwise have no make probability.
const GRACE: Duration = Duration::from_millis(3);

/// A coach for one table. Cheap to share between threads.
#[derive(Clone, Debug)]
pub struct Coach {
    table: Table,
    policies: Policies,
}

/// The policies that a coach can query.
#[derive(Clone, Debug)]
enum Policies {
    None,
    /// One policy for all rules: a shot that makes a point under any rule is a good start for a search.
    One(Box<Policy>),
    /// The policies bundled for the table, each loaded on first use. Indexed by rule, then by whether the player makes
    /// errors.
    Bundled(Arc<[[OnceLock<Option<Policy>>; 2]; Rule::ALL.len()]>),
}

impl Coach {
    /// Creates a coach with the policies that are bundled for this table. Without any, it uses the search alone.
    pub fn new(table: Table) -> Self {
        Self { table, policies: Policies::Bundled(Arc::default()) }
    }

    /// Creates a coach without a policy: it uses the search alone.
    pub const fn without_policy(table: Table) -> Self {
        Self { table, policies: Policies::None }
    }

    /// Replaces the policies by one that is used for all rules.
    #[must_use]
    pub fn with_policy(self, policy: Policy) -> Self {
        Self { policies: Policies::One(Box::new(policy)), ..self }
    }

    /// Returns the policy for `rule` and a player of this skill.
    pub fn policy(&self, rule: Rule, skill: &Skill) -> Option<&Policy> {
        match &self.policies {
            Policies::None => None,
            Policies::One(policy) => Some(policy),
            Policies::Bundled(policies) => {
                let makes_errors = !skill.is_perfect();
                // A test ensures that every bundled policy can be read.
                let read = || Policy::bundled_for(&self.table, rule, makes_errors)?.ok();
                policies[rule as usize][usize::from(makes_errors)].get_or_init(read).as_ref()
            }
        }
    }

    /// Returns the table of this coach.
    pub const fn table(&self) -> &Table {
        &self.table
    }

    /// Returns the policy's own shot under `rule` for a player of this skill, unchecked; `None` if there is no policy.
    pub fn policy_shot(&self, layout: &Layout, rule: Rule, skill: &Skill) -> Option<CueInputs> {
        self.policy(rule, skill).map(|policy| policy.propose(&self.table, layout, skill))
    }

    /// Searches for the shot that the player makes most often. With [`Request::plan`], the ease of the next shot counts
    /// too. The shot never exceeds the table's miscue limit.
    ///
    /// # Errors
    /// Fails if the layout is impossible.
    pub fn recommend(&self, layout: &Layout, request: &Request) -> Result<Recommendation, LayoutError> {
        self.recommend_with_progress(layout, request, |_| {})
    }

    /// Like [`recommend`](Self::recommend), and calls `on_improvement` on this thread as soon as a better shot is found.
    ///
    /// # Errors
    /// Fails if the layout is impossible.
    pub fn recommend_with_progress(
        &self,
        layout: &Layout,
        request: &Request,
        on_improvement: impl FnMut(&Improvement),
    ) -> Result<Recommendation, LayoutError> {
        layout.validate(&self.table)?;
        Ok(Team::awake(request.threads, |team| self.answer(layout, request, team, on_improvement)))
    }

    fn answer(
        &self,
        layout: &Layout,
        request: &Request,
        team: &Team,
        mut on_improvement: impl FnMut(&Improvement),
    ) -> Recommendation {
        let clock = Clock::start(request.budget, request.simulations, &request.cancel);
        let doubt = request.shooter().effective_doubt();
        let [worlds, level] = [Worlds::new, Worlds::level].map(|worlds| worlds(&self.table, layout, doubt));
        let task = Task::new(&self.table, layout, request.rule, request.skill, &level, &clock);
        let task = Task { jumps: request.jumps, first: request.first, ..task };
        let policy = self.policy(request.rule, &request.skill);
        let proposals =
            policy.map_or_else(Vec::new, |policy| policy.proposals_by(team, &self.table, layout, &request.skill));
        let strokes: Vec<CueInputs> = proposals.iter().map(|proposal| proposal.cue).collect();
        let found = FirstShots::find(task, &strokes, &request.former, request.seed);
        let answer = if request.skill.is_perfect() || found.solutions.is_empty() {
            found.answer()
        } else {
            let mut last_reported = None;
            let search = Search::new(task, request.plan, team, request.seed);
            let pool = search.run(&strokes, &found.solutions, &mut |leader| {
                // The same shot with more attempts is not an improvement.
                if last_reported.replace(leader.shot.cue) != Some(leader.shot.cue) {
                    let make_probability = leader.own_rate.to_success_rate();
                    on_improvement(&Improvement { cue: leader.shot.cue, make_probability });
                }
            });
            let deadline = task.deadline.max(Instant::now() + GRACE);
            robust_answer(
                &found,
                pool,
                &Task { worlds: &worlds, max_contact_steps: UNLIMITED_STEPS, deadline, ..task },
                request,
                team,
            )
        };
        Recommendation { simulations: clock.simulations(), elapsed: clock.elapsed(), ..answer }
    }
}

/// Estimates the share of `attempts` at `cue` that make a point, with its confidence interval: a plain Monte Carlo
/// estimate. The same seed draws the same attempts for every shot. A perfect player has no doubts.
pub fn make_probability(
    shooter: impl Into<Shooter>,
    rule: Rule,
    table: &Table,
    layout: &Layout,
    cue: &CueInputs,
    attempts: usize,
    seed: u64,
) -> SuccessRate {
    with_unlimited_task(table, layout, rule, shooter.into(), UNLIMITED_STEPS, &AtomicBool::new(false), |task| {
        let attempts = task.attempts(cue, &Draws::independent(attempts, task.worlds, seed));
        SuccessRate::new(attempts.made, attempts.tried)
    })
}
