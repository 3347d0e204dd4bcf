//! Runs queries to the coach; on a worker thread, so that the screen never waits.

use std::{
    ops::Range,
    panic::{AssertUnwindSafe, catch_unwind},
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
    time::{Duration, Instant},
};

use crate::{
    coach::{
        Coach, Improvement, Input, Recommendation, Request, Sensitivity, Skill, Source, Why, judge, scatter,
        systems::guide, why,
    },
    learning::Policy,
    physics::CueInputs,
    simulation::Recording,
    statistics::SuccessRate,
    table::{Layout, Table},
    terminal::{Advice, CoachQuery, Effort, Proposal, Shot, ShotAnalysis},
};

/// Smallest interval between two reports of better shots. Each report moves all paths on the screen, which is 3 KB on a slow link, and
/// nobody can follow more of them.
const REPORT_INTERVAL: Duration = Duration::from_millis(250);

/// Time budget of a search that ends after a number of simulations.
const UNLIMITED_TIME: Duration = Duration::from_secs(3600);

/// Columns and rows of a map: three sub-pixels a row on the largest panels.
const CELLS: usize = 61;

/// Half the width of the map of direction and speed, in the player's standard errors; hardly any stroke is off by more than three. A
/// perfect player gets the map of an expert.
const REACH: f64 = 5.0;

/// Size of the map of tips relative to the miscue limit, so that the limit is visible.
const RIM: f64 = 1.1;

/// Number of attempts whose final positions are shown: enough for the shape of the cloud, few enough to see through.
const ATTEMPTS: usize = 100;

/// A query to the coach.
#[derive(Clone, Debug)]
pub struct CoachJob {
    /// Identifies the answers to this query.
    pub id: u64,
    /// The table.
    pub table: Table,
    /// Positions of the balls.
    pub layout: Layout,
    /// The policy and the terms of the query.
    pub query: CoachQuery,
    /// Shots of the coach's earlier answer to the same query.
    pub former: Vec<CueInputs>,
    /// The shot to analyse; `None` to search for one.
    pub shot: Option<CueInputs>,
    /// The recommendation, if the answer has to explain why its shot is best.
    pub found: Option<Arc<Recommendation>>,
    /// A stroke whose success rate is to be known, and the range of attempts at it, as counted by [`judge`]. Without a `shot`, nothing else
    /// is computed.
    pub stroke: Option<(CueInputs, Range<usize>)>,
    /// Time that the coach may think.
    pub budget: Duration,
    /// Seed of the coach's random numbers.
    pub seed: u64,
    /// Set when the answer is no longer needed.
    pub cancel: Arc<AtomicBool>,
}

/// An answer of the coach.
#[derive(Clone, Debug)]
pub struct CoachAnswer {
    /// Identifier of the query.
    pub id: u64,
    /// Content of the answer.
    pub event: CoachEvent,
}

/// Content of an answer; a query may get several.
#[derive(Clone, Debug)]
pub enum CoachEvent {
    /// A better shot than all before; the search continues.
    Better(Proposal),
    /// The result of the search.
    Advice(Advice),
    /// Why there is no recommendation.
    Refused(String),
    /// Why the recommended shot is best.
    Why(Box<Why>),
    /// The analysis of a shot.
    Analysis(Arc<ShotAnalysis>),
    /// The success rate of [`CoachJob::stroke`].
    StrokeRated(SuccessRate),
    /// The end of an analysis: the advice for the layout after the shot, if any.
    Next(Option<Advice>),
}

/// The coach, created at the first query: reading its networks must not delay the first frame.
#[derive(Debug, Default)]
pub struct CoachWorker {
    coach: Option<(CoachQuery, Coach)>,
    /// Number of simulations after which a search ends, instead of a time.
    simulations: Option<u64>,
}

impl CoachWorker {
    /// Creates a worker whose answers do not depend on time: each search ends after `simulations` simulations.
    pub const fn with_simulation_limit(simulations: u64) -> Self {
        Self { coach: None, simulations: Some(simulations) }
    }

    /// Answers a query on this thread; `report` receives each part as soon as it is known. A panic becomes an error message.
    pub fn answer(&mut self, job: &CoachJob, mut report: impl FnMut(CoachAnswer)) {
        let mut report = |event| report(CoachAnswer { id: job.id, event });
        if let Some((cue, attempts)) = &job.stroke {
            let CoachJob { table, layout, query, seed, .. } = job;
            let rate = || judge(query.shooter(), query.rule, table, layout, cue, attempts.clone(), *seed);
            // On failure the rate stays unknown.
            if let Ok(made) = catch_unwind(AssertUnwindSafe(rate)) {
                report(CoachEvent::StrokeRated(made));
            }
            if job.shot.is_none() {
                return;
            }
        }
        if let Some(cue) = job.shot {
            let analysis = || self.analyze(job, &cue, &mut report);
            // The user did not request the analysis, so a failure is silent.
            let next = catch_unwind(AssertUnwindSafe(analysis)).unwrap_or(None);
            return report(CoachEvent::Next(next));
        }
        let found = || self.advice(job, &job.layout, &mut |proposal| report(CoachEvent::Better(proposal)));
        let found = catch_unwind(AssertUnwindSafe(found))
            .unwrap_or_else(|_| Err("the coach failed on this layout; move a ball a little and ask again".to_owned()));
        report(found.map_or_else(CoachEvent::Refused, CoachEvent::Advice));
    }

