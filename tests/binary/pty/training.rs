//! Runs that train next to the program.

use std::{
    thread,
    time::{Duration, Instant},
};

use carom::learning::run::{follow::Condition, list::runs_in, status::Phase};

use crate::{
    terminal::{QUIET_TIME, Session, TIMEOUT, carom},
    training::common::{folder, start, wait_for},
};

#[test]
fn a_run_started_in_the_program_outlives_it() {
    let data = tempfile::tempdir().unwrap();
    let mut command = carom();
    command.env("XDG_DATA_HOME", data.path());
    let mut session = Session::start_command(command, 80, 24).ready();
    session.send("t");
    session.wait_for("No agent has been trained here yet.");
    session.send("n\x1b[B\x1b[B\x1b[B\x7f\x7f\x7f\x7f\x7f\x7f\x7f20000\r");
    session.wait_for("Numbers");
    session.quit_with("q");
    // The pseudo-terminal ends with the session.
    drop(session);
    let start = Instant::now();
    loop {
        let runs = runs_in(&data.path().join("carom/runs")).unwrap_or_default().runs;
        if runs.first().is_some_and(|run| run.state == Condition::InPhase(Phase::Finished) && run.best_reward.is_some())
        {
            break;
        }
        assert!(start.elapsed() < 9 * TIMEOUT, "it does not finish: {runs:?}");
        thread::sleep(Duration::from_millis(100));
    }
}

#[test]
fn two_terminals_watch_a_run_and_idle_after_its_end() {
    let folder = folder();
    let run = folder.path().join("run");
    let line = "train --config small.toml --steps 60000 --evaluate-every 10000 --evaluation-layouts 50 --run run";
    let mut training = start(folder.path(), line);
    wait_for(&run.join("metrics.jsonl"), &mut training);
    let watch = |width, height| {
        let mut command = carom();
        command.arg("watch");
        command.arg(&run);
        Session::start_command(command, width, height)
    };
    let mut watchers = [watch(80, 24), watch(120, 40)];
    for watcher in &mut watchers {
        watcher.wait_for("1 mean reward");
        watcher.wait_for("training");
        watcher.wait_for("Shot 1 of 8");
    }
    // Without the spectator that left, the training continues; the remaining one sees it end.
    let [left, mut stays] = watchers;
    drop(left);
    let watched = stays.count_bytes(Duration::from_secs(2));
    assert!(training.wait().unwrap().success());
    stays.wait_for("finished");
    stays.send(".");
    stays.wait_until_quiet(QUIET_TIME);
    assert_eq!(stays.count_bytes(Duration::from_secs(2)), 0, "the run has ended, and no shot plays");
    // At most ten pictures of a few hundred bytes per second; 2,300 bytes per second were measured.
    assert!((100..40_000).contains(&watched), "{watched} bytes in two seconds");
    stays.quit_with("q");
}
