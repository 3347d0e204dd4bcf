//! `carom evaluate` in parts: merged, they report the same as a single process.

use std::{fs, path::Path, time::Duration};

use serde_json::Value;

use crate::program::{Outcome, carom, carom_command, finished, json_answer, run};

const WHOLE: &str = "evaluate --rule three-cushion --layouts 7 --simulations 800";

fn words(line: &str) -> Vec<&str> {
    line.split_whitespace().collect()
}

fn json(line: &str) -> Value {
    json_answer(&words(&format!("{line} --json")))
}

/// Returns the text that a command prints, which must succeed.
fn text(line: &str) -> String {
    run(&words(line)).ok().out
}

/// Measures a part into a file and returns the path.
fn part(folder: &Path, line: &str, shard: &str) -> String {
    let path = folder.join(format!("{}.json", shard.replace('/', "-of-")));
    fs::write(&path, text(&format!("{line} --shard {shard}"))).unwrap();
    path.display().to_string()
}

/// Removes the values that depend on the speed of the machine.
fn without_timings(mut report: Value) -> Value {
    for name in ["layouts_per_second", "slowest_ms", "mean_ms"] {
        report.as_object_mut().unwrap().remove(name);
    }
    report
}

#[test]
fn merged_parts_equal_a_single_evaluation() {
    let folder = tempfile::tempdir().unwrap();
    let kinds = [" --skill club", " --self-play --skill expert --most-points 2", " --random-search 20"];
    for kind in kinds {
        let line = match kind {
            " --random-search 20" => "evaluate --layouts 7".to_owned() + kind,
            kind => WHOLE.to_owned() + kind,
        };
        // The order of the files does not matter.
        let parts = ["3/3", "1/3", "2/3"].map(|shard| part(folder.path(), &line, shard));
        let merged = json(&format!("evaluate --merge {}", parts.join(" ")));
        assert_eq!(without_timings(merged), without_timings(json(&line)), "{kind}");
    }
}

#[test]
fn evaluations_on_the_same_layouts_are_compared_pairwise() {
    let [folder, other] = [(); 2].map(|()| tempfile::tempdir().unwrap());
    let line = "evaluate --policy-only --rule three-cushion --layouts 40 --skill club";
    let context = part(folder.path(), line, "1/1");
    let flawless = part(other.path(), &format!("{line} --policy match-three-cushion"), "1/1");
    let compared = json(&format!("evaluate --merge {context} --against {flawless}"));
    let [low, high] = [0, 1].map(|end| compared["difference_interval"][end].as_f64().unwrap());
    assert!(compared["compared"] == "make_probability" && 0.0 < low && low < high, "{compared}");
    let chance = |policy: &str| json(&format!("{line}{policy}"))["robustness"]["make_probability"].as_f64().unwrap();
    let apart = chance("") - chance(" --policy match-three-cushion");
    assert!((compared["difference"].as_f64().unwrap() - apart).abs() < 1e-9, "{compared}");
    let text = text(&format!("evaluate --merge {context} --against {flawless}"));
    assert!(text.starts_with("difference of make probability on the same 40 layouts: +"));
    let elsewhere = part(other.path(), &line.replace("40", "41"), "1/1");
    run(&["evaluate", "--merge", &context, "--against", &elsewhere])
        .fails(2, &["the same layouts are compared: layouts 40 and 41"]);
}

/// The name of a policy does not identify it: the networks behind it may have changed between two parts.
#[test]
fn parts_of_different_networks_or_versions_are_not_merged() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let models = Path::new(env!("CARGO_MANIFEST_DIR")).join("models");
    let measured = |networks: &str, shard: &str| -> Value {
        fs::copy(models.join(networks), here.join("mine.safetensors")).unwrap();
        let line = format!("evaluate --policy mine.safetensors --layouts 2 --simulations 1 --shard {shard}");
        let part = carom(here, &words(&line)).ok();
        serde_json::from_str(&part.out).unwrap()
    };
    let merged = |one: &Value, other: &Value| {
        for (name, part) in [("one.json", one), ("other.json", other)] {
            fs::write(here.join(name), part.to_string()).unwrap();
        }
        carom(here, &["evaluate", "--merge", "one.json", "other.json"])
    };
    let one = measured("match-r3.safetensors", "1/2");
    merged(&one, &measured("match-one-cushion.safetensors", "2/2")).fails(2, &["not by the same networks"]);
    let mut other = measured("match-r3.safetensors", "2/2");
    merged(&one, &other).ok();
    other["order"]["version"] = "0.0.1".into();
    merged(&one, &other).fails(2, &["by different versions of carom"]);
    // Earlier versions wrote neither of them.
    for name in ["version", "checksum"] {
        assert!(other["order"].as_object_mut().unwrap().remove(name).is_some_and(|value| value.is_string()), "{name}");
    }
    merged(&one, &other).ok();
    merged(&other, &one).ok();
}