    fn advice(&mut self, job: &CoachJob, layout: &Layout, report: &mut dyn FnMut(Proposal)) -> Result<Advice, String> {
        let CoachQuery { rule, skill, doubt, plan, jumps, first, .. } = job.query;
        let request = Request {
            rule,
            skill,
            doubt,
            plan,
            jumps,
            first,
            budget: if self.simulations.is_some() { UNLIMITED_TIME } else { job.budget },
            simulations: self.simulations.unwrap_or(u64::MAX),
            seed: job.seed,
            former: job.former.clone(),
            cancel: Arc::clone(&job.cancel),
            ..Request::default()
        };
        let (is_hurried, mut last_report) = (self.simulations.is_none(), None);
        let report = |better: &Improvement| {
            if is_hurried && last_report.is_some_and(|last_report: Instant| last_report.elapsed() < REPORT_INTERVAL) {
                return;
            }
            last_report = Some(Instant::now());
            // A shot that cannot be displayed is not reported; the answer will say why.
            let Ok(shot) = Shot::new(&job.table, layout, better.cue, true, "search") else { return };
            report(Proposal {
                shot: Arc::new(shot),
                made: Some(better.make_probability),
                risk: None,
                next: None,
                is_early: true,
            });
        };
        let found =
            self.coach(job).recommend_with_progress(layout, &request, report).map_err(|error| error.to_string())?;
        proposals(job, layout, found)
    }

    /// Analyses a shot, then the layout after it.
    fn analyze(&mut self, job: &CoachJob, cue: &CueInputs, report: &mut dyn FnMut(CoachEvent)) -> Option<Advice> {
        if let Some(found) = job.found.as_deref().filter(|_| !job.cancel.load(Ordering::Relaxed)) {
            let CoachJob { table, layout, query, .. } = job;
            let why = why(query.shooter(), query.rule, table, layout, found, job.seed);
            // If no reason is found, it is left out.
            if let Ok(why) = why {
                report(CoachEvent::Why(Box::new(why)));
            }
        }
        let recording = Recording::new(&job.table, &job.layout, cue).ok()?;
        let analysis = analyze(job, cue, &recording)?;
        let makes_point = analysis.margins.is_some();
        report(CoachEvent::Analysis(Arc::new(analysis)));
        // After a miss it is the opponent's turn.
        if !makes_point {
            return None;
        }
        self.advice(job, &recording.final_layout(), &mut |_| {}).ok()
    }

    /// The coach for the query's table and policy.
    fn coach(&mut self, job: &CoachJob) -> &Coach {
        let fits =
            |(query, coach): &(CoachQuery, Coach)| *coach.table() == job.table && query.has_policy_of(&job.query);
        let known = self.coach.take().filter(fits).unwrap_or_else(|| {
            let bundled = Coach::new(job.table.clone());
            let coach = match &job.query.policy {
                Some((_, policy)) => bundled.with_policy(Policy::clone(policy)),
                None => bundled,
            };
            (job.query.clone(), coach)
        });
        &self.coach.insert(known).1
    }
}

/// Converts the coach's result for display.
fn proposals(job: &CoachJob, layout: &Layout, found: Recommendation) -> Result<Advice, String> {
    let proposal = |cue, solved, source: Source, made, risk, next| {
        let shot = Shot::new(&job.table, layout, cue, solved, source.to_string()).map_err(|error| error.to_string())?;
        Ok(Proposal { shot: Arc::new(shot), made, risk, next, is_early: false })
    };
    let best =
        proposal(found.cue, found.solved, found.source, found.make_probability, found.risk, found.next_probability);
    let others = found
        .alternatives
        .iter()
        .map(|other| proposal(other.cue, true, other.source, other.make_probability, None, other.next_probability));
    let proposals = std::iter::once(best).chain(others).collect::<Result<_, String>>()?;
    let effort = Some(Effort { simulations: found.simulations, elapsed: found.elapsed });
    Ok(Advice { proposals, seed: job.seed, effort, found: found.solved.then(|| Arc::new(found)) })
}

/// Analyses a recorded shot; stops between two parts if the answer is no longer needed.
fn analyze(job: &CoachJob, cue: &CueInputs, recording: &Recording) -> Option<ShotAnalysis> {
    let CoachJob { table, layout, query, .. } = job;
    let CoachQuery { rule, skill, .. } = query;
    let sensitivity = Sensitivity::new(*rule, table, layout, query.shooter().effective_doubt());
    let unless_cancelled = || (!job.cancel.load(Ordering::Relaxed)).then_some(());
    let margins = sensitivity.margins(cue);
    unless_cancelled()?;
    let centre = CueInputs { a: 0.0, b: 0.0, ..*cue };
    let face = 1e3 * table.radius * RIM * table.miscue_limit.sqrt();
    let tip = sensitivity.map(cue, &centre, (Input::Side, face), (Input::Height, face), CELLS);
    unless_cancelled()?;
    let hand = skill.at(cue);
    let usual = if skill.is_perfect() { Skill::EXPERT } else { hand };
    let span = (Input::Direction, REACH * usual.phi.to_degrees());
    let aim = sensitivity.map(cue, cue, span, (Input::Speed, REACH * usual.speed), CELLS);
    unless_cancelled()?;
    let scatter = scatter(query.shooter(), *rule, table, layout, cue, ATTEMPTS, job.seed, &job.cancel);
    let system = margins.and_then(|_| guide(table, recording));
    unless_cancelled().map(|()| ShotAnalysis { margins, tip, aim, hand, scatter, system })
}
