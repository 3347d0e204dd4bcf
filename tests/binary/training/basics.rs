//! Normal training runs, and invalid input.

use std::{fs, path::Path, process::Stdio};

use super::common::{SHORT, carom, command, folder, json_answer, read_json, run_ok, run_unfinished, start, wait_for};

#[test]
fn a_run_trains_a_policy_that_can_be_evaluated() {
    let folder = folder();
    let here = folder.path();
    let first = run_ok(here, &format!("{SHORT} --json --run one"));
    let lines = first.json();
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
    let config = read_json(here.join("one/config.json"));
    assert_eq!(
        (&config["agent"], &config["seed"], &config["settings"]["batch_size"]),
        (&"ddpg".into(), &3.into(), &32.into())
    );
    assert_eq!((&config["table"]["name"], &config["version"]), (&"match".into(), &env!("CARGO_PKG_VERSION").into()));

    let report = json_answer(here, "evaluate --policy one/policy.safetensors --policy-only --layouts 100 --json");
    assert_eq!(report["success"]["layouts"], 100);

    // The folder of a run can be used in place of its policy file; its checkpoint cannot.
    let of_folder = json_answer(here, "evaluate --policy one --policy-only --layouts 100 --json");
    assert_eq!((&of_folder["success"], &of_folder["policy"]), (&report["success"], &"one".into()));
    run_ok(here, "train --agent dqn --table thesis --reward r1 --steps 100 --evaluation-layouts 5 --run plain");
    for (policy, code, words) in [
        ("one/checkpoint.safetensors", 2, "is a checkpoint, not a policy; its run's policy is one/policy.safetensors"),
        (
            "plain/checkpoint.safetensors",
            2,
            "is a checkpoint, not a policy; its agent is dqn, and only the agent ddpg writes",
        ),
        (
            "plain",
            1,
            "the run plain has no policy; its agent is dqn, and only the agent ddpg writes policies: as RUN/policy",
        ),
        (".", 1, "is a folder without a policy.safetensors"),
    ] {
        let refused = carom(here, &format!("evaluate --policy {policy} --policy-only"));
        assert!(refused.code == Some(code) && refused.err.contains(words), "{policy}: {}", refused.err);
    }

    let line = "evaluate --policy one/policy.safetensors --policy-only --drawn-tables --layouts 50 --json";
    let drawn = json_answer(here, line);
    assert!(drawn["tenths"].as_array().is_some_and(|tenths| !tenths.is_empty()), "{drawn}");
    assert_ne!(drawn["claimed"], report["claimed"], "other tables, other strokes");

    // Only whole rollouts are played; the report gives the number that was played, not the requested one.
    let rounds = run_ok(here, "train --config small.toml --steps 1 --evaluation-layouts 5 --run rounds");
    assert!(rounds.out.contains("after 16 shots"), "{}", rounds.out);
    for file in ["result.json", "state.json"] {
        assert_eq!(read_json(here.join("rounds").join(file))["shots"], 16, "{file}");
    }
    let resumed = run_ok(here, "train --resume rounds");
    assert!(resumed.err.contains("it has played 16 shots (requested: 1)"), "{}", resumed.err);

    carom(here, &format!("{SHORT} --run one")).fails(1, &["--resume"]);
    let finished = run_ok(here, "train --resume one");
    assert!(finished.err.contains("is finished") && finished.out.contains("640 shots"), "{}", finished.err);
    let lines = run_ok(here, &format!("{SHORT} --run one --continue --json")).json();
    let result = read_json(here.join("one/result.json"));
    assert_eq!((lines.len(), &lines[0]["eval/mean_reward"]), (1, &result["held_out_reward"]), "{lines:?}");
}

#[test]
fn an_unfinished_run_exits_with_75_even_without_a_reader() {
    let folder = folder();
    let line =
        "train --config small.toml --steps 100000000 --evaluate-every 2000 --evaluation-layouts 20 --minutes 0.002";
    let mut training = command(folder.path(), line);
    let mut training = training.stdout(Stdio::piped()).stderr(Stdio::null()).spawn().unwrap();
    drop(training.stdout.take());
    assert_eq!(training.wait().unwrap().code(), Some(75));
}

