//! The accuracy study through the real binary: required results, without any requirement on time.

use std::{path::Path, time::Duration};

use serde_json::Value;

use crate::program::{carom_command, finished, json_answer, run, stdout};

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

fn quick(folder: &Path) -> Vec<Value> {
    run(&["accuracy", "--quick", "--shots", "48", "--json", "--out", folder.to_str().unwrap()]).ok().json()
}

#[test]
fn the_quick_study_meets_the_expected_accuracy() {
    let folder = tempfile::tempdir().unwrap();
    let rows = quick(folder.path());
    // The values themselves are checked by a test of the library.
    let files: Vec<&Value> = rows.iter().filter_map(|row| row.get("file")).collect();
    assert_eq!(files, ["shots", "hard", "contact", "flights"]);
    for (table, steepest) in [("textbook", 20.0), ("thesis", 20.0), ("match", 60.0)] {
        let is_of = |row: &&Value| row["table"] == table && row["steepest_deg"] == steepest;
        let of_table: Vec<&Value> = rows.iter().filter(is_of).collect();
        let row = |method: &str, dt: Option<f64>| {
            let found = of_table.iter().find(|row| row["method"] == method && row["dt"].as_f64() == dt);
            *found.unwrap_or_else(|| panic!("no row of {method}, {dt:?}"))
        };
        let median = |row: &Value| number(&row["rest_m"]["median"]);
        let engine = row("engine", None);
        // Even the smallest time step is less accurate than the engine by many orders of magnitude, and each step of a tenth is more
        // accurate than the previous one.
        let steps = [1e-2, 1e-3, 1e-4].map(|dt| median(row("steps", Some(dt))));
        assert!(median(engine) < 1e-8 * steps[2], "{engine}");
        assert!(steps[0] > steps[1] && steps[1] > steps[2], "{steps:?}");
        // The reference engine shares no code with the engine: both are right or both are wrong in the same way.
        assert!(number(&row("plain, roots between extrema", None)["rest_units"]["median"]) < 10.0);
        assert!(median(row("plain, f32", None)) > 1e6 * median(engine));
        assert!(number(&engine["rest_units"]["median"]) <= 2.0, "{engine}");
        // When balls chatter against each other, an engine may report the following impacts in another order.
        assert!(number(&engine["wrong_sequence"]["count"]) <= if table == "thesis" { 1.0 } else { 0.0 }, "{engine}");
        assert_eq!(engine["flips_straight"]["count"], 0);
        assert_eq!(engine["failed"], 0);
        assert!(number(&engine["energy"]["median"]) < 1e-14, "{engine}");
        assert!(number(&engine["cost_us"]) > 0.0);
    }
    for file in ["error-vs-time.svg", "error-vs-condition.svg"] {
        let text = std::fs::read_to_string(folder.path().join(file)).unwrap();
        assert!(text.starts_with("<svg") && text.ends_with("</svg>\n") && !text.contains("NaN"), "{file}");
    }
    let csv = std::fs::read_to_string(folder.path().join("accuracy.csv")).unwrap();
    let columns: Vec<usize> = csv.lines().map(|line| line.matches(',').count()).collect();
    // The name of a method may contain one comma, in quotes.
    assert!(columns.iter().all(|count| (columns[0]..=columns[0] + 1).contains(count)), "{columns:?}");
}

#[test]
fn the_study_can_judge_a_named_table() {
    let rows = run(&["accuracy", "--quick", "--shots", "48", "--table", "match", "--json"]).ok().json();
    let summary = rows.iter().find(|row| row.get("judged").is_some()).unwrap();
    assert_eq!(summary["judged"]["count"], 48, "{summary}");
    assert!(number(&summary["truth_energy"]["worst"]) < 1e-29, "{summary}");
    let engine = rows.iter().find(|row| row["method"] == "engine").unwrap();
    assert!(number(&engine["rest_units"]["median"]) <= 2.0, "{engine}");
    assert_eq!((&engine["wrong_sequence"]["count"], &engine["failed"]), (&Value::from(0), &Value::from(0)));
    assert!(number(&engine["energy"]["median"]) < 1e-14, "{engine}");
    // Time steps detect the start of the roll bands late, like all other events, and do not stop the ball there.
    let steps = |dt: f64| rows.iter().find(|row| row["method"] == "steps" && row["dt"].as_f64() == Some(dt)).unwrap();
    let error = |dt: f64| number(&steps(dt)["rest_m"]["median"]);
    assert!(error(1e-4) < 0.3 * error(1e-3), "{} {}", error(1e-3), error(1e-4));
}

