//! Plays and checks many shots on all cores. The shots and findings are the same on every run, for any number of threads.

use std::{
    fmt,
    sync::{Mutex, PoisonError},
};

use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;

use super::{Figures, Finding, Limits, Shot, Trace, Violation, examine};
use crate::{
    platform::{parallel, thread_count},
    table::Table,
};

/// Number of shots drawn from one seed: the unit of work of a thread.
const CHUNK: u64 = 100;

/// Number of repetitions of a slow shot, as the machine may be the cause: the minimum time counts.
const REPETITIONS: usize = 3;

/// Shots slower than this are not repeated, s.
const TOO_SLOW_TO_REPEAT: f64 = 0.5;

/// Draws one shot.
pub type Generator = fn(&Table, &mut Xoshiro256PlusPlus) -> Shot;

/// A check in addition to the invariants; the error describes the violation.
pub type Check = fn(&Table, &Shot, &Trace) -> Result<(), String>;

/// Shots to play and check.
#[derive(Clone, Debug)]
pub struct Sweep {
    /// The table.
    pub table: Table,
    /// The generator of the shots.
    pub generator: Generator,
    /// An additional check, if any.
    pub check: Option<Check>,
    /// Number of shots.
    pub shots: u64,
    /// Seed of all shots.
    pub seed: u64,
    /// Limits of the invariants on a table of usual size.
    pub limits: Limits,
}

/// Progress of a sweep.
#[derive(Clone, Copy, Debug)]
pub struct Progress {
    /// Shots done.
    pub done: u64,
    /// Total number of shots.
    pub total: u64,
    /// Findings so far.
    pub findings: u64,
}

impl fmt::Display for Progress {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{} of {} shots, {} findings", self.done, self.total, self.findings)
    }
}

/// Result of a sweep.
#[derive(Clone, Debug, Default)]
pub struct SweepResult {
    /// The largest errors.
    pub figures: Figures,
    /// Number of shots with violations.
    pub findings: u64,
    /// The first of them, in the order of drawing.
    pub first: Option<Finding>,
}

impl SweepResult {
    /// Adds the result of later shots.
    #[must_use]
    pub fn merge(mut self, later: Self) -> Self {
        self.figures.merge(&later.figures);
        Self { findings: self.findings + later.findings, first: self.first.or(later.first), ..self }
    }
}

impl Sweep {
    /// Plays and checks all shots on all cores. `watch` receives the progress from time to time.
    pub fn run(&self, watch: impl FnMut(Progress) + Send) -> SweepResult {
        let chunks: Vec<u64> = (0..self.shots.div_ceil(CHUNK)).collect();
        let watched = Mutex::new((Progress { done: 0, total: self.shots, findings: 0 }, watch));
        let swept = parallel::map(thread_count(), &chunks, |chunk| {
            let swept = self.chunk(*chunk);
            let (progress, watch) = &mut *watched.lock().unwrap_or_else(PoisonError::into_inner);
            progress.done += swept.figures.shots;
            progress.findings += swept.findings;
            watch(*progress);
            swept
        });
        swept.into_iter().fold(SweepResult::default(), SweepResult::merge)
    }

    /// Plays and checks the shots drawn from one seed.
    fn chunk(&self, chunk: u64) -> SweepResult {
        let (mut trace, mut swept) = (Trace::new(&self.table), SweepResult::default());
        let limits = self.limits.on(&self.table);
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(self.seed ^ chunk.wrapping_mul(0x9E37_79B9_7F4A_7C15));
        let begin = chunk * CHUNK;
        for _ in begin..self.shots.min(begin + CHUNK) {
            let shot = (self.generator)(&self.table, &mut rng);
            let mut measured = examine(&self.table, &shot, &mut trace);
            // An aborted shot has failed already.
            let check = self.check.filter(|_| trace.finished);
            let also = check.map_or(Ok(()), |check| check(&self.table, &shot, &trace));
            for _ in 0..REPETITIONS {
                if !(limits.seconds..TOO_SLOW_TO_REPEAT).contains(&measured.seconds) {
                    break;
                }
                trace.play(&self.table, &shot);
                measured.seconds = measured.seconds.min(trace.seconds);
            }
            let mut violations = measured.violations(&limits);
            violations.extend(also.err().map(Violation::Wrong));
            if !violations.is_empty() {
                swept.findings += 1;
                swept.first.get_or_insert_with(|| Finding::new(&self.table, &shot, &measured, violations));
            }
            swept.figures.merge(&measured);
        }
        swept
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::stability::random;

    fn sweep() -> Sweep {
        Sweep {
            table: Table::preset("textbook").unwrap(),
            generator: random::shot,
            check: None,
            shots: 1050,
            seed: 3,
            limits: Limits::STRICT,
        }
    }

    #[test]
    fn shots_of_a_sweep_do_not_depend_on_threads() {
        let run = || Figures { seconds: 0.0, ..sweep().run(|_| {}).figures };
        let figures = run();
        assert_eq!((figures.shots, figures), (1050, run()));
    }

    #[test]
    fn failed_check_is_a_finding_and_the_first_is_kept() {
        let picky = Sweep { check: Some(|_, _, _| Err("not to my taste".to_owned())), ..sweep() };
        let mut last = None;
        let SweepResult { figures, findings, first } = picky.run(|progress| last = Some(progress));
        let Progress { done, total, findings: reported } = last.unwrap();
        assert_eq!([figures.shots, findings, done, total, reported], [1050; 5]);
        let first = first.unwrap();
        assert_eq!(first.shot, random::shot(&picky.table, &mut Xoshiro256PlusPlus::seed_from_u64(picky.seed)));
        assert_eq!(first.description, "not to my taste");
        let json = serde_json::to_value(&first).unwrap();
        assert!(json["layout"].is_array() && json["cue"]["theta_deg"].is_number(), "{json}");
        assert!(json["preset"] == sweep().table.name.as_str() && json.get("table").is_none(), "{json}");
    }
}
