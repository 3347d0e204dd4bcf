//! `carom doctor` and `--version` through the real binary.

use std::fs;

use crate::program::{carom, command, outcome, stdout};

#[test]
fn the_version_contains_the_commit_and_architecture() {
    let text = stdout(&["--version"]);
    assert!(text.starts_with(&format!("carom {} (commit ", env!("CARGO_PKG_VERSION"))), "{text}");
    assert!(text.contains(&format!(", {}-", std::env::consts::ARCH)) && text.trim_end().ends_with(')'), "{text}");
}

#[test]
fn doctor_finds_no_problem_for_new_users_and_creates_nothing() {
    let home = tempfile::tempdir().unwrap();
    let output = carom(home.path(), &["doctor", "--json"]).ok();
    let report = &output.json()[0];
    assert_eq!(output.json().len(), 1);
    assert_eq!(report["problems"].as_array().unwrap().len(), 0);
    assert_eq!(report["program"]["version"], env!("CARGO_PKG_VERSION"));
    let test = &report["self_test"];
    assert_eq!((&test["engine"]["is_right"], &test["engine"]["shots"]), (&true.into(), &2000.into()));
    let networks = test["networks"].as_array().unwrap();
    assert_eq!(networks.len(), 9, "three rules on three tables: {networks:?}");
    assert!(networks.iter().all(|network| network["is_right"] == true), "{networks:?}");
    assert_eq!(report["screen"]["can_draw"], false);
    for place in report["places"].as_array().unwrap() {
        assert!(place["refusal"].is_null() && place["free_bytes"].as_u64().unwrap() > 0, "{place}");
    }
    assert_eq!(fs::read_dir(home.path()).unwrap().count(), 0, "the doctor changes nothing");
}

/// Regression test: only half of the JSON object was written, and the error blamed the output.
#[cfg(unix)]
#[test]
fn folder_names_that_are_not_utf8_are_printed_lossily() {
    use std::os::unix::ffi::OsStrExt;
    let folder = tempfile::tempdir().unwrap();
    let home = folder.path().join(std::ffi::OsStr::from_bytes(b"z\xff"));
    fs::create_dir_all(&home).unwrap();
    let output = carom(&home, &["doctor", "--json"]).ok();
    let path = output.json()[0]["places"][1]["path"].as_str().unwrap().to_owned();
    assert!(path.contains("z\u{fffd}"), "{path}");
}

#[test]
fn doctor_names_every_problem_and_exits_with_one() {
    let home = tempfile::tempdir().unwrap();
    let put = |path: &str, text: &str| {
        let path = home.path().join(path);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    };
    put("config/carom/config.toml", "speed = 80\n");
    put("carom/tables/bad.toml", "length = 2");
    // The lengths are in centimetres, which --table refuses.
    put("carom/tables/long.toml", &include_str!("../../src/table/textbook.toml").replace("L = 2.84", "L = 284"));
    put("carom/sessions/broken.json", "{");
    put("carom/positions/broken.json", "{");
    put("carom/player.json", "{");
    put("state", "a file in the way");
    let output = carom(home.path(), &["doctor"]).fails(1, &["things are wrong"]);
    let wrong: Vec<&str> = output.out.lines().filter_map(|line| line.strip_prefix("wrong: ")).collect();
    for part in ["speed = 80", "bad.toml", "long.toml", "sessions/broken", "positions/broken", "player.json", "state"] {
        assert!(wrong.iter().any(|line| line.contains(part)), "{part}: {wrong:#?}");
    }
    assert!(output.out.contains("2000 shots, hash") && output.out.contains("as on other machines"), "{}", output.out);
}

#[test]
fn doctor_names_unreadable_calibration_and_session_files() {
    let home = tempfile::tempdir().unwrap();
    for file in ["carom/calibration.toml", "carom/calibration-daily.toml", "state/carom/last.json"] {
        let path = home.path().join(file);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, "{").unwrap();
        let output = carom(home.path(), &["doctor"]);
        assert_eq!(output.code, Some(1), "{file}: {}", output.out);
        assert!(
            output.out.lines().any(|line| line.starts_with("wrong: ") && line.contains(file)),
            "{file}: {}",
            output.out
        );
    }
}

#[test]
fn doctor_escapes_control_characters_of_environment_variables() {
    let home = tempfile::tempdir().unwrap();
    let mut command = command(home.path(), &["doctor"]);
    let output = outcome(command.env("LANG", "\u{1b}]0;title\u{7}").spawn().unwrap());
    assert!(!output.out.contains('\u{1b}') && output.out.contains("\\u{1b}"), "{}", output.out);
}
