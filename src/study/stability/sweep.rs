//! Many shots on all cores: the same shots and the same findings on every run, whatever the number of threads.

use std::{
    fmt,
    sync::{Mutex, PoisonError},
};

use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;

use super::{Figures, Finding, Limits, Shot, Trace, Violation, examine};
use crate::{
    platform::{parallel, threads},
    table::Table,
};

/// Shots that are drawn from one seed: a unit of work for a thread.
const CHUNK: u64 = 100;

/// How often a shot that is too slow is played again, since it may have been the machine: the least time counts.
const REPETITIONS: usize = 3;

/// Shots slower than this are not played again, s.
const TOO_SLOW_TO_REPEAT: f64 = 0.5;

/// Draws one shot.
pub type Generator = fn(&Table, &mut Xoshiro256PlusPlus) -> Shot;

/// What must hold of a shot besides the invariants; the error says what is wrong.
pub type Check = fn(&Table, &Shot, &Trace) -> Result<(), String>;

/// Shots to play and check.
#[derive(Clone, Debug)]
pub struct Sweep {
    /// The table.
    pub table: Table,
    /// What draws the shots.
    pub generator: Generator,
    /// What must hold besides, if anything.
    pub check: Option<Check>,
    /// How many.
    pub shots: u64,
    /// Seed of all of them.
    pub seed: u64,
    /// What counts as a violation on a table as people play on.
    pub limits: Limits,
}

/// How far a sweep is.
#[derive(Clone, Copy, Debug)]
pub struct Progress {
    /// Shots done.
    pub done: u64,
    /// Shots in all.
    pub of: u64,
    /// Findings so far.
    pub findings: u64,
}

impl fmt::Display for Progress {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{} of {} shots, {} findings", self.done, self.of, self.findings)
    }
}

/// What came of many shots.
#[derive(Clone, Debug, Default)]
pub struct Swept {
    /// The worst that was measured.
    pub figures: Figures,
    /// Shots that break something.
    pub findings: u64,
    /// The first of them, in the order in which they are drawn.
    pub first: Option<Finding>,
}

impl Swept {
    /// Adds what came of the shots that follow.
    #[must_use]
    pub fn and(mut self, later: Self) -> Self {
        self.figures.merge(&later.figures);
        Self { findings: self.findings + later.findings, first: self.first.or(later.first), ..self }
    }
}

impl Sweep {
    /// Plays and checks all shots on all cores. `watch` hears of the progress now and then.
    pub fn run(&self, watch: impl FnMut(Progress) + Send) -> Swept {
        let chunks: Vec<u64> = (0..self.shots.div_ceil(CHUNK)).collect();
        let watched = Mutex::new((Progress { done: 0, of: self.shots, findings: 0 }, watch));
        let swept = parallel::map(threads(), &chunks, |chunk| {
            let swept = self.chunk(*chunk);
            let (progress, watch) = &mut *watched.lock().unwrap_or_else(PoisonError::into_inner);
            progress.done += swept.figures.shots;
            progress.findings += swept.findings;
            watch(*progress);
            swept
        });
        swept.into_iter().fold(Swept::default(), Swept::and)
    }

    /// Plays and checks the shots that are drawn from one seed.
    fn chunk(&self, chunk: u64) -> Swept {
        let (mut trace, mut swept) = (Trace::new(&self.table), Swept::default());
        let limits = self.limits.on(&self.table);
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(self.seed ^ chunk.wrapping_mul(0x9E37_79B9_7F4A_7C15));
        let begin = chunk * CHUNK;
        for _ in begin..self.shots.min(begin + CHUNK) {
            let shot = (self.generator)(&self.table, &mut rng);
            let mut measured = examine(&self.table, &shot, &mut trace);
            // A shot that has been broken off has failed already.
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
    fn the_same_shots_are_played_whatever_thread_plays_them() {
        let run = || Figures { seconds: 0.0, ..sweep().run(|_| {}).figures };
        let figures = run();
        assert_eq!((figures.shots, figures), (1050, run()));
    }

    #[test]
    fn what_a_case_asks_besides_becomes_a_finding_and_the_first_that_is_drawn_is_kept() {
        let picky = Sweep { check: Some(|_, _, _| Err("not to my taste".to_owned())), ..sweep() };
        let mut last = None;
        let Swept { figures, findings, first } = picky.run(|progress| last = Some(progress));
        let Progress { done, of, findings: told } = last.unwrap();
        assert_eq!([figures.shots, findings, done, of, told], [1050; 5]);
        let first = first.unwrap();
        assert_eq!(first.shot, random::shot(&picky.table, &mut Xoshiro256PlusPlus::seed_from_u64(picky.seed)));
        assert_eq!(first.what, "not to my taste");
        let json = serde_json::to_value(&first).unwrap();
        assert!(json["layout"].is_array() && json["cue"]["theta_deg"].is_number(), "{json}");
        assert!(json["preset"] == sweep().table.name.as_str() && json.get("table").is_none(), "{json}");
    }
}
