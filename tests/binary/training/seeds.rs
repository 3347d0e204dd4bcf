//! Several seeds, and runs that start from the weights of others.

use std::fs;

use super::common::{RunFiles, SHORT, carom, command, folder, json_answer, read_json, run_ok, run_unfinished};
use crate::program::outcome;

#[test]
fn several_seeds_equal_single_runs_and_resume_together() {
    let folder = folder();
    let here = folder.path();
    let whole = run_ok(here, &format!("{SHORT} --run whole --seeds 3 --jobs 2"));
    assert!(whole.out.contains("standard deviation") && whole.out.contains("seeds: 3"), "{}", whole.out);
    let spread = |group: &str| fs::read_to_string(here.join(group).join("seeds.csv")).unwrap();
    let rows: Vec<Vec<f64>> =
        spread("whole").lines().skip(1).map(|row| row.split(',').map(|cell| cell.parse().unwrap()).collect()).collect();
    assert_eq!(rows.len(), 10);
    assert!(rows.iter().all(|row| row[1] == 3.0 && row[4] <= row[2] && row[2] <= row[5] && row[3] >= 0.0), "{rows:?}");

    run_ok(here, &SHORT.replace("--seed 3", "--seed 4 --run four"));
    RunFiles::of(&here.join("four")).assert_same(&RunFiles::of(&here.join("whole/seed-4")), "alone and among others");

    // The seeds have one objective, once all have played their last shot.
    let line = format!("{SHORT} --run large --seeds 3 --continue --objective");
    assert_eq!(run_unfinished(here, &format!("{line} --minutes 0.0001")).out, "");
    let objective: f64 = run_ok(here, &line).out.trim().parse().unwrap();
    assert_eq!(objective, rows[9][2]);
    fs::remove_dir_all(here.join("large")).unwrap();

    // Stopped before the first seed is complete, then resumed.
    let parts = run_unfinished(here, &format!("{SHORT} --run parts --seeds 3 --minutes 0.0001"));
    assert!(parts.err.contains("--resume"), "{}", parts.err);
    run_unfinished(here, "train --resume parts --minutes 0.0005");
    assert!(run_ok(here, "train --resume parts --json").json().iter().all(|line| line["seed"].is_u64()));
    assert_eq!(spread("parts"), spread("whole"));
    let listed = run_ok(here, "train --list . --json");
    let (states, listed) = (listed.json(), listed.out);
    assert_eq!(states.len(), 7);
    assert!(states.iter().all(|run| run["state"] == "finished" && run["best_reward"].is_number()), "{listed}");
    assert!(listed.contains("whole/seed-5"), "{listed}");

    // A seed that has played all its shots but has not written its result yet writes it on resume.
    fs::remove_file(here.join("whole/seed-4/result.json")).unwrap();
    run_ok(here, "train --resume whole");
    assert!(here.join("whole/seed-4/result.json").exists());

    // Other settings are refused with an explanation, and so is another number of seeds; with the same settings the run is finished.
    let continued = |rest: &str| carom(here, &format!("{SHORT} --run whole --continue {rest}"));
    continued("--seeds 2").fails(1, &["was started with 3 seeds, not 2: --continue resumes a run that"]);
    continued("").fails(1, &["was started with 3 seeds, not as a single run"]);
    for (other, words) in [
        ("--set critic_chooses=0.35", "was started with critic_chooses = 0.3, not 0.35:"),
        ("--set exploration={uniform=0.25}", "was started with exploration.uniform = "),
        ("--from four", "was started without --from, not from four"),
    ] {
        let refused = continued(&format!("--seeds 3 {other}")).fails(1, &[words]);
        assert!(refused.err.len() < 250, "nothing is told but what differs: {}", refused.err);
    }
    let single = carom(here, &format!("{} --run four --continue --seeds 2", SHORT.replace("--seed 3", "--seed 4")));
    assert!(single.err.contains("was started as a single run, not with 2 seeds"), "{}", single.err);
    continued("--seeds 3").ok();
    // A single run in this folder would hide the seeds.
    carom(here, &format!("{SHORT} --run whole")).fails(1, &["--resume"]);
}

