//! `carom train --list`: the existing runs.

use std::path::Path;

use crate::{
    commands::{
        Failure,
        output::{json_line, print_note, print_table},
    },
    learning::run::list::{Listing, Summary, runs_in},
    printing::{OneLine, local_time},
    storage::DataPaths,
};

/// Prints the runs in `folder`, or the user's runs, and returns whether there are any.
pub fn print(folder: Option<&Path>, json: bool) -> Result<bool, Failure> {
    let own = DataPaths::of_this_user().runs;
    // A user who has never trained has no such folder yet.
    let Listing { runs, unreadable } = match (folder, folder.unwrap_or(&own)) {
        (None, own) if !own.exists() => Listing::default(),
        (_, folder) => runs_in(folder).map_err(|error| {
            Failure::failed(format_args!("{} cannot be read as a folder of runs: {error}", folder.display()))
        })?,
    };
    for sentence in unreadable {
        print_note(format_args!("note: {}", OneLine(sentence)));
    }
    if runs.is_empty() {
        print_note(format_args!("no runs in {}; start one with carom train", folder.unwrap_or(&own).display()));
    } else if json {
        runs.iter().try_for_each(json_line)?;
    } else {
        print_table(HEADINGS, runs.iter().map(row), &NUMBERS)?;
    }
    Ok(!runs.is_empty())
}

const HEADINGS: [&str; 11] =
    ["name", "agent", "reward", "table", "seed", "shots", "of", "best", "last", "last written", "state"];

/// The columns with numbers, which are right-aligned.
const NUMBERS: [usize; 5] = [4, 5, 6, 7, 8];

fn row(run: &Summary) -> [String; HEADINGS.len()] {
    let reward = |reward: Option<f64>| reward.map_or_else(|| "-".to_owned(), |reward| format!("{reward:.4}"));
    [
        run.name.clone(),
        run.agent.clone(),
        run.reward.to_string(),
        run.table.clone(),
        run.seed.to_string(),
        run.shots.to_string(),
        run.planned_shots.to_string(),
        reward(run.best_reward),
        reward(run.last_reward),
        local_time(&run.changed),
        run.state.word().to_owned(),
    ]
}
