//! Many shots on all cores, watched over: the same shots on every run, whatever the number of threads.

use std::{
    fmt,
    sync::{
        Arc, Mutex, PoisonError,
        atomic::{AtomicBool, AtomicU64, Ordering},
        mpsc::{self, RecvTimeoutError},
    },
    thread,
    time::{Duration, Instant},
};

use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;

use super::{Figures, Finding, Limits, Shot, Trace, Violation, examine, finding::HANG};
use crate::table::Table;

/// Shots that are drawn from one seed: a unit of work for a thread.
const CHUNK: u64 = 100;

/// How often the watch looks after the threads.
const WATCH_EVERY: Duration = Duration::from_millis(500);

/// How long it listens for news before it sees whether all threads have gone home.
const LISTEN: Duration = Duration::from_millis(5);

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

/// What a thread is busy with.
#[derive(Default)]
struct Desk {
    busy: Mutex<Option<(Instant, Shot)>>,
    given_up: AtomicBool,
}

/// What all threads share.
struct Work {
    sweep: Sweep,
    next_chunk: AtomicU64,
}

enum Message {
    Chunk(Figures),
    Finding(Box<Finding>),
}

impl fmt::Display for Progress {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{} of {} shots, {} findings", self.done, self.of, self.findings)
    }
}

impl Sweep {
    /// Plays and checks all shots on all cores. `watch` hears of every finding at once and of the progress now and then. A shot
    /// that hangs becomes a finding and costs a thread, which another replaces.
    pub fn run(&self, mut watch: impl FnMut(Progress, Option<&Finding>)) -> Figures {
        let work = Arc::new(Work { sweep: self.clone(), next_chunk: AtomicU64::new(0) });
        let (sender, receiver) = mpsc::channel();
        let threads = thread::available_parallelism().map_or(1, std::num::NonZero::get);
        let start = |work: &Arc<Work>| {
            let (work, sender, desk) = (Arc::clone(work), sender.clone(), Arc::new(Desk::default()));
            let own = Arc::clone(&desk);
            (thread::spawn(move || work.through(&own, &sender)), desk)
        };
        let mut workers: Vec<_> = (0..threads).map(|_| start(&work)).collect();
        let (mut figures, mut findings) = (Figures::default(), 0_u64);
        let mut looked = Instant::now();
        loop {
            let message = receiver.recv_timeout(LISTEN);
            let progress = |figures: &Figures, findings| Progress { done: figures.shots, of: self.shots, findings };
            match message {
                Ok(Message::Chunk(chunk)) => {
                    figures.merge(&chunk);
                    watch(progress(&figures, findings), None);
                }
                Ok(Message::Finding(finding)) => {
                    findings += 1;
                    watch(progress(&figures, findings), Some(&finding));
                }
                Err(RecvTimeoutError::Timeout) if workers.iter().all(|(thread, _)| thread.is_finished()) => break,
                Err(RecvTimeoutError::Timeout | RecvTimeoutError::Disconnected) => {}
            }
            if looked.elapsed() >= WATCH_EVERY {
                looked = Instant::now();
                for place in &mut workers {
                    if let Some(shot) = place.1.hangs() {
                        let finding = Finding::hang(&self.table, &shot);
                        figures.merge(&Figures {
                            shots: 1,
                            unfinished: 1,
                            seconds: f64::INFINITY,
                            ..Figures::default()
                        });
                        findings += 1;
                        watch(progress(&figures, findings), Some(&finding));
                        place.1.given_up.store(true, Ordering::Relaxed);
                        *place = start(&work);
                    }
                }
            }
        }
        figures
    }
}

impl Desk {
    /// The shot that this thread has been busy with for too long.
    fn hangs(&self) -> Option<Shot> {
        let busy = self.busy.lock().unwrap_or_else(PoisonError::into_inner);
        busy.and_then(|(since, shot)| (since.elapsed().as_secs_f64() > HANG).then_some(shot))
    }

    fn set(&self, busy: Option<(Instant, Shot)>) {
        *self.busy.lock().unwrap_or_else(PoisonError::into_inner) = busy;
    }
}

impl Work {
    /// A thread's work, chunk by chunk.
    fn through(&self, desk: &Desk, sender: &mpsc::Sender<Message>) {
        let sweep = &self.sweep;
        let mut trace = Trace::new(&sweep.table);
        let limits = sweep.limits.on(&sweep.table);
        loop {
            let chunk = self.next_chunk.fetch_add(1, Ordering::Relaxed);
            let begin = chunk * CHUNK;
            if begin >= sweep.shots {
                return;
            }
            let mut rng = Xoshiro256PlusPlus::seed_from_u64(sweep.seed ^ chunk.wrapping_mul(0x9E37_79B9_7F4A_7C15));
            let mut figures = Figures::default();
            for _ in begin..sweep.shots.min(begin + CHUNK) {
                let shot = (sweep.generator)(&sweep.table, &mut rng);
                desk.set(Some((Instant::now(), shot)));
                let mut measured = examine(&sweep.table, &shot, &mut trace);
                // A shot that has been broken off has failed already.
                let check = sweep.check.filter(|_| trace.finished);
                let also = check.map_or(Ok(()), |check| check(&sweep.table, &shot, &trace));
                for _ in 0..REPETITIONS {
                    if !(limits.seconds..TOO_SLOW_TO_REPEAT).contains(&measured.seconds) {
                        break;
                    }
                    trace.play(&sweep.table, &shot);
                    measured.seconds = measured.seconds.min(trace.seconds);
                }
                if desk.given_up.load(Ordering::Relaxed) {
                    return;
                }
                let mut violations = measured.violations(&limits);
                violations.extend(also.err().map(Violation::Wrong));
                if !violations.is_empty()
                    && sender
                        .send(Message::Finding(Box::new(Finding::new(&sweep.table, &shot, &measured, violations))))
                        .is_err()
                {
                    return;
                }
                figures.merge(&measured);
            }
            desk.set(None);
            if sender.send(Message::Chunk(figures)).is_err() {
                return;
            }
        }
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
        let run = || Figures { seconds: 0.0, ..sweep().run(|_, _| {}) };
        let figures = run();
        assert_eq!((figures.shots, figures), (1050, run()));
    }

    #[test]
    fn what_a_case_asks_besides_becomes_a_finding() {
        let picky = Sweep { check: Some(|_, _, _| Err("not to my taste".to_owned())), shots: 7, ..sweep() };
        let mut found = Vec::new();
        picky.run(|_, finding| found.extend(finding.cloned()));
        assert_eq!(found.len(), 7);
        assert!(found.iter().all(|finding| finding.what == "not to my taste"));
        let json = serde_json::to_value(&found[0]).unwrap();
        assert!(json["layout"].is_array() && json["cue"]["theta_deg"].is_number(), "{json}");
        assert!(json["preset"] == sweep().table.name.as_str() && json.get("table").is_none(), "{json}");
    }
}