#[test]
fn resuming_latest_resumes_all_seeds_of_the_group() {
    let folder = folder();
    let here = folder.path();
    run_unfinished(here, &format!("{SHORT} --run carom/runs/group --seeds 2 --minutes 0.0001"));
    run_ok(here, "train --resume latest");
    let spread = fs::read_to_string(here.join("carom/runs/group/seeds.csv")).unwrap();
    assert!(spread.lines().last().unwrap().starts_with("640,2,"), "{spread}");
}

#[test]
fn a_failed_seed_is_reported_even_without_a_spread_file() {
    let folder = folder();
    let here = folder.path();
    run_ok(here, "train --config small.toml --steps 64 --evaluation-layouts 5 --run group --seeds 2");
    for name in ["checkpoint.safetensors", "checkpoint-previous.safetensors"] {
        fs::write(here.join("group/seed-2").join(name), "").unwrap();
    }
    fs::remove_file(here.join("group/seeds.csv")).unwrap();
    fs::create_dir(here.join("group/seeds.csv")).unwrap();
    carom(here, "train --resume group").fails(1, &["seed 2: no checkpoint in ", "seeds.csv cannot be used"]);
}

/// A scheduler may repeat the same command days later; by then the run that the weights came from may be gone.
#[test]
fn a_run_resumes_after_its_source_weights_are_gone() {
    let folder = folder();
    let here = folder.path();
    run_ok(here, &format!("{SHORT} --run one"));
    run_ok(here, &format!("{SHORT} --run two"));
    for (run, seeds) in [("single", ""), ("group", " --seeds 2")] {
        let line = |from: &str| {
            format!(
                "train --from {from} --steps 320 --evaluate-every 64 --evaluation-layouts 5 --set buffer_size=4000 --run {run} --continue{seeds}"
            )
        };
        run_unfinished(here, &format!("{} --minutes 0.00001", line("one")));
        let absolute = here.join("one").display().to_string();
        run_unfinished(here, &format!("{} --minutes 0.00001", line(&absolute)));
        carom(here, &line("two")).fails(1, &["was started from one, not from two"]);
        let left_out = carom(here, &line("one").replace(" --set buffer_size=4000", ""));
        assert!(left_out.err.contains("was started with buffer_size = 4000, not "), "{}", left_out.err);
        fs::rename(here.join("one"), here.join("away")).unwrap();
        carom(here, &line("two")).fails(1, &["was started from one, not from two"]);
        let other = carom(here, &line("one").replace("buffer_size=4000", "buffer_size=3000"));
        assert!(other.err.contains("was started with buffer_size = 4000, not 3000:"), "{}", other.err);
        run_ok(here, &line("one"));
        fs::rename(here.join("away"), here.join("one")).unwrap();
    }
    // The weights are not needed once every seed has started.
    let (weights, away) = (here.join("group/from.safetensors"), here.join("away"));
    fs::rename(&weights, &away).unwrap();
    run_ok(here, "train --resume group --objective");
    fs::rename(&away, &weights).unwrap();
    // As if killed after the first file was written.
    fs::remove_file(here.join("group/seeds.json")).unwrap();
    fs::remove_file(here.join("group/seeds.csv")).unwrap();
    for seed in ["seed-1", "seed-2"] {
        fs::remove_dir_all(here.join("group").join(seed)).unwrap();
    }
    let line = "--steps 64 --evaluation-layouts 5 --seeds 2 --run group --continue";
    carom(here, &format!("train {line}")).fails(1, &["\"from.safetensors\" is in it"]);
    run_ok(here, &format!("train --from one {line}"));
}

