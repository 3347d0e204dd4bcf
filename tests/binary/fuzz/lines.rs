//! JSON Lines to the real program: every line is answered, and no control character reaches the output.

use std::{
    io::Write,
    process::{Command, Stdio},
    thread,
};

use carom::printing::is_hidden;
use proptest::{
    prelude::*,
    strategy::ValueTree,
    test_runner::{Config, TestRunner},
};

use super::mutation::mutated;
use crate::program::home;

const LINE: &str = r#"{"preset":"match","layout":[[-0.5,0],[0,0],[0.5,0.03]],"cue":{"a":0.1,"b":0.3,"theta_deg":5,"phi_deg":1,"speed":4},"rule":"straight"}"#;

/// Runs `args` on this many damaged lines.
fn check(args: &[&str], lines: usize) {
    let (mut runner, mutated) = (TestRunner::new(Config::default()), mutated(LINE.as_bytes().to_vec()));
    let line = |runner: &mut TestRunner| {
        let mut line = mutated.new_tree(runner).unwrap().current();
        line.retain(|byte| *byte != b'\n');
        line
    };
    let lines: Vec<_> = (0..lines).map(|_| line(&mut runner)).collect();
    let asked = lines.iter().filter(|line| !line.trim_ascii().is_empty()).count();
    let mut child = Command::new(env!("CARGO_BIN_EXE_carom"))
        .args(args)
        .envs(home())
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut input = child.stdin.take().unwrap();
    let feeder = thread::spawn(move || input.write_all(&lines.join(&b'\n')));
    let output = child.wait_with_output().unwrap();
    let _ = feeder.join().unwrap();
    assert_eq!(output.status.code(), Some(2), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).unwrap();
    assert_eq!(text.lines().count(), asked);
    for line in text.lines() {
        assert!(!line.chars().any(is_hidden), "{line:?}");
        let answer: serde_json::Value = serde_json::from_str(line).unwrap();
        assert!(answer.is_object(), "{line}");
    }
}

#[test]
fn simulate_batch() {
    check(&["simulate", "--batch", "-"], 10 * Config::default().cases as usize);
}

#[test]
fn recommend_batch() {
    check(&["recommend", "--policy-only", "--batch", "-"], 4 * Config::default().cases as usize);
}

#[test]
fn plain_mode() {
    let (mut runner, words) = (
        TestRunner::new(Config::default()),
        prop::sample::select(vec![
            "where",
            "balls -0.5,0 0,0 0.5,0.03",
            "move white up 5",
            "rule three-cushion",
            "skill expert",
            "plan on",
            "margins",
            "other",
            "undo",
            "help",
            "random",
            "opening",
            "go on",
            "tell",
        ]),
    );
    let mut input_text = Vec::new();
    for _ in 0..Config::default().cases {
        let order = words.new_tree(&mut runner).unwrap().current();
        let mut line = mutated(order.into()).new_tree(&mut runner).unwrap().current();
        line.retain(|byte| *byte != b'\n');
        input_text.extend(line);
        input_text.push(b'\n');
    }
    // Some lines ask the coach, who must answer quickly.
    let config = tempfile::tempdir().unwrap();
    std::fs::create_dir(config.path().join("carom")).unwrap();
    std::fs::write(config.path().join("carom/config.toml"), "think_ms = 100\n").unwrap();
    let mut child = Command::new(env!("CARGO_BIN_EXE_carom"))
        .arg("--plain")
        .envs(home())
        .env("XDG_CONFIG_HOME", config.path())
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let mut input = child.stdin.take().unwrap();
    let feeder = thread::spawn(move || input.write_all(&input_text));
    let output = child.wait_with_output().unwrap();
    // The program may have understood "quit".
    let _ = feeder.join().unwrap();
    // Most lines are refused.
    assert!(matches!(output.status.code(), Some(0 | 2)), "{}", output.status);
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(!text.chars().any(|character| is_hidden(character) && !matches!(character, '\n' | '\t')));
}
