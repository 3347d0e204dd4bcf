//! The scripts of `docs/cluster.md`, run with Slurm, or with Python and Optuna.
//!
//! `cargo test --profile quick --test binary cluster:: -- --ignored`

use std::{
    env, fs,
    path::Path,
    process::Command,
    thread::sleep,
    time::{Duration, Instant},
};

use assert_cmd::cargo::cargo_bin;

/// Time limit for an array of jobs.
const TIMEOUT: Duration = Duration::from_secs(600);

/// Returns a folder with the script `name` of the page.
fn folder_with(name: &str) -> tempfile::TempDir {
    let page = fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/docs/cluster.md")).unwrap();
    let after = page.split_once(&format!(" {name}\n")).expect(name).1;
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join(name), after.split_once("```").unwrap().0).unwrap();
    folder
}

/// Runs a program in the folder with this carom on its path, and returns its output.
fn output(folder: &Path, program: &str, args: &[&str]) -> String {
    let carom = cargo_bin("carom");
    let path = format!("{}:{}", carom.parent().unwrap().display(), env::var("PATH").unwrap());
    let output = Command::new(program).args(args).current_dir(folder).env("PATH", path).output().expect(program);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

/// Submits the array and waits until all its tasks have ended.
fn run_array(folder: &Path, script: &str) {
    output(folder, "sbatch", &["--wait", script]);
}

#[test]
#[ignore = "needs Slurm"]
fn a_job_array_trains_every_seed() {
    let folder = folder_with("train.sbatch");
    run_array(folder.path(), "train.sbatch");
    let begin = Instant::now();
    for seed in 1..=3 {
        // A stopped task is queued again.
        let result = folder.path().join(format!("runs/seed-{seed}/result.json"));
        while !result.exists() {
            assert!(begin.elapsed() < TIMEOUT, "{}", result.display());
            sleep(Duration::from_secs(1));
        }
        assert!(fs::read_to_string(result).unwrap().contains(&format!("\"seed\": {seed}")));
    }
}

#[test]
#[ignore = "needs Slurm"]
fn parts_measured_by_a_job_array_are_merged() {
    let folder = folder_with("evaluate.sbatch");
    run_array(folder.path(), "evaluate.sbatch");
    let parts = ["part-1.json", "part-2.json", "part-3.json", "part-4.json"];
    let report = output(folder.path(), "carom", &[&["evaluate", "--merge"][..], &parts].concat());
    assert!(report.contains("of 20 layouts"), "{report}");
}

#[test]
#[ignore = "needs Python with Optuna"]
fn an_optuna_study_finds_the_best_trial() {
    let folder = folder_with("study.py");
    let best = output(folder.path(), "python3", &["study.py"]);
    assert!(best.contains("learning_rate") && best.starts_with("0."), "{best}");
    assert!(folder.path().join("runs/trial-2/result.json").exists());
}
