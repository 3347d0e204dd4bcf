//! Other processes watch a run: while it trains, after its end, and when it or its files are damaged.

use std::{
    fs,
    io::{BufRead, BufReader, Read},
    path::Path,
    process::Child,
    thread,
    time::{Duration, Instant},
};

use serde_json::Value;

use super::common::{SHORT, carom, command, folder, read_json, run_ok, run_unfinished, start, wait_for};
use crate::program::outcome;

/// A run of a few seconds with many lines of metrics.
const LONG: &str = "train --config small.toml --steps 40000 --evaluate-every 8000 --evaluation-layouts 20 --seed 3";

/// Starts a process that watches, with captured output.
fn watch(here: &Path, line: &str) -> Child {
    command(here, line).spawn().unwrap()
}

/// Waits for a condition while `child` runs.
fn wait_until(child: &mut Child, what: &str, condition: impl Fn() -> bool) {
    let start = Instant::now();
    while !condition() {
        assert!(child.try_wait().unwrap().is_none(), "the run ended before {what}");
        assert!(start.elapsed() < Duration::from_secs(30), "never: {what}");
        thread::sleep(Duration::from_millis(10));
    }
}

fn signal(child: &Child, name: &str) {
    let status = std::process::Command::new("kill").args([&format!("-{name}"), &child.id().to_string()]).status();
    assert!(status.unwrap().success());
}

#[test]
fn two_watchers_see_every_metrics_line_and_end_with_the_run() {
    let folder = folder();
    let here = folder.path();
    let run = here.join("run");
    let mut training = start(here, &format!("{LONG} --run run"));
    wait_for(&run.join("metrics.jsonl"), &mut training);
    let watchers = ["watch run --json", "watch run"].map(|line| watch(here, line));
    let early = fs::read_to_string(run.join("metrics.jsonl")).unwrap();
    assert!(training.try_wait().unwrap().is_none() && !early.contains("timesteps\":40000"), "it is still training");
    let [json, plain] = watchers.map(outcome);
    assert!(training.wait().unwrap().success());
    let metrics = fs::read_to_string(run.join("metrics.jsonl")).unwrap();
    let metrics: Vec<Value> = metrics.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert_eq!((json.code, json.json()), (Some(0), metrics));
    assert_eq!((plain.code, plain.out.lines().count()), (Some(0), 5), "{}{}", plain.out, plain.err);
    assert!(plain.out.lines().all(|line| line.contains("held-out reward")), "{}", plain.out);
    assert!(plain.err.contains("the run is training") && plain.err.contains("the run is finished"), "{}", plain.err);
    // A late watcher sees the same.
    assert_eq!(run_ok(here, "watch run --json").out, json.out);
}

#[test]
fn a_killed_run_is_reported_dead_and_a_hangup_is_survived() {
    let folder = folder();
    let here = folder.path();
    let run = here.join("run");
    let mut training = start(here, &format!("{LONG} --steps 4000000 --run run").replace("--steps 40000 ", ""));
    wait_for(&run.join("metrics.jsonl"), &mut training);
    signal(&training, "HUP");
    let before = fs::metadata(run.join("metrics.jsonl")).unwrap().len();
    wait_until(&mut training, "lines after the terminal was hung up", || {
        fs::metadata(run.join("metrics.jsonl")).unwrap().len() > before
    });
    let mut watcher = watch(here, "watch run");
    let mut messages = BufReader::new(watcher.stderr.take().unwrap());
    let mut text = String::new();
    // Its first sentence says that it watches the run.
    messages.read_line(&mut text).unwrap();
    training.kill().unwrap();
    training.wait().unwrap();
    messages.read_to_string(&mut text).unwrap();
    assert_eq!(outcome(watcher).code, Some(1));
    assert!(text.contains("the run died") && text.contains("carom train --resume"), "{text}");
}

