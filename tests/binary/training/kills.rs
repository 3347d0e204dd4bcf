//! Runs that are killed at any moment and go on as if they had not been.

use std::{path::Path, time::Duration};

use super::common::{Files, done, folder, start};

/// A run of two seconds or more with a checkpoint every hundredth.
const LONG: &str = "train --config small.toml --steps 240000 --evaluate-every 1000 --evaluation-layouts 20 --seed 9";

/// Fewest kills that have to hit the program at work, and most that are tried.
const KILLS: [u32; 2] = [8, 40];

#[test]
fn a_run_that_is_killed_at_random_moments_ends_in_the_same_files() {
    let folder = folder();
    let here = folder.path();
    done(here, &format!("{LONG} --run whole"));
    let killed = here.join("killed");
    // Delays that differ and are spread evenly (multiples of the golden ratio); the machine's own timing does the rest.
    let delays = (1..=KILLS[1]).map(|kill| Duration::from_secs_f64(0.004 + 0.15 * (f64::from(kill) * 0.618).fract()));
    let mut hits = 0;
    for delay in delays {
        let mut child = start(here, &resume_or_start(&killed));
        std::thread::sleep(delay);
        child.kill().unwrap();
        if child.wait().unwrap().code().is_some() {
            // It was faster.
            break;
        }
        hits += 1;
    }
    done(here, &resume_or_start(&killed));
    assert!(hits >= KILLS[0], "{hits}");
    Files::of(&here.join("whole")).assert_same(&Files::of(&killed), &format!("after {hits} kills"));
}

/// A run that is killed before its first checkpoint is none: it can be started again in the same folder.
fn resume_or_start(run: &Path) -> String {
    let is_run =
        ["checkpoint.safetensors", "checkpoint-previous.safetensors"].iter().any(|name| run.join(name).exists());
    if is_run { "train --resume killed".to_owned() } else { format!("{LONG} --run killed") }
}