#[cfg(unix)]
#[test]
fn an_interrupted_run_is_saved_listed_locked_and_resumable() {
    let folder = folder();
    let here = folder.path();
    // In the folder of the user's own runs, where they are found by name.
    let name = "mine";
    let run = here.join("carom/runs").join(name);
    let line = "train --config small.toml --steps 100000000 --evaluate-every 2000 --evaluation-layouts 20";
    let mut child = start(here, &format!("{line} --run {}", run.display()));
    // The first lines of metrics show that the signal handlers are installed and training has started.
    wait_for(&run.join("metrics.jsonl"), &mut child);
    let listed = || json_answer(here, "train --list --json");
    assert_eq!((&listed()["name"], &listed()["state"]), (&name.into(), &"running".into()));
    carom(here, &format!("train --resume {name}")).fails(1, &["another process"]);

    let interrupt = std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status();
    assert!(interrupt.unwrap().success());
    assert_eq!(child.wait().unwrap().code(), Some(75));
    assert!(run.join("policy.safetensors").exists());
    let stopped = listed();
    assert_eq!(stopped["state"], "stopped");
    let resumed = run_unfinished(here, &format!("train --resume {name} --minutes 0.002"));
    assert!(resumed.err.contains("carom train --resume"), "{}", resumed.err);
    assert!(listed()["shots"].as_u64() > stopped["shots"].as_u64());
    let table = run_ok(here, "train --list").out;
    assert!(table.lines().count() == 2 && table.contains(name) && table.contains("stopped"), "{table}");
}

#[test]
fn every_bundled_policy_beats_a_search_of_100_random_shots() {
    // The model card contains the success rate of a search of 100 random shots, with its interval; a single shot of the networks is better
    // everywhere.
    let card = include_str!("../../../models/README.md");
    for table in ["match", "thesis"] {
        for (rule, reward) in [("straight", "r3"), ("one-cushion", "one-cushion"), ("three-cushion", "three-cushion")] {
            let row = card.lines().find(|line| line.starts_with(&format!("| `{table}-{reward}` | **"))).unwrap();
            let high: f64 = row.rsplit_once('–').unwrap().1.split(' ').next().unwrap().parse().unwrap();
            let line = format!("evaluate --policy-only --table {table} --rule {rule} --layouts 500 --json");
            let report = json_answer(Path::new("."), &line);
            assert!(report["success"]["low"].as_f64().unwrap() > high / 100.0, "{row}: {report}");
        }
    }
}

