//! Training with several seeds: sequential or parallel, and the spread between them.

use std::{
    io::Write,
    path::Path,
    time::{Duration, Instant},
};

use super::{TrainOptions, abandon, failure, how_to_resume, progress::Progress, spec::TrainingRequest};
use crate::{
    commands::{Failure, output::print_note},
    learning::run::{
        Ending, RunError,
        seeds::{Group, Spread},
    },
    platform::parallel,
    printing,
};

/// Trains new runs with `seeds` seeds, `jobs` at a time.
pub fn start(request: &TrainingRequest, seeds: u64, jobs: u32, options: &TrainOptions<'_>) -> Result<(), Failure> {
    let TrainingRequest { spec, weights, .. } = request;
    let group =
        request.begin(|folder| Group::create(folder, spec.clone(), seeds, weights.as_ref())).map_err(failure)?;
    train(&group, jobs, options)
}

/// Resumes the runs in `folder`.
pub fn resume(folder: &Path, jobs: u32, options: &TrainOptions<'_>) -> Result<(), Failure> {
    train(&Group::resume(folder).map_err(failure)?, jobs, options)
}

fn train(group: &Group, jobs: u32, options: &TrainOptions<'_>) -> Result<(), Failure> {
    let seeds: Vec<u64> = group.seeds().collect();
    let begin = Instant::now();
    // Each outcome: whether the seed's run is finished, or the error. After the time limit or a signal, no other run is started.
    let outcomes = parallel::map(jobs as usize, &seeds, |seed| {
        let left = options.limit.map(|limit| limit.saturating_sub(begin.elapsed()));
        if (options.stop)() || left.is_some_and(|left| left.is_zero()) {
            return Ok(false);
        }
        train_one(group, *seed, left, options).map_err(|error| format!("seed {seed}: {error}"))
    });
    let finished = outcomes.iter().all(|outcome| *outcome == Ok(true));
    let mut errors: Vec<String> = outcomes.into_iter().filter_map(Result::err).collect();
    // Ignore output errors at first: the caller must learn about failed or incomplete runs from the exit code.
    let printed = match group.write_spread() {
        Ok(spread) => print_spread(group, spread, finished, options),
        Err(error) => {
            errors.push(error.to_string());
            Ok(())
        }
    };
    if !errors.is_empty() {
        return Err(Failure::failed(errors.join("; ")));
    }
    if finished { printed } else { Err(how_to_resume(group.folder())) }
}

/// Prints the results of the seeds.
fn print_spread(
    group: &Group,
    spread: Option<Spread>,
    finished: bool,
    options: &TrainOptions<'_>,
) -> Result<(), Failure> {
    if options.objective {
        // Seeds at different numbers of shots cannot be compared with those of another run.
        let last = spread.filter(|spread| finished && spread.seeds == group.seeds().count());
        if let Some(spread) = last {
            writeln!(printing::stdout(), "{}", spread.mean)?;
        } else if finished {
            return Err(Failure::failed("there is no objective: the metrics of some seeds lack the last measurement"));
        }
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
    Ok(())
}

/// Trains the run with this seed, and returns whether it is finished.
fn train_one(group: &Group, seed: u64, limit: Option<Duration>, options: &TrainOptions<'_>) -> Result<bool, RunError> {
    let (mut run, notices) = group.run(seed)?;
    for notice in notices {
        print_note(format_args!("warning: seed {seed}: {notice}"));
    }
    let mut progress = Progress::new(&run, options.json, Some(seed));
    progress.repeat_result(&run)?;
    let ending = run.train(&options.limits(limit), &mut |report| progress.report(report))?;
    if let Err(error) = progress.close() {
        print_note(format_args!("warning: seed {seed}: the output cannot be written: {error}"));
    }
    match ending {
        Ending::Finished(_) => Ok(true),
        Ending::Stopped(_) => Ok(false),
        Ending::Abandoned => abandon(run).map(|removed| {
            print_note(removed);
            false
        }),
    }
}
