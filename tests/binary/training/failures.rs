//! Damaged checkpoints, and a full disk.

use std::fs;

use super::common::{RunFiles, SHORT, carom, folder, run_ok, run_unfinished};

#[test]
fn a_damaged_checkpoint_is_reported_and_the_previous_one_used() {
    let folder = folder();
    let here = folder.path();
    let run = here.join("run");
    run_ok(here, &format!("{SHORT} --run run"));
    let files = RunFiles::of(&run);
    let (current, previous) = (run.join("checkpoint.safetensors"), run.join("checkpoint-previous.safetensors"));
    let whole = fs::read(&current).unwrap();
    // The length of the header, the header, its end, and the start and end of the arrays.
    for index in [0, 7, 9, 60, whole.len() / 2, whole.len() - 1] {
        let mut damaged = whole.clone();
        damaged[index] ^= 1;
        fs::write(&current, damaged).unwrap();
        let resumed = run_ok(here, "train --resume run");
        assert!(resumed.err.contains("warning") && resumed.err.contains("checkpoint.safetensors"), "{}", resumed.err);
        assert!(
            resumed.err.contains("going on from checkpoint-previous.safetensors, after 576 shots"),
            "{}",
            resumed.err
        );
        RunFiles::of(&run).assert_same(&files, "after the damage");
    }
    fs::write(&current, &whole[..whole.len() / 2]).unwrap();
    // A run that starts from the damaged one reports it as well.
    let copied = run_ok(here, "train --from run --steps 64 --evaluation-layouts 5 --run copy");
    assert!(copied.err.contains("after 576 shots"), "{}", copied.err);
    fs::write(&previous, b"").unwrap();
    let state = fs::read(run.join("state.json")).unwrap();
    let lost = carom(here, "train --resume run");
    assert_eq!(fs::read(run.join("state.json")).unwrap(), state, "a refused resume changes nothing");
    let lost = lost.fails(1, &["checkpoint.safetensors", "checkpoint-previous.safetensors", "damaged"]);
    assert_eq!(lost.err.lines().count(), 1, "{}", lost.err);
}

#[test]
fn truncated_or_missing_metrics_are_reported_once() {
    let folder = folder();
    let here = folder.path();
    let run = here.join("run");
    run_ok(here, &format!("{SHORT} --run whole"));
    run_unfinished(here, &format!("{SHORT} --run run --minutes 0.00001"));
    let metrics = fs::read_to_string(run.join("metrics.jsonl")).unwrap_or_default();
    fs::write(run.join("metrics.jsonl"), metrics + "{\"time/total").unwrap();
    let resumed = run_ok(here, "train --resume run");
    assert!(resumed.err.contains("warning: the last line of metrics.jsonl is cut off"), "{}", resumed.err);
    RunFiles::of(&here.join("whole")).assert_same(&RunFiles::of(&run), "after the line was cut off");
    assert!(!run_ok(here, "train --resume run").err.contains("warning"));

    let checkpoint = fs::read(run.join("checkpoint.safetensors")).unwrap();
    let lines = fs::read_to_string(run.join("metrics.jsonl")).unwrap();
    let half: String = lines.lines().take(20).map(|line| line.to_owned() + "\n").collect();
    fs::write(run.join("metrics.jsonl"), half).unwrap();
    let resumed = run_ok(here, "train --resume run");
    let warning = "warning: metrics.jsonl has been emptied or cut off: it ends after 320 of the 640 shots played";
    assert_eq!(resumed.err.matches(warning).count(), 1, "{}", resumed.err);
    fs::remove_file(run.join("metrics.jsonl")).unwrap();
    let resumed = run_ok(here, "train --resume run");
    let warning = "warning: metrics.jsonl is missing: there is no line of the 640 shots played";
    assert_eq!(resumed.err.matches(warning).count(), 1, "{}", resumed.err);
    assert!(fs::read(run.join("checkpoint.safetensors")).unwrap() == checkpoint);
}

/// A limit on the size of files acts like a full disk, without a mount.
#[cfg(unix)]
#[test]
fn a_full_disk_is_reported_and_keeps_the_last_checkpoint() {
    use super::common::command;
    use crate::program::{outcome, program};

    let folder = folder();
    let here = folder.path();
    run_ok(here, &format!("{SHORT} --run whole"));
    run_unfinished(here, &format!("{SHORT} --run run --minutes 0.00001"));
    let run = here.join("run");
    let checkpoints =
        || ["checkpoint.safetensors", "checkpoint-previous.safetensors"].map(|name| fs::read(run.join(name)).unwrap());
    let before = checkpoints();
    // The replay buffer makes checkpoints grow: the next ones exceed this limit, in blocks of 512 bytes; policies do not.
    let blocks = before[0].len() / 512 + 2;
    let resume = command(here, "train --resume run");
    let mut limited = program(here, "sh".as_ref());
    limited.arg("-c").arg(format!("ulimit -f {blocks}; exec \"$@\"")).arg("sh");
    limited.arg(resume.get_program()).args(resume.get_args());
    let full = outcome(limited.spawn().unwrap());
    assert_eq!(full.code, Some(1), "{}", full.err);
    let is_told = |line: &&str| {
        ["warning: the checkpoint after ", " could not be written", "checkpoint.safetensors"]
            .iter()
            .all(|part| line.contains(part))
    };
    assert!(full.err.lines().filter(is_told).count() >= 5, "{}", full.err);
    assert!(full.err.contains("after 640 shots") && full.err.contains("--resume"), "{}", full.err);
    assert!(checkpoints() == before);
    assert!(fs::read_dir(&run).unwrap().all(|entry| !entry.unwrap().path().to_string_lossy().contains("partial")));
    run_ok(here, "train --resume run");
    RunFiles::of(&here.join("whole")).assert_same(&RunFiles::of(&run), "after the disk was full");
}
