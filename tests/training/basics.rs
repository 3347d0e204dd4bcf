//! Runs as they should go, and input that is wrong.

use std::{fs, path::Path};

use serde_json::Value;

use crate::common::{SHORT, carom, done, folder, start, wait_for};

#[test]
fn a_run_trains_a_policy_that_can_be_evaluated() {
    let folder = folder();
    let here = folder.path();
    let first = done(here, &format!("{SHORT} --json --run one"));
    let lines: Vec<Value> = first.out.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let last = lines.last().unwrap();
    assert_eq!(last["time/total_timesteps"], 640);
    for name in ["time/fps", "time/time_elapsed", "rollout/ep_rew_mean", "train/critic_loss", "train/actor_loss"] {
        assert!(last[name].is_number(), "{name} in {last}");
    }
    for name in ["train/n_updates", "train/learning_rate", "train/q_value", "eval/mean_reward"] {
        assert!(last[name].is_number(), "{name} in {last}");
    }
    let file = fs::read_to_string(here.join("one/metrics.jsonl")).unwrap();
    assert_eq!(file, first.out, "the file and the output have the same lines");
    let config: Value = serde_json::from_slice(&fs::read(here.join("one/config.json")).unwrap()).unwrap();
    assert_eq!(
        (&config["agent"], &config["seed"], &config["settings"]["batch"]),
        (&"ddpg".into(), &3.into(), &32.into())
    );
    assert_eq!((&config["table"]["name"], &config["version"]), (&"match".into(), &env!("CARGO_PKG_VERSION").into()));

    let measured = done(here, "evaluate --policy one/policy.safetensors --policy-only --layouts 100 --json");
    let report: Value = serde_json::from_str(&measured.out).unwrap();
    assert_eq!(report["success"]["layouts"], 100);

    let again = carom(here, &format!("{SHORT} --run one"));
    assert_eq!(again.code, Some(2));
    assert!(again.err.contains("--resume"), "{}", again.err);
    let finished = done(here, "train --resume one");
    assert!(finished.err.contains("is finished") && finished.out.contains("640 shots"), "{}", finished.err);
}

#[cfg(unix)]
#[test]
fn an_interrupted_run_is_listed_saves_and_goes_on_and_nobody_else_may_meanwhile() {
    let folder = folder();
    let here = folder.path();
    let line = "train --config small.toml --steps 100000000 --evaluate-every 2000 --evaluation-layouts 20";
    let mut child = start(here, line);
    let runs = here.join("carom/runs");
    while fs::read_dir(&runs).map_or(0, Iterator::count) == 0 {
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
    let run = fs::read_dir(&runs).unwrap().next().unwrap().unwrap().path();
    let name = run.file_name().unwrap().to_str().unwrap();
    // The first lines of metrics show that the signal handlers stand and training is under way.
    wait_for(&run.join("metrics.jsonl"), &mut child);
    let listed = || -> Value { serde_json::from_str(&done(here, "train --list --json").out).unwrap() };
    assert_eq!((&listed()["name"], &listed()["state"]), (&name.into(), &"running".into()));
    let busy = carom(here, &format!("train --resume {name}"));
    assert_eq!(busy.code, Some(1));
    assert!(busy.err.contains("another process"), "{}", busy.err);

    let interrupt = std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status();
    assert!(interrupt.unwrap().success());
    assert_eq!(child.wait().unwrap().code(), Some(0));
    assert!(run.join("policy.safetensors").exists());
    let stopped = listed();
    assert_eq!(stopped["state"], "interrupted");
    let resumed = done(here, &format!("train --resume {name} --minutes 0.002"));
    assert!(resumed.err.contains("carom train --resume"), "{}", resumed.err);
    assert!(listed()["shots"].as_u64() > stopped["shots"].as_u64());
    let table = done(here, "train --list").out;
    assert!(table.lines().count() == 2 && table.contains(name) && table.contains("interrupted"), "{table}");
}

#[test]
fn the_bundled_policy_alone_scores_on_most_layouts() {
    let report = done(Path::new("."), "evaluate --policy-only --layouts 500 --json");
    let report: Value = serde_json::from_str(&report.out).unwrap();
    assert!(report["success"]["low"].as_f64().unwrap() > 0.6, "{report}");
}

#[test]
fn bad_input_is_one_sentence_that_names_the_value_and_nothing_is_written() {
    let folder = folder();
    let here = folder.path();
    fs::write(here.join("broken.safetensors"), b"not weights").unwrap();
    fs::write(here.join("wrong.toml"), "heads = 0").unwrap();
    fs::write(here.join("nan.toml"), "target_rate = nan").unwrap();
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
        ("train --run new --evaluate-every 0", 2, "0"),
        ("train --run new --seeds 0", 2, "0"),
        ("train --run new --agent sarsa", 2, "sarsa"),
        ("train --run new --agent sarsa --seeds 2", 2, "sarsa"),
        ("train --run new --config wrong.toml", 2, "heads = 0"),
        ("train --run new --config nan.toml", 2, "target_rate"),
        ("train --run new --config none.toml", 1, "none.toml"),
        ("train --run new --from nowhere", 1, "nowhere"),
        ("train --run new --from broken.safetensors", 2, "broken.safetensors"),
        ("train --resume nowhere", 1, "nowhere"),
        ("train --resume new --seed 2", 2, "--seed"),
        ("train --list nowhere", 1, "nowhere"),
    ] {
        let outcome = carom(here, line);
        assert_eq!(outcome.code, Some(code), "{line}: {}", outcome.err);
        assert!(outcome.err.contains(named) && !outcome.err.contains("panicked"), "{line}: {}", outcome.err);
        assert!(outcome.out.is_empty(), "{line}");
    }
    assert!(!here.join("new").exists() && !here.join("nowhere").exists());
}
