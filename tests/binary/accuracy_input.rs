//! What `carom accuracy` and the ways to simulate accept, refuse, and call by name.

use std::{process::Output, time::Duration};

use crate::program::asked;

fn carom(arguments: &[&str]) -> Output {
    asked(arguments).timeout(Duration::from_secs(60)).output().unwrap()
}

fn said(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

fn told(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

#[test]
fn a_study_of_one_table_or_of_some_shots_ends_with_it() {
    let output = carom(&["accuracy", "--table", "textbook", "--shots", "1"]);
    assert!(output.status.success(), "{}", said(&output));
    assert!(told(&output).contains("steps, dt 1e-6 s") && !told(&output).contains("verdict"), "{}", told(&output));
    assert!(said(&output).contains("--stability"), "{}", said(&output));
}
