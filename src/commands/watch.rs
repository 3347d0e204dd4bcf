//! `carom watch`: follows a training run of this or another process.

use std::{
    io::{self, Write},
    path::{Path, PathBuf},
    sync::atomic::Ordering,
    thread,
    time::{Duration, Instant},
};

use super::{
    Failure,
    lookup::{LATEST, existing_run},
    output::{json_line, print_note},
    train::{format_record, print_runs},
};
use crate::{
    learning::run::{
        contains_run,
        follow::{Condition, Followed, Follower},
        metrics::Record,
        status::Phase,
    },
    platform::stop_on_signal,
    printing::{self, OneLine, shell_word},
    terminal,
};

/// Time between two reads of the run's files.
const INTERVAL: Duration = Duration::from_millis(200);

/// Time for which a run must appear to be over before that is believed.
const GRACE: Duration = Duration::from_secs(1);

/// Watch a training run, live or after its end.
///
/// On a terminal the training screen opens, whose keys can pause and stop the run. Elsewhere a line is printed for every measurement until
/// the run ends. Watching only reads the files of the run, and leaving never disturbs it.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The run: its folder, its name among the user's runs, or "latest". Without it, or with a folder of several runs, a list to choose
    /// from is shown.
    run: Option<PathBuf>,
    /// Print plain lines, even on a terminal.
    #[arg(long)]
    plain: bool,
    /// Print every line of metrics as JSON to standard output, from the first one on.
    #[arg(long)]
    json: bool,
}

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let folder = args.run.as_deref().map(existing_run).transpose()?;
    let is_run = folder.as_deref().is_some_and(contains_run);
    if !args.plain && !args.json && terminal::is_there() {
        return terminal::watch(folder.as_deref().filter(|_| is_run), folder.as_deref().filter(|_| !is_run))
            .map_err(Failure::wrong_input);
    }
    match folder {
        Some(folder) if is_run => {
            if args.run.as_deref() == Some(Path::new(LATEST)) {
                print_note(format_args!("watching the run in {}", folder.display()));
            }
            follow(&folder, args.json)
        }
        folder => {
            if print_runs(folder.as_deref(), args.json)? {
                print_note(match folder {
                    None => "choose one of them: carom watch NAME, or carom watch latest".to_owned(),
                    Some(folder) => {
                        let name = folder.join("NAME");
                        format!("choose one of them: carom watch {}", shell_word(&name.to_string_lossy()))
                    }
                });
            }
            Ok(())
        }
    }
}

/// Prints the progress of the run until it ends.
fn follow(folder: &Path, json: bool) -> Result<(), Failure> {
    let stop = stop_on_signal(None).map_err(Failure::failed)?;
    let (mut follower, mut followed) = (Follower::new(folder), Followed::new(folder));
    let (mut before, mut over) = (Condition::Unknown, None::<Instant>);
    // A run that resumes from an earlier checkpoint writes the same lines again; they are printed only once.
    let mut printed = 0;
    while !stop.load(Ordering::Relaxed) {
        if let Some(update) = follower.poll() {
            if update.config.is_some() {
                printed = 0;
            }
            for record in update.records.iter().filter(|record| record.shots > printed) {
                print(record, json)?;
            }
            printed = update.records.last().map_or(printed, |record| record.shots.max(printed));
            for notice in update.notices.iter().flatten() {
                print_note(format_args!("note: {}", OneLine(notice)));
            }
            followed.apply(update);
        }
        let condition = followed.condition;
        // A run that was just resumed appears to be over until it updates its status.
        over = condition.is_over().then(|| over.unwrap_or_else(Instant::now));
        let is_settled = over.is_none_or(|since| since.elapsed() >= GRACE);
        // A measurement is already reported by its own line.
        if is_settled && condition != Condition::InPhase(Phase::Measuring) && !condition.is_like(before) {
            before = condition;
            print_note(OneLine(followed.sentence()));
        }
        if over.is_some() && is_settled {
            break;
        }
        thread::sleep(INTERVAL);
    }
    let is_stopped = followed.status.as_ref().is_some_and(|status| status.phase == Phase::Stopped);
    match followed.condition {
        // Stopped and deleted at a user's request.
        Condition::Removed if is_stopped => Ok(()),
        Condition::Died | Condition::Removed | Condition::InPhase(Phase::Failed) => {
            Err(Failure::failed(format_args!("the run did not end well: {}", followed.condition)))
        }
        _ => Ok(()),
    }
}

/// Prints a line of metrics: every line as JSON, or only those with a measurement as text.
fn print(record: &Record, json: bool) -> io::Result<()> {
    if json {
        return json_line(record);
    }
    match format_record(record) {
        Some(line) => writeln!(printing::stdout(), "{line}"),
        None => Ok(()),
    }
}
