//! Control characters in everything that others can write: none reaches the terminal, on any output.

use std::{fs, path::Path};

use carom::printing::is_hidden;

use crate::program::{carom, command, run_with_input};

/// Sets the title, colours text, reverses its direction, and starts another line.
const NAME: &str = "\u{1b}]0;pwn\u{7}\u{9b}31m\u{202e}\r\u{7f}";

/// The name as a string of JSON and of TOML.
fn quoted() -> String {
    NAME.chars().flat_map(|character| format!("\\u{:04x}", character as u32).into_bytes()).map(char::from).collect()
}

/// Asserts that the text contains no control character, and that the name is shown or escaped somewhere.
#[track_caller]
fn assert_escaped(what: &str, text: &str) {
    let hidden = |character: &char| is_hidden(*character) && !matches!(character, '\n' | '\t');
    assert_eq!(text.chars().find(hidden), None, "{what}: {text}");
    assert!(["u{9b}", "u009b", "u009B"].iter().any(|shown| text.contains(shown)), "{what} says nothing of it: {text}");
}

/// Runs the program and checks both outputs.
#[track_caller]
fn check(home: &Path, args: &[&str]) {
    let output = carom(home, args);
    assert_escaped(&args.join(" "), &(output.out + &output.err));
}

fn table_with_name(folder: &Path) {
    let text = carom(folder, &["table", "show", "thesis"]).out;
    let text = text.replace("name = \"thesis\"", &format!("name = \"{}\"", quoted()));
    fs::write(folder.join("name.toml"), &text).unwrap();
    fs::write(folder.join("key.toml"), format!("{text}\"{}\" = 1\n", quoted())).unwrap();
}

#[test]
fn imports() {
    let folder = tempfile::tempdir().unwrap();
    let exercise = |field: &str| {
        let mut exercise = serde_json::json!({
            "name": "mine", "category": "draw", "title": "t", "rule": "straight", "table": "match",
            "layout": [[-0.5, 0.0], [0.0, 0.0], [0.5, 0.03]],
        });
        exercise[field] = NAME.into();
        serde_json::json!({ "format": "carom-library", "version": 1, "exercises": [exercise] })
    };
    let format = serde_json::json!({ "format": NAME, "version": 1 });
    for file in ["name", "category", "rule", "table"].map(exercise).into_iter().chain([format]) {
        fs::write(folder.path().join("l.json"), file.to_string()).unwrap();
        check(folder.path(), &["drill", "import", "l.json"]);
        check(folder.path(), &["drill", "import", "l.json", "--json"]);
    }
}

#[test]
fn tables_and_arguments() {
    let folder = tempfile::tempdir().unwrap();
    table_with_name(folder.path());
    for order in ["check", "show"] {
        check(folder.path(), &["table", order, "name.toml"]);
        check(folder.path(), &["table", order, "name.toml", "--json"]);
    }
    check(folder.path(), &["table", "check", "key.toml"]);
    for args in [
        &[NAME][..],
        &["simulate", NAME],
        &["simulate", "--table", NAME, "--shot", "0,0,0,0,1"],
        &["simulate", "--layout", NAME, "--shot", "0,0,0,0,1"],
        &["simulate", "--batch", NAME],
        &["recommend", "--skill", NAME],
        &["recommend", "--policy", NAME, "--budget-ms", "1"],
        &["drill", "show", NAME],
        &["drill", "save", NAME, "--layout", "-0.5,0 0,0 0.5,0.03"],
        &["train", "--agent", NAME],
        &["train", "--set", NAME],
        &["train", "--resume", NAME],
        &["watch", NAME],
        &["man", NAME],
    ] {
        check(folder.path(), args);
    }
}

#[test]
fn input_lines() {
    let folder = tempfile::tempdir().unwrap();
    let plain = run_with_input(command(folder.path(), &["--plain"]), &format!("{NAME}\nrule {NAME}\nballs {NAME}\n"));
    assert_escaped("--plain", &(plain.out + &plain.err));
    let play = run_with_input(command(folder.path(), &["play"]), &format!("{NAME}\n"));
    assert_escaped("play", &(play.out + &play.err));
    let batch = format!("{{\"preset\":\"{}\",\"layout\":[[0,0],[1,0],[0,0.5]],\"cue\":null}}\n{NAME}\n", quoted());
    let batch = run_with_input(command(folder.path(), &["simulate", "--batch", "-"]), &batch);
    assert!(!(batch.out + &batch.err).chars().any(|character| is_hidden(character) && character != '\n'));
}

#[test]
fn settings_and_saved_files() {
    let folder = tempfile::tempdir().unwrap();
    let settings = folder.path().join("config/carom");
    fs::create_dir_all(&settings).unwrap();
    fs::write(settings.join("config.toml"), format!("\"{0}\" = 1\ntable = \"{0}\"\n", quoted())).unwrap();
    check(folder.path(), &["config", "--check"]);

    let positions = folder.path().join("carom/positions");
    fs::create_dir_all(&positions).unwrap();
    fs::write(positions.join(format!("{NAME}.json")), "{").unwrap();
    check(folder.path(), &["drill", "list"]);
}

#[test]
fn runs() {
    let folder = tempfile::tempdir().unwrap();
    let runs = folder.path().join("runs");
    let run = runs.join(NAME);
    let args = ["train", "--steps", "200", "--evaluation-layouts", "2", "--evaluate-every", "200", "--run"];
    let made = carom(folder.path(), &[&args[..], &[run.to_str().unwrap()]].concat()).ok();
    assert_escaped("train", &(made.out + &made.err));
    let text = fs::read_to_string(run.join("config.json")).unwrap();
    let mut config: serde_json::Value = serde_json::from_str(&text).unwrap();
    config["agent"] = NAME.into();
    config["table"]["name"] = NAME.into();
    fs::write(run.join("config.json"), config.to_string()).unwrap();
    let runs = runs.to_str().unwrap();
    check(folder.path(), &["train", "--list", runs]);
    check(folder.path(), &["train", "--list", runs, "--json"]);

    let text = fs::read_to_string(run.join("state.json")).unwrap();
    let mut state: serde_json::Value = serde_json::from_str(&text).unwrap();
    state["phase"] = "failed".into();
    state["reason"] = format!("{NAME}\nforged: all is well").into();
    state["warning"] = NAME.into();
    fs::write(run.join("state.json"), state.to_string()).unwrap();
    for json in [&[][..], &["--json"]] {
        let output = carom(folder.path(), &[&["watch", "--plain", run.to_str().unwrap()], json].concat());
        assert_escaped("watch", &output.err);
        assert!(!format!("\n{}", output.err).contains("\nforged"), "{}", output.err);
        assert!(!output.out.chars().any(|character| is_hidden(character) && character != '\n'), "{}", output.out);
    }
}