#[test]
fn weights_are_found_by_policy_name() {
    let folder = folder();
    let here = folder.path();
    let models = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("models");
    fs::create_dir_all(here.join("carom/policies")).unwrap();
    fs::copy(models.join("match-one-cushion.safetensors"), here.join("carom/policies/mine.safetensors")).unwrap();
    let short = "--steps 1 --evaluation-layouts 5 --set calibrated=0 --continue";
    for (from, run, reward, path) in [
        ("mine", "a", "one-cushion", "mine.safetensors"),
        ("match-one-cushion", "b", "one-cushion", "match-one-cushion"),
        ("bundled", "c", "r3", "match-r3"),
        ("bundled --reward three-cushion --table thesis", "d", "three-cushion", "thesis-three-cushion"),
    ] {
        let line = format!("train --from {from} {short} --run {run}");
        run_ok(here, &line);
        run_ok(here, &line);
        let config = read_json(here.join(run).join("config.json"));
        assert!(config["from"]["path"].as_str().unwrap().ends_with(path), "{from}: {}", config["from"]);
        assert_eq!(config["reward"], reward, "{from}");
    }
    // In the last rounds of this file, only the critic was trained.
    let line = format!("train --from match-three-cushion --reward three-cushion {short} --run e");
    assert!(run_ok(here, &line).err.contains("the actor will not change"));
    let lively = run_ok(here, &(line + " --set actor_learning_rate=0.0004").replace("run e", "run f"));
    assert!(!lively.err.contains("will not change"), "{}", lively.err);
    let line = "evaluate --policy match-one-cushion --policy-only --rule one-cushion --layouts 5 --json";
    let report = json_answer(here, line);
    assert_eq!((&report["policy"], &report["networks"]), (&"match-one-cushion".into(), &"match-one-cushion".into()));
    for line in ["train --from match-r9", "evaluate --policy match-r9"] {
        let words = ["match-r9", "the name of one that was kept, bundled, or one of match-r3, "];
        carom(here, line).fails(1, &words);
    }
}

#[test]
fn runs_started_in_the_same_second_have_separate_folders() {
    let folder = folder();
    let here = folder.path();
    let line = "train --config small.toml --steps 64 --evaluation-layouts 20";
    let children = [0; 3].map(|_| command(here, line).spawn().unwrap());
    for begun in children.map(outcome) {
        begun.ok();
    }
    assert_eq!(run_ok(here, "train --list --json").out.lines().count(), 3);
}

#[test]
fn a_run_can_start_from_the_weights_of_another() {
    let folder = folder();
    let here = folder.path();
    run_ok(here, &format!("{SHORT} --run one --table thesis"));
    let config = |run: &str| read_json(here.join(run).join("config.json"));
    let (weights, checkpoint) = ("one/policy.safetensors", "one/checkpoint.safetensors");
    for (from, run) in
        [("one", "of-run"), (weights, "of-policy"), (weights, "of-policy-again"), (checkpoint, "of-file")]
    {
        run_ok(here, &format!("train --from {from} --reward r1 --steps 64 --evaluation-layouts 20 --run {run}"));
        let (config, origin) = (config(run), &config(run)["from"]);
        assert_eq!((&origin["path"], &origin["seed"], &origin["shots"]), (&from.into(), &3.into(), &640.into()));
        assert_eq!((&origin["reward"], &config["reward"]), (&"r3".into(), &"r1".into()));
        assert_eq!((&config["table"]["name"], &config["settings"]["batch_size"]), (&"thesis".into(), &32.into()));
    }
    // Seed, table and settings are the same for all runs, and so are the final weights; only those from a policy file start with half of
    // the digits.
    let policy = |run: &str| fs::read(here.join(run).join("policy.safetensors")).unwrap();
    assert!(policy("of-run") == policy("of-file") && policy("of-policy") == policy("of-policy-again"));
    assert!(policy("of-policy") != policy("of-run") && policy("of-policy").len() == policy("of-run").len());
    run_ok(here, "train --config small.toml --reward r1 --steps 64 --evaluation-layouts 20 --table thesis --run none");
    assert!(policy("of-run") != policy("none"));

    let short = "--reward r1 --steps 64 --evaluation-layouts 20";
    run_ok(here, &format!("train --from one --set new_actor=true {short} --run anew"));
    run_ok(here, &format!("train --from anew {short} --run on"));
    let begins_anew = |run| config(run)["settings"]["new_actor"] == true;
    assert!(
        begins_anew("anew") && !begins_anew("on"),
        "an actor that began anew does not do so with every run that follows"
    );

    fs::write(here.join("large.toml"), "critic_layers = [24]").unwrap();
    for from in ["one", weights] {
        carom(here, &format!("train --from {from} --config large.toml --run large"))
            .fails(2, &["critic", "-16-1", "-24-1", "leave out the settings"]);
    }

    run_ok(here, "train --agent thesis-ddpg --table thesis --steps 100 --evaluation-layouts 5 --run thesis");
    let mut large = command(here, "train --from thesis --set actor_layers=[8] --run large");
    let large = outcome(large.env("RUST_BACKTRACE", "1").spawn().unwrap())
        .fails(2, &["actor with layers of 6-8-2 units", "leave out the settings"]);
    assert_eq!(large.err.lines().count(), 1, "{}", large.err);
    assert!(!here.join("large").exists());
}