#[test]
fn the_same_seed_gives_the_same_errors() {
    let errors = || -> Vec<String> {
        let output = run(&["accuracy", "--quick", "--shots", "3", "--seed", "5", "--table", "textbook", "--json"]);
        output.json().iter().map(|row| format!("{} {} {}", row["method"], row["rest_m"], row["time_s"])).collect()
    };
    assert_eq!(errors(), errors());
}

#[test]
fn invalid_input_exits_with_two_and_names_accepted_values() {
    for (arguments, words) in [
        (vec!["accuracy", "--shots", "0"], "from 1 to 1000000000"),
        (vec!["simulate", "--shot", "0,0,0,0,3", "--dt", "0.1"], "--method steps"),
        (vec!["simulate", "--shot", "0,0,0,0,3", "--method", "steps", "--dt", "7"], "accepted is 3e-7 to 1 s"),
    ] {
        assert_eq!(run(&arguments).fails(2, &[words]).out, "");
    }
}

#[test]
fn a_folder_that_cannot_be_created_is_named() {
    let file = tempfile::NamedTempFile::new().unwrap();
    let folder = file.path().join("inside");
    let folder = folder.to_str().unwrap();
    run(&["accuracy", "--quick", "--shots", "1", "--table", "textbook", "--out", folder]).fails(1, &["accuracy.csv"]);
}

/// Regression test: the problem was reported only after all measurements, after three minutes or an hour.
#[test]
fn an_unwritable_output_folder_is_reported_before_measuring() {
    let file = tempfile::NamedTempFile::new().unwrap();
    let out = file.path().to_str().unwrap();
    for arguments in [
        &["accuracy", "--shots", "1000000", "--table", "textbook"][..],
        &["accuracy", "--stability", "--shots", "100000000"],
        &["accuracy", "--filmed"],
        &["reproduce", "--figure", "29", "--episodes", "100000000"],
    ] {
        let mut command = carom_command(&[arguments, &["--out", out]].concat());
        let output = finished(command.timeout(Duration::from_secs(20)));
        let message = output.err;
        assert_eq!((output.code, message.lines().count()), (Some(1), 1), "{arguments:?}: {message}");
        assert!(message.contains(out) && message.contains("is not a folder") && output.out.is_empty(), "{message}");
    }
}

#[test]
fn fit_is_refused_with_options_that_would_skip_it() {
    for more in [&["--quick"][..], &["--stability", "--quick"], &["--shots", "1"], &["--filmed", "--out", "here"]] {
        let mut command = carom_command(&[&["accuracy", "--fit"], more].concat());
        let output = finished(command.timeout(Duration::from_secs(20)));
        assert!(output.code == Some(2) && output.out.is_empty(), "{more:?}");
    }
}

#[test]
fn simulate_shows_the_errors_of_fixed_time_steps() {
    let shot = ["simulate", "--shot", "0,0.2,5,12.5,3", "--json"];
    let play = |more: &[&str]| json_answer(&[&shot[..], more].concat());
    let (exact, coarse) = (play(&[]), play(&["--method", "steps", "--dt", "0.01"]));
    let located = play(&["--method", "steps", "--dt", "0.01", "--locate"]);
    let apart = |one: &Value, other: &Value| {
        let x = |value: &Value| number(&value["final"][0][0]);
        (x(one) - x(other)).abs()
    };
    assert!(apart(&exact, &coarse) > 1e-3 && apart(&exact, &located) < 1e-10);
    assert!(number(&coarse["deepest_overlap"]) > 1e-3 && coarse["at_rest"] == true && exact.get("steps").is_none());
    let text = stdout(&["simulate", "--shot", "0,0.2,5,12.5,3", "--method", "steps", "--dt", "0.01"]);
    assert!(text.contains("deepest overlap"));
}
