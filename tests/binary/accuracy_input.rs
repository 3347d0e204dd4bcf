//! What `carom accuracy` and the simulation methods accept and refuse, and which names they accept.

use std::{fs, path::PathBuf, time::Duration};

use carom::table::Table;

use crate::program::{Outcome, batch, carom_command, finished};

fn carom(arguments: &[&str]) -> Outcome {
    finished(carom_command(arguments).timeout(Duration::from_secs(60)))
}

/// Returns a folder with a file of the `match` table with these replacements, and the path of the file.
fn own_table(file: &str, exchanged: &[(&str, &str)]) -> (tempfile::TempDir, PathBuf) {
    let mut text = toml::to_string(&Table::default()).unwrap();
    for (from, to) in exchanged {
        assert!(text.contains(from), "{from} in {text}");
        text = text.replacen(from, to, 1);
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(file);
    fs::write(&path, text).unwrap();
    (folder, path)
}

#[test]
fn a_partial_study_skips_the_verdict() {
    let output = carom(&["accuracy", "--table", "textbook", "--shots", "1"]).ok();
    assert!(output.out.contains("steps, dt 1e-6 s") && !output.out.contains("verdict"), "{}", output.out);
    assert!(output.err.contains("--stability"), "{}", output.err);
}

#[test]
fn the_time_step_named_in_a_refusal_is_accepted() {
    let step = |shot: &str, dt: &str| carom(&["simulate", "--shot", shot, "--method", "steps", "--dt", dt]);
    let stderr_of = |dt: &str| step("0,0,0,0,3", dt).err;
    let refused = step("0,0,0,0,3", "0.00003");
    assert_eq!(refused.code, Some(2), "{}", refused.err);
    let named =
        refused.err.split("accepted is ").nth(1).and_then(|rest| rest.split(" s or more").next()).expect(&refused.err);
    // This takes seconds in a build without optimisation; only acceptance matters here.
    assert!(!stderr_of(named).contains("steps; accepted"), "{named}: {}", stderr_of(named));
    let least = stderr_of("1e-320");
    assert!(least.contains("dt = 1e-320 s") && least.contains("accepted is 3e-7 to 1 s"), "{least}");
    step("0,0,0,0,0.001", "3e-7").ok();
}

#[test]
fn a_table_of_another_size_than_the_films_is_refused() {
    let (_folder, small) = own_table("small.toml", &[("L = 2.84", "L = 2.54")]);
    for more in [&["--table", "thesis"][..], &["--table", "thesis", "--fit"], &["--table", small.to_str().unwrap()]] {
        let output = carom(&[&["accuracy", "--filmed"], more].concat()).fails(2, &["L = 2.54 m", "2.84 m"]);
        assert_eq!((output.out.as_str(), output.err.lines().count()), ("", 1), "{}", output.err);
    }
}

#[test]
fn an_unsupported_table_ends_the_study_with_the_reason() {
    for (exchanged, reason) in [
        (("name = \"match\"", "name = \"leaning\"\ntilt = [0.001, 0.0]"), "is not level"),
        (("model = \"smooth\"", "model = \"mathavan\""), "integrated"),
    ] {
        let (folder, path) = own_table("own.toml", &[exchanged]);
        let out = folder.path().join("report");
        let at = [path.to_str().unwrap(), out.to_str().unwrap()];
        let output = carom(&["accuracy", "--quick", "--shots", "3", "--table", at[0], "--out", at[1]])
            .fails(1, &[reason, "none of the 3 shots"]);
        assert_eq!(output.out, "");
        assert!(!out.join("accuracy.csv").exists());
    }
}

#[test]
fn a_table_name_with_a_comma_stays_one_csv_field() {
    let (folder, path) = own_table("a table.toml", &[("name = \"match\"", "name = \"my \\\"big\\\", table\"")]);
    let out = folder.path().join("report");
    let at = [path.to_str().unwrap(), out.to_str().unwrap()];
    let output = carom(&["accuracy", "--quick", "--shots", "3", "--table", at[0], "--out", at[1]]).ok();
    let csv = fs::read_to_string(out.join("accuracy.csv")).unwrap();
    let mut columns: Vec<usize> = csv.lines().map(columns_of).collect();
    columns.dedup();
    assert_eq!(columns.len(), 1, "{csv}");
    assert!(csv.contains("\"my \"\"big\"\", table\","), "{csv}");
    let again = output.out.lines().find(|line| line.starts_with("carom simulate")).unwrap();
    assert!(again.starts_with(&format!("carom simulate --table '{}' --layout=", at[0])), "{again}");
}

/// Counts the columns of a line of CSV; commas in quotes do not separate columns.
fn columns_of(line: &str) -> usize {
    line.split('"').step_by(2).map(|outside| outside.matches(',').count()).sum()
}

#[test]
fn extreme_numbers_are_printed_in_scientific_notation() {
    let late = carom(&["simulate", "--shot", "0,0,0,0,3", "--at", "1e308"]).ok();
    assert!(late.out.contains("after 1e308 s:"), "{}", late.out);
    let line =
        r#"{"preset":"textbook","layout":[[0,0],[0.5,0],[0,0.4]],"impulse":{"velocity":[1,0,1e-320],"spin":[0,0,0]}}"#;
    let output = batch(&["simulate"], line);
    assert!(output.out.contains("impulse.velocity has 1e-320 m/s upwards"), "{}", output.out);
}
