//! Helpers of the training tests: small runs, and a comparison of two of them.

use std::{
    fs,
    path::{Path, PathBuf},
    process::{Child, Command, Stdio},
    time::Duration,
};

use serde_json::Value;

use crate::program::{self, KillOnDrop, Outcome, outcome};

/// An agent with thousands of updates per second.
pub const SMALL: &str = "\
actor_layers = [16]
critic_layers = [16]
batch_size = 32
actor_batch_size = 8
shots_per_update = 16
buffer_size = 5000
";

/// A run of 40 iterations with ten measurements.
pub const SHORT: &str = "train --config small.toml --steps 640 --evaluate-every 64 --evaluation-layouts 20 --seed 3";

/// Returns a folder with the settings of the small agent.
pub fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("small.toml"), SMALL).unwrap();
    folder
}

pub fn command(folder: &Path, line: &str) -> Command {
    program::command(folder, &line.split_whitespace().collect::<Vec<_>>())
}

pub fn carom(folder: &Path, line: &str) -> Outcome {
    outcome(command(folder, line).spawn().unwrap())
}

/// Runs carom, which must succeed.
pub fn run_ok(folder: &Path, line: &str) -> Outcome {
    let outcome = carom(folder, line);
    assert_eq!(outcome.code, Some(0), "{line}: {}", outcome.err);
    outcome
}

/// Runs carom, which must succeed and print one JSON object.
pub fn json_answer(folder: &Path, line: &str) -> Value {
    serde_json::from_str(&run_ok(folder, line).out).unwrap()
}

/// Returns the content of a JSON file.
pub fn read_json(file: impl AsRef<Path>) -> Value {
    serde_json::from_slice(&fs::read(file).unwrap()).unwrap()
}

/// Runs carom, which must stop before its end with the exit code for a resumable run.
pub fn run_unfinished(folder: &Path, line: &str) -> Outcome {
    let outcome = carom(folder, line);
    assert_eq!(outcome.code, Some(75), "{line}: {}", outcome.err);
    outcome
}

pub fn start(folder: &Path, line: &str) -> KillOnDrop {
    KillOnDrop(command(folder, line).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap())
}

/// Waits until the file exists, while the program runs.
pub fn wait_for(file: &Path, child: &mut Child) {
    while !file.exists() {
        assert!(child.try_wait().unwrap().is_none(), "the run ended by itself");
        std::thread::sleep(Duration::from_millis(10));
    }
}

/// All content of a run's folder that must not depend on the clock, and the names of all files. The previous checkpoint is excluded,
/// because the time at which it was written depends on the clock.
#[derive(PartialEq)]
pub struct RunFiles {
    names: Vec<PathBuf>,
    policy: Vec<u8>,
    checkpoint: Vec<u8>,
    metrics: Vec<Value>,
    config: Value,
}

impl RunFiles {
    pub fn of(run: &Path) -> Self {
        let mut names: Vec<_> = fs::read_dir(run).unwrap().map(|entry| entry.unwrap().file_name().into()).collect();
        names.sort();
        let read = |name: &str| fs::read(run.join(name)).unwrap();
        let metrics = String::from_utf8(read("metrics.jsonl")).unwrap();
        let metrics = metrics.lines().map(|line| without_fields(line, &["time/time_elapsed", "time/fps"])).collect();
        let config = without_fields(&String::from_utf8(read("config.json")).unwrap(), &["started"]);
        Self { names, policy: read("policy.safetensors"), checkpoint: read("checkpoint.safetensors"), metrics, config }
    }

    /// Asserts equality, and names the difference in a readable way instead of printing bytes.
    pub fn assert_same(&self, other: &Self, what: &str) {
        assert_eq!(self.names, other.names, "{what}");
        assert_eq!(self.config, other.config, "{what}");
        assert_eq!(self.metrics, other.metrics, "{what}");
        assert!(self.checkpoint == other.checkpoint, "{what}: the checkpoints differ");
        assert!(self.policy == other.policy, "{what}: the policies differ");
    }
}

fn without_fields(text: &str, names: &[&str]) -> Value {
    let mut value: Value = serde_json::from_str(text).unwrap();
    for name in names {
        assert!(value.as_object_mut().unwrap().remove(*name).is_some(), "{name} in {text}");
    }
    value
}
