//! Several seeds: one after the other or side by side, and the spread between them.

use std::{
    io::Write,
    path::Path,
    sync::atomic::{AtomicUsize, Ordering},
    time::{Duration, Instant},
};

use super::{TrainOptions, abandon, failure, how_to_go_on, progress::Progress, spec::Read};
use crate::{
    commands::{Failure, output::tell},
    learning::run::{Ending, RunError, seeds::Group},
    printing,
};

/// Trains new runs with `seeds` seeds, `jobs` at a time.
pub fn start(read: Read, seeds: u64, jobs: u32, options: &TrainOptions<'_>) -> Result<(), Failure> {
    let Read { spec, weights, folder } = read;
    train(&Group::create(&folder, spec, seeds, weights).map_err(failure)?, jobs, options)
}

/// Goes on with the runs in `folder`.
pub fn resume(folder: &Path, jobs: u32, options: &TrainOptions<'_>) -> Result<(), Failure> {
    train(&Group::resume(folder).map_err(failure)?, jobs, options)
}

fn train(group: &Group, jobs: u32, options: &TrainOptions<'_>) -> Result<(), Failure> {
    let seeds: Vec<u64> = group.seeds().collect();
    let (next, begin) = (AtomicUsize::new(0), Instant::now());
    // A worker takes seeds until there are none, or until it is stopped. It returns what went wrong, and whether all its
    // runs are finished.
    let work = || {
        let (mut errors, mut finished) = (Vec::new(), true);
        while let Some(seed) = seeds.get(next.fetch_add(1, Ordering::Relaxed)) {
            let left = options.limit.map(|limit| limit.saturating_sub(begin.elapsed()));
            if (options.stop)() || left.is_some_and(|left| left.is_zero()) {
                finished = false;
                break;
            }
            match train_one(group, *seed, left, options) {
                Ok(done) => finished &= done,
                Err(error) => errors.push(format!("seed {seed}: {error}")),
            }
        }
        (errors, finished)
    };
    let outcomes: Vec<_> = std::thread::scope(|scope| {
        let workers: Vec<_> = (0..jobs).map(|_| scope.spawn(work)).collect();
        workers.into_iter().map(std::thread::ScopedJoinHandle::join).collect()
    });
    let spread = group.write_spread().map_err(failure)?;
    if let Some(spread) = spread.filter(|_| options.objective) {
        writeln!(printing::stdout(), "{}", spread.mean)?;
    } else if let Some(spread) = spread.filter(|_| !options.json) {
        let sd = spread.sd.map(|sd| format!(", standard deviation {sd:.4}")).unwrap_or_default();
        writeln!(
            printing::stdout(),
            "{}: mean {:.4}{sd}, {:.4} to {:.4} on held-out layouts, seeds: {}, after {} shots",
            group.folder().display(),
            spread.mean,
            spread.min,
            spread.max,
            spread.seeds,
            spread.shots
        )?;
    }
    let (mut errors, mut finished) = (Vec::new(), true);
    for outcome in outcomes {
        match outcome {
            Ok((wrong, done)) => {
                errors.extend(wrong);
                finished &= done;
            }
            Err(_) => errors.push("a thread ended in a defect of carom's".to_owned()),
        }
    }
    if !errors.is_empty() {
        return Err(Failure::failed(errors.join("; ")));
    }
    if finished { Ok(()) } else { Err(how_to_go_on(group.folder())) }
}

/// Trains the run with this seed and returns whether it is finished.
fn train_one(group: &Group, seed: u64, limit: Option<Duration>, options: &TrainOptions<'_>) -> Result<bool, RunError> {
    let (mut run, notices) = group.run(seed)?;
    for notice in notices {
        tell(format_args!("warning: seed {seed}: {notice}"));
    }
    if run.learner().is_finished() {
        return Ok(true);
    }
    let mut progress = Progress::new(&run, options.json, Some(seed));
    match run.train(&options.limits(limit), &mut progress)? {
        Ending::Finished(_) => Ok(true),
        Ending::Stopped(_) => Ok(false),
        Ending::Abandoned => abandon(run).map(|()| false),
    }
}
