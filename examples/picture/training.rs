//! A screen of a run in progress: the run is trained for a minute and watched.

use std::{error::Error, path::Path};

use carom::{
    game::Reward,
    learning::{
        agents::AGENTS,
        learner::TrainingPlan,
        run::{Limits, Report, Run, Schedule, follow::Follower, list::runs_in},
    },
    storage::DataPaths,
    table::{Layout, Table},
    terminal::{App, Capabilities, FollowSlot, Reel, TrainingReport},
};
use crossterm::event::KeyCode::{Char, Enter};

/// Number of planned shots, and the number after which the picture is taken.
const PLANNED: u64 = 300_000;
const TAKEN: u64 = 150_000;
/// Seconds of the replay before the picture: the balls are moving then.
const REPLAYED: f64 = 1.3;

/// Returns the screen of a run that is half complete.
pub fn screen(caps: Capabilities) -> Result<App, Box<dyn Error>> {
    let folder = tempfile::tempdir()?;
    let runs = folder.path().join("runs");
    let place = runs.join("first-steps");
    let plan = TrainingPlan { reward: Reward::R3, seed: 1, shots: PLANNED };
    let learner = (AGENTS[0].start)(plan, Table::default(), &serde_json::json!({}))?;
    let mut run = Run::create(&place, learner, Schedule::new(10_000, 1_000), None)?;
    let mut app = None;
    let is_taken = std::cell::Cell::new(false);
    // The picture is taken while the run trains; the run stops at the next iteration.
    let limits = Limits { time: None, stop: &|| is_taken.get() };
    run.train(&limits, &mut |report| match report {
        Report::Warning(sentence) => eprintln!("{sentence}"),
        Report::Line(record) if record.held_out_reward.is_some() => {
            eprintln!("trained {} of {TAKEN} shots for the picture", record.shots);
        }
        // Not at a measurement: the picture should show the run while it trains.
        Report::Line(record) => {
            if record.shots > TAKEN && !is_taken.replace(true) {
                app = Some(photograph(&runs, &place, caps));
            }
        }
    })?;
    app.ok_or("the run ended before the picture")?
}

/// Returns the screen of the run at `place` in the folder `runs`.
fn photograph(runs: &Path, place: &Path, caps: Capabilities) -> Result<App, Box<dyn Error>> {
    let table = Table::default();
    let places = DataPaths { runs: runs.to_owned(), policies: runs.to_owned(), ..DataPaths::of_this_user() };
    let mut app = App::new(table.clone(), Layout::opening(&table), caps, 1)?.with_paths(places);
    app.handle(&Char('t').into());
    app.receive_training(TrainingReport::Runs(runs_in(runs).map_err(|error| error.to_string())));
    app.handle(&Enter.into());
    show(&mut app, place, &table)?;
    app.tick(REPLAYED);
    Ok(app)
}

/// Shows what a follower of the run sees.
fn show(app: &mut App, place: &Path, table: &Table) -> Result<(), Box<dyn Error>> {
    let mut update = Follower::new(place).poll().ok_or("nothing is to be seen of the run")?;
    let reel = update.examples.take().map(|examples| Reel::record(&examples, table));
    app.receive_training(TrainingReport::HasPolicy(place.to_owned(), true));
    app.receive_training(TrainingReport::Followed(FollowSlot::Main, place.to_owned(), Box::new(update)));
    app.receive_training(TrainingReport::Recorded(place.to_owned(), reel.ok_or("the run has no shots to show")?));
    Ok(())
}
