//! Helpers to start the program as a process with its own user folders, input and captured output.

use std::{
    fs,
    io::Write,
    ops::{Deref, DerefMut},
    path::{Path, PathBuf},
    process::{Child, Command, Output, Stdio},
};

use assert_cmd::cargo::cargo_bin;
use serde_json::Value;

/// Environment for the folders of settings, runs and practice: not those of the user who runs the tests. No test expects data there; a test
/// that needs data has its own folder.
pub fn home() -> impl Iterator<Item = (&'static str, String)> {
    ["HOME", "XDG_DATA_HOME", "XDG_CONFIG_HOME", "XDG_STATE_HOME"]
        .into_iter()
        .map(|name| (name, format!("{}/home/{name}", env!("CARGO_TARGET_TMPDIR"))))
}

/// Returns the program in this environment, with assertions on its output.
pub fn carom_command(args: &[&str]) -> assert_cmd::Command {
    let mut command = assert_cmd::Command::new(cargo_bin!("carom"));
    command.envs(home()).env_remove("LC_ALL").env_remove("LC_CTYPE").env("LANG", "C.UTF-8").args(args);
    command
}

/// A position with a shot that an expert makes sometimes.
pub const SAVE: &[&str] = &["save", "mine", "--layout", "-0.5,0 0,0 0.5,0.03", "--shot", "0,0.3,3,0.3,4"];

pub struct Outcome {
    pub code: Option<i32>,
    pub out: String,
    pub err: String,
}

impl Outcome {
    /// Parses the output as lines of JSON.
    pub fn json(&self) -> Vec<Value> {
        self.out.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
    }

    /// Asserts that the program succeeded.
    #[track_caller]
    pub fn ok(self) -> Self {
        assert_eq!(self.code, Some(0), "{}{}", self.out, self.err);
        self
    }

    /// Asserts that the program failed with this exit code, and that its error message contains all of these words.
    #[track_caller]
    pub fn fails(self, code: i32, words: &[&str]) -> Self {
        assert_eq!(self.code, Some(code), "{}{}", self.out, self.err);
        assert!(words.iter().all(|word| self.err.contains(word)), "{words:?} are not all in: {}", self.err);
        self
    }
}

impl From<Output> for Outcome {
    fn from(output: Output) -> Self {
        let text = |bytes| String::from_utf8(bytes).unwrap();
        Self { code: output.status.code(), out: text(output.stdout), err: text(output.stderr) }
    }
}

/// Runs a command to its end.
pub fn finished(command: &mut assert_cmd::Command) -> Outcome {
    command.output().unwrap().into()
}

pub fn run(args: &[&str]) -> Outcome {
    finished(&mut carom_command(args))
}

/// Runs a command on the lines of a batch.
pub fn batch(args: &[&str], lines: impl Into<Vec<u8>>) -> Outcome {
    finished(carom_command(&[args, &["--batch", "-"]].concat()).write_stdin(lines))
}

/// Returns the standard output of a command that must succeed.
#[track_caller]
pub fn stdout(args: &[&str]) -> String {
    run(args).ok().out
}

/// Returns the one JSON object that a command prints, which must succeed.
#[track_caller]
pub fn json_answer(args: &[&str]) -> Value {
    serde_json::from_str(&stdout(args)).unwrap()
}

/// Returns a user folder with the position `mine`.
pub fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    drill(folder.path(), SAVE).ok();
    folder
}

pub fn command(folder: &Path, args: &[&str]) -> Command {
    let mut command = program(folder, cargo_bin!("carom"));
    command.args(args);
    command
}

/// Returns a command whose user folders are in `folder`.
pub fn program(folder: &Path, program: &Path) -> Command {
    let mut command = Command::new(program);
    command.current_dir(folder).env("XDG_DATA_HOME", folder).env("HOME", folder);
    command.env_remove("LC_ALL").env_remove("LC_CTYPE").env("LANG", "C.UTF-8");
    command.env("XDG_CONFIG_HOME", folder.join("config")).env("XDG_STATE_HOME", folder.join("state"));
    command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

pub fn carom(folder: &Path, args: &[&str]) -> Outcome {
    outcome(command(folder, args).spawn().unwrap())
}

pub fn drill(folder: &Path, args: &[&str]) -> Outcome {
    carom(folder, &[&["drill"], args].concat())
}

/// Runs a command with these lines on the standard input.
pub fn run_with_input(mut command: Command, lines: &str) -> Outcome {
    let mut child = command.stdin(Stdio::piped()).spawn().unwrap();
    // A program that ends early does not read all of its input.
    let _ = child.stdin.take().unwrap().write_all(lines.as_bytes());
    outcome(child)
}

pub fn outcome(child: Child) -> Outcome {
    child.wait_with_output().unwrap().into()
}

/// Returns the files of all sessions.
pub fn session_files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder.join("carom/sessions")).into_iter().flatten();
    let files = entries.map(|entry| entry.unwrap().path());
    files.filter(|file| file.extension().is_some_and(|extension| extension == "json")).collect()
}

/// Returns the number of attempts at `mine` that the program finds in its files; it must report no problem.
pub fn count_attempts(folder: &Path) -> u64 {
    let history = drill(folder, &["history", "--json"]);
    assert!(history.code == Some(0) && history.err.is_empty(), "{}", history.err);
    history.json().iter().map(|row| row["tried"].as_u64().unwrap()).sum()
}

/// A process that is ended when the test ends, even after a failure.
pub struct KillOnDrop(pub Child);

impl Deref for KillOnDrop {
    type Target = Child;

    fn deref(&self) -> &Child {
        &self.0
    }
}

impl DerefMut for KillOnDrop {
    fn deref_mut(&mut self) -> &mut Child {
        &mut self.0
    }
}

impl Drop for KillOnDrop {
    fn drop(&mut self) {
        // After a successful test it has already ended.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}