#[test]
fn invalid_input_is_named_in_one_sentence_and_writes_nothing() {
    let folder = folder();
    let here = folder.path();
    fs::write(here.join("broken.safetensors"), b"not weights").unwrap();
    fs::write(here.join("wrong.toml"), "heads = 0").unwrap();
    fs::write(here.join("nan.toml"), "tau = nan").unwrap();
    let table = include_str!("../../../src/table/thesis.toml").replace("name = \"thesis\"", "name = \"cellar\"");
    fs::write(here.join("cellar.toml"), table).unwrap();
    for (line, code, named) in [
        ("evaluate --policy none.safetensors", 1, "none.safetensors"),
        ("evaluate --policy broken.safetensors", 2, "broken.safetensors is not a policy that carom can use: "),
        ("evaluate --policy broken.safetensors", 2, "; train one with `carom train`"),
        ("evaluate --table snooker", 1, "snooker"),
        ("evaluate --policy-only --table cellar.toml", 2, "cellar"),
        ("evaluate --random-search 10 --policy-only", 2, "--random-search"),
        ("evaluate --policy-only --reward r9", 2, "r9"),
        ("evaluate --layouts 0", 2, "0"),
        ("evaluate --random-search 0", 2, "0"),
        ("evaluate --random-search 10 --reward r1", 2, "--reward"),
        ("train --run new --table snooker", 1, "snooker"),
        ("train --run new --minutes -1", 2, "-1"),
        ("train --run new --minutes NaN", 2, "NaN"),
        ("train --run new --steps 0", 2, "0"),
        ("train --run new --evaluate-every 0", 2, "0"),
        ("train --run new --seeds 0", 2, "0"),
        ("train --run new --seeds 2 --seed 18446744073709551615", 2, "0 to 18446744073709551614"),
        ("train --run new --jobs 2", 2, "--seeds"),
        ("train --run new --agent sarsa", 2, "no agent \"sarsa\"; use ddpg, q-learning, dqn, thesis-ddpg"),
        ("train --run new --agent sarsa --seeds 2", 2, "sarsa"),
        ("train --run new --config wrong.toml", 2, "heads = 0"),
        ("train --run new --config nan.toml", 2, "tau is not a finite number"),
        ("train --run new --config none.toml", 1, "none.toml"),
        ("train --run new --set heads", 2, "heads"),
        ("train --run new --set heads=0", 2, "heads = 0"),
        ("train --run new --agent thesis-ddpg --table thesis --set noise.simga=1", 2, "simga"),
        ("train --run new --agent thesis-ddpg --reward r1 --set hindsight=0.5", 2, "use them with r3"),
        ("train --run new --agent thesis-ddpg --reward r1 --set demonstrations=0.5", 2, "use them with r3"),
        ("train --run new --from nowhere", 1, "there is nothing called nowhere to start from"),
        (
            "train --run new --from nowhere",
            1,
            "accepted are a run (its folder, its name or latest), a checkpoint file and a policy (its file, the name of one that was kept",
        ),
        ("train --run wrong.toml", 1, "wrong.toml is a file, and a run needs a folder"),
        ("train --run wrong.toml/below --seeds 2", 1, "wrong.toml is a file, and a run needs a folder"),
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

#[test]
fn setting_one_nested_value_keeps_the_others() {
    let folder = folder();
    let here = folder.path();
    let noise = |run: &str| read_json(here.join(run).join("config.json"))["settings"]["noise"].clone();
    let short = "--table thesis --steps 100 --evaluation-layouts 5";
    let line = format!("train --agent thesis-ddpg --reward r3 {short} --set noise.sigma=1 --set noise.dt=0.5 --run a");
    run_ok(here, &line);
    assert_eq!(noise("a"), serde_json::json!({"theta": 0.15, "sigma": 1.0, "dt": 0.5}));
    // The other parts that the source run of the weights has set are kept, too.
    run_ok(here, &format!("train --from a {short} --set noise.theta=0.3 --run b"));
    assert_eq!(noise("b"), serde_json::json!({"theta": 0.3, "sigma": 1.0, "dt": 0.5}));
    fs::write(here.join("parts.toml"), "[noise]\nsigma = 2.0\n").unwrap();
    run_ok(here, &format!("train --from a {short} --config parts.toml --set noise.theta=0.3 --run c"));
    assert_eq!(noise("c"), serde_json::json!({"theta": 0.3, "sigma": 2.0, "dt": 0.5}));
}

#[test]
fn continue_and_objective_start_resume_and_score_a_run() {
    let folder = folder();
    let here = folder.path();
    let line = format!("{SHORT} --run again --continue --objective");
    let early = run_unfinished(here, &format!("{line} --minutes 0.00001"));
    assert_eq!(early.out.lines().count(), 1, "{}", early.out);
    let result = here.join("again/result.json");
    assert!(!result.exists(), "it is not finished");
    let objective: f64 = run_ok(here, &line).out.trim().parse().unwrap();
    assert_eq!(read_json(result)["held_out_reward"].as_f64(), Some(objective));
    assert_eq!(run_ok(here, &line).out.trim().parse(), Ok(objective), "a finished run stays as it is");
    carom(here, &line.replace("--seed 3", "--seed 4")).fails(1, &["seed 3, not 4"]);
    // TensorBoard finds the file by this part of its name.
    let events = fs::read(here.join("again/events.out.tfevents.carom")).unwrap();
    let has = |part: &[u8]| events.windows(part.len()).any(|window| window == part);
    assert!(has(b"brain.Event:2") && has(b"eval/mean_reward"));
}
