//! `carom doctor` and `--version` through the real binary.

use std::fs;

use crate::program::{asked, carom};

#[test]
fn the_version_names_the_commit_or_says_that_it_is_not_known() {
    let output = asked(&["--version"]).assert().success().get_output().stdout.clone();
    let said = String::from_utf8(output).unwrap();
    assert!(said.starts_with(&format!("carom {} (commit ", env!("CARGO_PKG_VERSION"))), "{said}");
    assert!(said.contains(&format!(", {}-", std::env::consts::ARCH)) && said.trim_end().ends_with(')'), "{said}");
}

#[test]
fn a_new_user_has_nothing_wrong_and_nothing_is_made() {
    let home = tempfile::tempdir().unwrap();
    let said = carom(home.path(), &["doctor", "--json"]);
    assert_eq!(said.code, Some(0), "{}{}", said.out, said.err);
    let report = &said.json()[0];
    assert_eq!(said.json().len(), 1);
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
fn folders_whose_names_are_no_text_are_told_as_far_as_they_can_be() {
    use std::os::unix::ffi::OsStrExt;
    let folder = tempfile::tempdir().unwrap();
    let home = folder.path().join(std::ffi::OsStr::from_bytes(b"z\xff"));
    fs::create_dir_all(&home).unwrap();
    let said = carom(&home, &["doctor", "--json"]);
    assert_eq!(said.code, Some(0), "{}{}", said.out, said.err);
    let path = said.json()[0]["places"][1]["path"].as_str().unwrap().to_owned();
    assert!(path.contains("z\u{fffd}"), "{path}");
}

#[test]
fn what_is_wrong_is_named_and_the_exit_code_says_so() {
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
    let said = carom(home.path(), &["doctor"]);
    assert_eq!(said.code, Some(1), "{}", said.out);
    assert!(said.err.contains("things are wrong"), "{}", said.err);
    let wrong: Vec<&str> = said.out.lines().filter_map(|line| line.strip_prefix("wrong: ")).collect();
    for part in ["speed = 80", "bad.toml", "long.toml", "sessions/broken", "positions/broken", "player.json", "state"] {
        assert!(wrong.iter().any(|line| line.contains(part)), "{part}: {wrong:#?}");
    }
    assert!(said.out.contains("2000 shots, hash") && said.out.contains("as on other machines"), "{}", said.out);
}

#[test]
fn strokes_of_a_calibration_and_a_last_session_that_cannot_be_read_are_named() {
    let home = tempfile::tempdir().unwrap();
    for file in ["carom/calibration.toml", "carom/calibration-daily.toml", "state/carom/last.json"] {
        let path = home.path().join(file);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, "{").unwrap();
        let said = carom(home.path(), &["doctor"]);
        assert_eq!(said.code, Some(1), "{file}: {}", said.out);
        assert!(
            said.out.lines().any(|line| line.starts_with("wrong: ") && line.contains(file)),
            "{file}: {}",
            said.out
        );
    }
}

#[test]
fn nobodys_control_characters_reach_the_terminal() {
    let home = tempfile::tempdir().unwrap();
    let mut command = crate::program::command(home.path(), &["doctor"]);
    let said = crate::program::outcome(command.env("LANG", "\u{1b}]0;title\u{7}").spawn().unwrap());
    assert!(!said.out.contains('\u{1b}') && said.out.contains("\\u{1b}"), "{}", said.out);
}
