//! `carom bench` through the real binary.

use assert_cmd::Command;
use serde_json::Value;

use crate::program::carom_command;

fn bench(args: &[&str]) -> Command {
    carom_command(&[&["bench"], args].concat())
}

#[test]
fn bench_prints_every_rate_in_one_json_object() {
    let output = bench(&["--seconds", "0.05", "--json"]).assert().success().get_output().stdout.clone();
    let text = String::from_utf8(output).unwrap();
    assert_eq!(text.lines().count(), 1, "one object, one line");
    let report: Value = serde_json::from_str(&text).unwrap();
    assert!(!report["machine"]["cpu"].as_str().unwrap().is_empty());
    assert!(report["machine"]["threads"].as_u64().unwrap() >= 1);
    let figures = report["figures"].as_array().unwrap();
    for (what, table) in [
        ("scored shots", "match"),
        ("scored shots", "thesis"),
        ("recorded shots", "match"),
        ("recorded shots", "thesis"),
        ("recommendations", "match"),
        ("network decisions", "match"),
        ("network updates", "match"),
    ] {
        let one = figures.iter().find(|figure| figure["what"] == what && figure["table"] == table);
        assert!(one.is_some_and(|one| one["per_second"].as_f64().unwrap() > 0.0), "{what} on {table}: {one:?}");
    }
    assert_eq!(figures.iter().filter(|figure| figure["sizes"].is_string()).count(), 8);
}

#[test]
fn bench_prints_one_line_of_text_per_rate() {
    let output = bench(&["--seconds", "0.01"]).assert().success().get_output().stdout.clone();
    let text = String::from_utf8(output).unwrap();
    assert!(text.lines().count() == 20 && text.lines().skip(1).all(|line| line.contains(" /s")), "{text}");
}

#[test]
fn an_invalid_measuring_time_is_refused_and_named() {
    for wrong in ["0", "-1", "NaN", "inf"] {
        let output = bench(&["--seconds", wrong]).output().unwrap();
        let message = String::from_utf8(output.stderr).unwrap();
        assert_eq!((output.status.code(), message.lines().count()), (Some(2), 1), "{message}");
        assert!(output.stdout.is_empty() && message.contains(wrong), "{message}");
    }
}