#[test]
fn innings_not_started_in_time_are_counted() {
    let folder = tempfile::tempdir().unwrap();
    let line = "evaluate --self-play --layouts 5 --simulations 1 --most-points 1";
    let short = format!("{line} --minutes 0.000000000001");
    let parts = ["1/2", "2/2"].map(|shard| part(folder.path(), &short, shard)).join(" ");
    for line in [short, format!("evaluate --merge {parts}")] {
        let report = json(&line);
        assert_eq!((&report["layouts"], &report["innings"]), (&5.into(), &0.into()), "{line}");
        let text = text(&line);
        assert!(text.contains("; on 5 of 5 layouts none was started, because the time was up)"), "{text}");
    }
    let text = text(line);
    assert!(text.contains("in 5 innings (") && !text.contains("none was started"), "{text}");
}

#[test]
fn policy_only_evaluation_names_the_bundled_networks() {
    let line = "evaluate --policy-only --rule three-cushion --layouts 5";
    for (rest, networks) in [("", "match-three-cushion"), (" --skill club", "context-three-cushion")] {
        let report = json(&format!("{line}{rest}"));
        assert_eq!((&report["policy"], &report["networks"]), (&"bundled".into(), &networks.into()));
        let text = text(&format!("{line}{rest}"));
        assert!(text.starts_with(&format!("policy bundled ({networks}) on \"match\"")), "{text}");
    }
    assert_eq!(json("evaluate --layouts 3 --random-search 5").get("networks"), None);
}

#[test]
fn merging_incomplete_or_mismatched_parts_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let line = "evaluate --layouts 4 --random-search 5";
    let [one, two] = ["1/3", "2/3"].map(|shard| part(folder.path(), line, shard));
    let other = tempfile::tempdir().unwrap();
    let stranger = part(other.path(), "evaluate --layouts 4 --random-search 6", "3/3");
    // A part with the same number, but of another number of parts or of another evaluation.
    let halves = part(other.path(), line, "1/2");
    let others = part(other.path(), "evaluate --layouts 4 --random-search 6", "1/3");
    let broken = folder.path().join("broken.json").display().to_string();
    fs::write(&broken, "{}").unwrap();
    let file = |name: &str, text: &str| {
        let path = folder.path().join(name);
        fs::write(&path, text).unwrap();
        path.display().to_string()
    };
    let cut = file("cut.json", &fs::read_to_string(&one).unwrap()[..300]);
    let (empty, prose, other_json) = (file("empty", ""), file("prose", "Notes"), file("list.json", "[7]"));
    for (files, expected) in [
        (vec![&one, &two], "part 3/3 is missing"),
        (vec![&one, &two, &one], "which another file holds too"),
        (vec![&one, &two, &stranger], "different evaluations: "),
        (vec![&one, &two, &stranger], " 5 and 6"),
        (vec![&one, &halves], "are parts of different evaluations: of 3 and of 2 parts"),
        (vec![&one, &others], "are parts of different evaluations: random_search 5 and 6"),
        (vec![&broken], "is not a part of an evaluation"),
        (vec![&cut], "it ends in the middle of line 1"),
        (vec![&empty], "it is empty"),
        (vec![&prose], "line 1, column 1 is not JSON"),
        (vec![&other_json], "line 1, column 2"),
    ] {
        let files: Vec<&str> = files.into_iter().map(String::as_str).collect();
        let Outcome { out, err: error, .. } =
            run(&[&["evaluate", "--merge"][..], &files].concat()).fails(2, &[expected]);
        assert!(out.is_empty(), "{out}");
        assert!(!["EOF", "missing field", "expected", "struct"].iter().any(|jargon| error.contains(jargon)), "{error}");
    }
    for shard in ["0/3", "4/3", "2", "a/b", "1/0", "1/4294967296"] {
        run(&["evaluate", "--shard", shard]).fails(2, &["K/N like 2/8, N up to 4294967295"]);
    }
}

/// Regression test: clap does not check what an option requires if a conflicting option is given. The option was silently ignored, and the
/// report named tables that were never played on.
#[test]
fn options_of_another_evaluation_mode_are_refused() {
    for line in [
        "--drawn-tables --budget-ms 5",
        "--drawn-tables --simulations 5",
        "--drawn-tables --random-search 5",
        "--drawn-tables --self-play --most-points 1",
        "--drawn-tables --plan",
        "--drawn-tables --no-jumps",
        "--most-points 3 --policy-only",
        "--most-points 3 --random-search 5",
        "--minutes 3 --policy-only",
        "--minutes 3 --random-search 5",
        "--reward r1 --plan",
        "--reward r1 --simulations 5",
    ] {
        let refused = run(&words(&format!("evaluate --layouts 1 {line}"))).fails(2, &[words(line)[0]]);
        assert!(refused.out.is_empty(), "{line}: {}", refused.out);
    }
}

/// Regression test: a raised cue had brought a ball above another; they met in the air endlessly, and the coach never answered.
#[test]
fn a_ball_that_stays_above_another_does_not_hang_the_engine() {
    let line = "evaluate --self-play --rule three-cushion --skill beginner --layouts 400 --simulations 90000 --seed 16";
    let line = format!("{line} --shard 54/400");
    let part = finished(carom_command(&words(&line)).timeout(Duration::from_secs(60))).ok();
    assert_eq!(part.json()[0]["records"]["innings"][0]["layout"], 53);
}
