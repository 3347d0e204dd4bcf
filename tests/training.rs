//! `carom train` and `carom evaluate` as a user runs them.

use std::{fs, path::Path, process::Command};

use assert_cmd::cargo::cargo_bin;
use serde_json::Value;

/// A run of a second.
const SMALL: &str = "actor_layers = [16]\ncritic_layers = [16]\nbatch = 32\nactor_batch = 8\nshots_per_update = 16\n";

struct Outcome {
    code: Option<i32>,
    out: String,
    err: String,
}

fn carom(folder: &Path, line: &str) -> Outcome {
    let output = Command::new(cargo_bin!("carom")).args(line.split_whitespace()).current_dir(folder).output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    Outcome { code: output.status.code(), out: text(output.stdout), err: text(output.stderr) }
}

#[test]
fn a_run_trains_a_policy_that_can_be_evaluated_and_repeats_with_its_seed() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    fs::write(here.join("small.toml"), SMALL).unwrap();
    let train = |run: &str| carom(here, &format!("train --config small.toml --steps 640 --seed 3 --json --run {run}"));
    let first = train("one");
    assert_eq!(first.code, Some(0), "{}", first.err);
    let line: Value = serde_json::from_str(first.out.lines().last().unwrap()).unwrap();
    assert_eq!(line["time/total_timesteps"], 640);
    assert!(line["eval/mean_reward"].is_number());
    for file in ["config.json", "metrics.jsonl", "checkpoint.safetensors", "policy.safetensors"] {
        assert!(here.join("one").join(file).exists(), "{file}");
    }
    assert_eq!(train("two").code, Some(0));
    let policy = |run: &str| fs::read(here.join(run).join("policy.safetensors")).unwrap();
    assert!(policy("one") == policy("two"));

    let measured = carom(here, "evaluate --policy one/policy.safetensors --policy-only --layouts 100 --json");
    let report: Value = serde_json::from_str(&measured.out).unwrap();
    assert_eq!((measured.code, &report["success"]["layouts"]), (Some(0), &Value::from(100)));

    let again = train("one");
    assert_eq!(again.code, Some(2));
    assert!(again.err.contains("--resume"), "{}", again.err);
}

#[cfg(unix)]
#[test]
fn an_interrupted_run_saves_and_goes_on() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    fs::write(here.join("small.toml"), SMALL).unwrap();
    let mut child = Command::new(cargo_bin!("carom"))
        .args("train --config small.toml --steps 100000000 --run run".split_whitespace())
        .current_dir(here)
        .stderr(std::process::Stdio::null())
        .spawn()
        .unwrap();
    // The first lines of metrics show that the signal handlers stand and training is under way.
    while !here.join("run/metrics.jsonl").exists() {
        assert!(child.try_wait().unwrap().is_none(), "the run ended by itself");
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    assert_eq!(child.wait().unwrap().code(), Some(0));
    assert!(here.join("run/policy.safetensors").exists());
    let resumed = carom(here, "train --resume run --minutes 0.002");
    assert_eq!(resumed.code, Some(0), "{}", resumed.err);
    assert!(resumed.err.contains("carom train --resume"), "{}", resumed.err);
}

#[test]
fn the_bundled_policy_alone_scores_on_most_layouts() {
    let report = carom(Path::new("."), "evaluate --policy-only --layouts 500 --json");
    let report: Value = serde_json::from_str(&report.out).unwrap();
    assert!(report["success"]["low"].as_f64().unwrap() > 0.6, "{report}");
}

#[test]
fn bad_input_is_one_sentence_that_names_the_value_and_nothing_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    fs::write(here.join("broken.safetensors"), b"not weights").unwrap();
    fs::write(here.join("wrong.toml"), "heads = 0").unwrap();
    for (line, code, named) in [
        ("evaluate --policy none.safetensors", 1, "none.safetensors"),
        ("evaluate --policy broken.safetensors", 1, "broken.safetensors"),
        ("evaluate --table snooker", 2, "snooker"),
        ("evaluate --policy-only --table thesis", 2, "thesis"),
        ("evaluate --policy-only --reward r9", 2, "r9"),
        ("evaluate --layouts 0", 2, "0"),
        ("train --run new --table snooker", 2, "snooker"),
        ("train --run new --minutes -1", 2, "-1"),
        ("train --run new --minutes NaN", 2, "NaN"),
        ("train --run new --steps 0", 2, "0"),
        ("train --run new --agent dqn", 2, "dqn"),
        ("train --run new --config wrong.toml", 2, "heads = 0"),
        ("train --run new --config none.toml", 1, "none.toml"),
        ("train --resume nowhere", 1, "nowhere"),
    ] {
        let outcome = carom(here, line);
        assert_eq!(outcome.code, Some(code), "{line}: {}", outcome.err);
        assert!(outcome.err.contains(named) && !outcome.err.contains("panicked"), "{line}: {}", outcome.err);
        assert!(outcome.out.is_empty(), "{line}");
    }
    assert!(!here.join("new").exists());
}
