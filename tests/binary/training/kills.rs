//! Runs that are killed at any time and resume without any difference.
//!
//! `CAROM_KILLS=500 cargo test --profile quick --test binary training::kills -- --nocapture` repeats until 500 kills have hit.

use std::{env, time::Duration};

use super::common::{RunFiles, folder, run_ok, start};

/// A run with twenty checkpoints.
const LONG: &str = "train --config small.toml --steps 20000 --evaluate-every 1000 --evaluation-layouts 20";

/// Number of kills that must hit the working program, and the maximum number of attempts on one run.
const KILLS: [u32; 2] = [8, 40];

#[test]
fn a_run_killed_at_random_times_ends_with_identical_files() {
    let wanted = env::var("CAROM_KILLS").ok().map_or(KILLS[0], |kills| kills.parse().expect("CAROM_KILLS: a number"));
    let (mut hits, mut runs) = (0, 0);
    while hits < wanted {
        runs += 1;
        let before = hits;
        hits += hits_on_one_run(runs, wanted - hits);
        assert!(hits > before, "run {runs} was hit by no kill at all");
        println!("{hits} kills have hit {runs} runs, each of which ended in the files of a run that nobody killed");
    }
}

/// Kills the run of this seed repeatedly, until `wanted` kills have hit or the run has ended; returns the number of hits. The final files
/// must equal those of an uninterrupted run.
fn hits_on_one_run(seed: u32, wanted: u32) -> u32 {
    let folder = folder();
    let here = folder.path();
    let mut whole = start(here, &format!("{LONG} --seed {seed} --run whole"));
    let killed = here.join("killed");
    // Different delays that are spread evenly (multiples of the golden ratio), plus the variation of the machine's own timing.
    let delays = (1..=KILLS[1]).map(|kill| Duration::from_secs_f64(0.004 + 0.15 * (f64::from(kill) * 0.618).fract()));
    let mut hits = 0;
    for delay in delays {
        let mut child = start(here, &start_or_continue(seed));
        std::thread::sleep(delay);
        child.kill().unwrap();
        if child.wait().unwrap().code().is_some() {
            // The run ended before the kill.
            break;
        }
        hits += 1;
        if hits == wanted {
            break;
        }
    }
    run_ok(here, &start_or_continue(seed));
    assert!(whole.wait().unwrap().success());
    RunFiles::of(&here.join("whole")).assert_same(&RunFiles::of(&killed), &format!("seed {seed}, after {hits} kills"));
    hits
}

/// The command that starts or resumes a run. A run that was killed before its first checkpoint does not count as one.
fn start_or_continue(seed: u32) -> String {
    format!("{LONG} --seed {seed} --run killed --continue")
}
