//! `carom watch`: look at a run that trains here or elsewhere.

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
    output::{json_line, tell},
    train::{line, print_runs},
};
use crate::{
    learning::run::{
        follow::{Condition, Followed, Follower},
        holds_checkpoints,
        metrics::Record,
        status::Phase,
    },
    platform::stop_when_told,
    printing::{self, OneLine, shell_word},
    terminal,
};

/// Time between two looks at the run.
const INTERVAL: Duration = Duration::from_millis(200);

/// Time for which a run has to be over before that is believed.
const GRACE: Duration = Duration::from_secs(1);

/// Watch a run, live while it trains and also after its end.
///
/// On a terminal the training screen opens, whose keys can pause and stop the run; elsewhere a line is printed for every
/// measurement until the run has ended. Looking only reads the run's files, and leaving never disturbs it.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The run: its folder, its name among the user's runs, or "latest". Left out, or a folder of several runs: a list to
    /// choose from.
    run: Option<PathBuf>,
    /// Plain lines, on a terminal too.
    #[arg(long)]
    plain: bool,
    /// Every line of metrics as JSON on standard output, from the first on.
    #[arg(long)]
    json: bool,
}

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let folder = args.run.as_deref().map(existing_run).transpose()?;
    let is_run = folder.as_deref().is_some_and(holds_checkpoints);
    if !args.plain && !args.json && terminal::is_there() {
        return terminal::watch(folder.as_deref().filter(|_| is_run), folder.as_deref().filter(|_| !is_run))
            .map_err(Failure::wrong_input);
    }
    match folder {
        Some(folder) if is_run => {
            if args.run.as_deref() == Some(Path::new(LATEST)) {
                tell(format_args!("watching the run in {}", folder.display()));
            }
            follow(&folder, args.json)
        }
        folder => {
            if print_runs(folder.as_deref(), args.json)? {
                tell(match folder {
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

/// Prints what the run does until it has ended.
fn follow(folder: &Path, json: bool) -> Result<(), Failure> {
    let stop = stop_when_told(None).map_err(Failure::failed)?;
    let (mut follower, mut followed) = (Follower::new(folder), Followed::new(folder));
    let (mut before, mut over) = (Condition::Unknown, None::<Instant>);
    // Of a run that goes on from an earlier checkpoint the lines come again, alike.
    let mut printed = 0;
    while !stop.load(Ordering::Relaxed) {
        if let Some(update) = follower.look() {
            if update.config.is_some() {
                printed = 0;
            }
            for record in update.records.iter().filter(|record| record.shots > printed) {
                print(record, json)?;
            }
            printed = update.records.last().map_or(printed, |record| record.shots.max(printed));
            for notice in update.notices.iter().flatten() {
                tell(format_args!("note: {}", OneLine(notice)));
            }
            followed.apply(update);
        }
        let condition = followed.condition;
        // A run that has just been taken up again is over until it says otherwise.
        over = condition.is_over().then(|| over.unwrap_or_else(Instant::now));
        let is_settled = over.is_none_or(|since| since.elapsed() >= GRACE);
        // A measurement is reported by its line.
        if is_settled && condition != Condition::Is(Phase::Measuring) && !condition.is_like(before) {
            before = condition;
            tell(OneLine(followed.sentence()));
        }
        if over.is_some() && is_settled {
            break;
        }
        thread::sleep(INTERVAL);
    }
    match followed.condition {
        Condition::Died | Condition::Removed | Condition::Is(Phase::Failed) => {
            Err(Failure::failed(format_args!("the run has not ended well: {}", followed.condition)))
        }
        _ => Ok(()),
    }
}

/// A line of metrics: all of them as JSON, those with a measurement for people.
fn print(record: &Record, json: bool) -> io::Result<()> {
    if json {
        return json_line(record);
    }
    match line(record) {
        Some(line) => writeln!(printing::stdout(), "{line}"),
        None => Ok(()),
    }
}