#[test]
fn a_resumed_run_can_be_watched() {
    let folder = folder();
    let here = folder.path();
    run_unfinished(here, &format!("{} --run run --minutes 0.005", LONG.replace("40000", "120000")));
    let list = |state: &str| {
        let run = run_ok(here, "train --list . --json").json().remove(0);
        assert_eq!(run["state"], state, "{run}");
        run["last_reward"].as_f64().unwrap()
    };
    assert!(list("stopped") >= 0.0, "the reward at the stop is known");
    let mut training = start(here, "train --resume run");
    let watcher = outcome(watch(here, "watch run")).ok();
    assert!(training.wait().unwrap().success());
    assert!(watcher.err.contains("the run is training") && watcher.err.contains("finished"), "{}", watcher.err);
    list("finished");
}

#[test]
fn a_run_is_stopped_or_abandoned_by_a_request_file() {
    let folder = folder();
    let here = folder.path();
    for (word, is_kept) in [("stop", true), ("abandon", false)] {
        let run = here.join(word);
        let mut training = start(here, &format!("{LONG} --run {word}"));
        wait_for(&run.join("metrics.jsonl"), &mut training);
        fs::write(run.join("request"), "puase").unwrap();
        wait_until(&mut training, "the request is taken", || !run.join("request").exists());
        fs::write(run.join("request"), word).unwrap();
        assert_eq!(training.wait().unwrap().code(), Some(75), "{word}: it is not finished");
        assert_eq!(run.join("policy.safetensors").exists(), is_kept);
        assert_eq!(run.exists(), is_kept, "{word}");
    }
    // The report uses the run's own status, not its last line of metrics, which may be older.
    let stopped = run_ok(here, "watch stop");
    let standing = read_json(here.join("stop/state.json"));
    assert!(standing["warning"].as_str().unwrap().contains("\"puase\" is not understood"), "{standing}");
    let reward = standing["held_out_reward"].as_f64().unwrap();
    let expected =
        format!("the run was stopped after {} shots, held-out reward {reward:.4}; resume with", standing["shots"]);
    assert!(stopped.err.contains(&expected), "{expected}: {}", stopped.err);
}

#[cfg(unix)]
#[test]
fn a_second_signal_skips_only_the_final_measurement() {
    let folder = folder();
    let here = folder.path();
    let run = here.join("run");
    let line = "train --config small.toml --steps 100000000 --evaluate-every 100000000 --set calibrated=0";
    let mut training = start(here, &format!("{line} --evaluation-layouts 6000 --run run"));
    let standing = || -> Value {
        serde_json::from_slice(&fs::read(run.join("state.json")).unwrap_or_default()).unwrap_or_default()
    };
    wait_until(&mut training, "it has played", || standing()["shots"].as_u64() > Some(0));
    signal(&training, "TERM");
    wait_until(&mut training, "it is measured", || standing()["phase"] == "stopping");
    let shots = standing()["shots"].clone();
    signal(&training, "TERM");
    assert_eq!(training.wait().unwrap().code(), Some(75));
    let listed = || run_ok(here, "train --list . --json").json().remove(0);
    let start = Instant::now();
    while listed()["state"] != "stopped" {
        assert!(start.elapsed() < Duration::from_secs(10), "{}", listed());
        thread::sleep(Duration::from_millis(100));
    }
    let resumed = run_unfinished(here, "train --resume run --minutes 0.0000001");
    assert!(resumed.out.contains(&format!("after {shots} shots")), "{shots}: {}", resumed.out);
}

