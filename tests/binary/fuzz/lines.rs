//! JSON Lines to the real program: every line is answered, and no control character reaches the output.

use carom::printing::is_hidden;
use proptest::{
    prelude::*,
    strategy::ValueTree,
    test_runner::{Config, TestRunner},
};

use super::mutation::mutated;
use crate::program::{Outcome, carom_command, finished};

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
    let Outcome { code, out: text, err } = finished(carom_command(args).write_stdin(lines.join(&b'\n')));
    assert_eq!(code, Some(2), "{err}");
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
    // The program may understand "quit" and leave the rest of its input.
    let mut plain = carom_command(&["--plain"]);
    let output = finished(plain.env("XDG_CONFIG_HOME", config.path()).write_stdin(input_text));
    // Most lines are refused.
    assert!(matches!(output.code, Some(0 | 2)), "{:?}", output.code);
    assert!(!output.out.chars().any(|character| is_hidden(character) && !matches!(character, '\n' | '\t')));
}
