//! `carom bench` through the real binary.

use crate::program::{Outcome, run};

fn bench(args: &[&str]) -> Outcome {
    run(&[&["bench"], args].concat())
}

#[test]
fn bench_prints_every_rate_in_one_json_object() {
    let lines = bench(&["--seconds", "0.05", "--json"]).ok().json();
    let [report] = &lines[..] else { panic!("one object, one line") };
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
    let text = bench(&["--seconds", "0.01"]).ok().out;
    assert!(text.lines().count() == 20 && text.lines().skip(1).all(|line| line.contains(" /s")), "{text}");
}

#[test]
fn an_invalid_measuring_time_is_refused_and_named() {
    for wrong in ["0", "-1", "NaN", "inf"] {
        let Outcome { code, out, err } = bench(&["--seconds", wrong]);
        assert_eq!((code, err.lines().count()), (Some(2), 1), "{err}");
        assert!(out.is_empty() && err.contains(wrong), "{err}");
    }
}