#[test]
fn damaged_run_files_are_each_reported_in_a_sentence() {
    let folder = folder();
    let here = folder.path();
    run_ok(here, &format!("{SHORT} --run run"));
    let lines = fs::read_to_string(here.join("run/metrics.jsonl")).unwrap();
    let settings = fs::read_to_string(here.join("run/config.json")).unwrap();
    let newer = settings.replacen("\"version\": \"0", "\"version\": \"90", 1);
    let unknown = newer.replacen("\"reward\": \"r3\"", "\"reward\": \"r9\"", 1);
    let half = lines.lines().take(20).map(|line| line.to_owned() + "\n").collect::<String>();
    let unread = lines.replacen("time/fps", "time/other", 2);
    // For each case: the file of the run, its content, the expected sentence, and the number of displayed lines if it matters.
    let cases: [(&str, &str, &str, Option<usize>); 9] = [
        ("metrics.jsonl", &lines[..lines.len() - 20], "the last line of metrics.jsonl is cut off", Some(9)),
        ("metrics.jsonl", &unread, "2 lines of metrics.jsonl cannot be read", None),
        ("metrics.jsonl", "", "emptied or cut off: it ends after 0 of the 640 shots", Some(0)),
        ("metrics.jsonl", &half, "emptied or cut off: it ends after 320 of the 640 shots", None),
        ("config.json", &newer, "which is newer than this one", None),
        ("config.json", &unknown, "config.json was written by carom 90", Some(10)),
        ("config.json", "{", "config.json cannot be read", None),
        ("state.json", "[]", "state.json cannot be read", None),
        ("shots.json", "bla", "shots.json cannot be read", None),
    ];
    let copy = |name: &str| {
        let run = here.join(name);
        fs::create_dir(&run).unwrap();
        for entry in fs::read_dir(here.join("run")).unwrap() {
            let entry = entry.unwrap();
            fs::copy(entry.path(), run.join(entry.file_name())).unwrap();
        }
        run
    };
    let look = |name: &str, what: &str, count: Option<usize>| {
        let seen = carom(here, &format!("watch {name}"));
        assert!(seen.err.contains(what), "{what}: {}", seen.err);
        assert!(count.is_none_or(|count| seen.out.lines().count() == count), "{what}: {}", seen.out);
    };
    // A watcher waits a second for late output, so all cases run at the same time.
    thread::scope(|scope| {
        for (n, (file, text, what, count)) in cases.into_iter().enumerate() {
            let name = format!("case-{n}");
            fs::write(copy(&name).join(file), text).unwrap();
            scope.spawn(move || look(&name, what, count));
        }
        fs::remove_file(copy("missing").join("metrics.jsonl")).unwrap();
        scope.spawn(|| look("missing", "metrics.jsonl is missing", Some(0)));
        let folder = copy("folder").join("metrics.jsonl");
        fs::remove_file(&folder).unwrap();
        fs::create_dir(&folder).unwrap();
        scope.spawn(|| look("folder", "metrics.jsonl cannot be read", None));
    });
    let list = run_ok(here, "train --list .");
    assert!(list.err.contains("case-5: config.json was written by carom 90"), "{}", list.err);
    assert!(!list.out.lines().any(|line| line.contains("case-5") && line.contains("ddpg")), "{}", list.out);
    // Numbers that are not finite are written by name, and all readers accept them.
    let odd = lines.replacen("\"train/critic_loss\":0", "\"train/critic_loss\":\"NaN\",\"was\":0", 1);
    fs::write(here.join("run/metrics.jsonl"), odd).unwrap();
    let json = carom(here, "watch run --json");
    assert!(json.out.contains("\"train/critic_loss\":\"NaN\""), "{}", json.out);
}

#[test]
fn runs_are_found_by_name_or_latest_and_listed_otherwise() {
    let folder = folder();
    let here = folder.path();
    carom(here, "watch latest").fails(1, &["carom train"]);
    assert!(carom(here, "train --resume latest").err.contains("there are no runs in"));
    for call in ["watch", "watch --json"] {
        assert!(run_ok(here, call).err.contains("no runs in"), "{call}");
    }
    carom(here, "watch nowhere").fails(1, &["there is no run nowhere"]);
    run_ok(here, SHORT);
    thread::sleep(Duration::from_millis(20));
    run_ok(here, &SHORT.replace("--seed 3", "--seed 4"));
    let list = run_ok(here, "watch").out;
    let name =
        list.lines().find_map(|line| line.split_whitespace().next().filter(|name| name.ends_with("-4"))).unwrap();
    assert_eq!(run_ok(here, "watch latest --json").out, run_ok(here, &format!("watch {name} --json")).out);
    let resumed = run_ok(here, "train --resume latest");
    assert!(resumed.err.contains(name) && resumed.err.contains("is finished"), "{}", resumed.err);
    let dumb = outcome(command(here, "watch latest").env("TERM", "dumb").spawn().unwrap());
    assert_eq!(dumb.out.lines().count(), 10, "{}", dumb.err);
    assert!(dumb.err.lines().next().is_some_and(|first| first.contains(name)), "{}", dumb.err);
}
