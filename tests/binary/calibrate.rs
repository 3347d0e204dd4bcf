//! The calibration through the real binary: files of entries, a saved session, and written tables.

use std::{fs, io::Write, path::Path, process::Stdio};

use assert_cmd::Command;
use serde_json::Value;

use crate::program::{asked as carom, command, tried};

/// Returns the program with its own home folder.
fn at_home(home: &Path, args: &[&str]) -> Command {
    let mut command = carom(args);
    command.current_dir(home).env("HOME", home).env("XDG_DATA_HOME", home.join("data"));
    command
}

const ENTRIES: &str = "name = \"ours\"\n[[trial]]\ntest = \"slow-roll\"\ntime = 9.6\nstop = 5.4\ndrift = \"725 mm\"\n\
                       [[trial]]\ntest = \"lag\"\nlap = 4.4\nrest = 8.0\nstop = 3.5\n";

#[test]
fn a_file_of_entries_becomes_a_table_that_every_command_plays_on() {
    let home = tempfile::tempdir().unwrap();
    let run = |args: &[&str]| at_home(home.path(), args);
    fs::write(home.path().join("entries.toml"), ENTRIES).unwrap();
    let said = run(&["calibrate", "entries.toml", "--out", "mine.toml"]).assert().success();
    let said = String::from_utf8_lossy(&said.get_output().stdout).into_owned();
    for part in ["mu_r", "well", "all marks agree", "not entered yet: slow-roll (1), slow-back (1)", "helps most"] {
        assert!(said.contains(part), "{part}: {said}");
    }
    run(&["table", "check", "mine.toml"]).assert().success();
    run(&["simulate", "--table", "mine.toml", "--shot", "0,0.3,0,1,2"]).assert().success();
    let text = fs::read_to_string(home.path().join("mine.toml")).unwrap();
    assert!(text.contains("[doubt.deviations]") && text.contains("name = \"ours\""), "{text}");
    // Again, from the table just written: the uncertainty is smaller now, and the file is replaced.
    let answer =
        run(&["calibrate", "entries.toml", "--table", "mine.toml", "--out", "mine.toml", "--json"]).output().unwrap();
    let answer: Value = serde_json::from_slice(&answer.stdout).unwrap();
    let roll = answer["constants"].as_array().unwrap().iter().find(|one| one["name"] == "mu_r").unwrap();
    assert!(roll["before_deviation"].as_f64().unwrap() < 0.0006, "{roll}");
    assert_ne!(fs::read_to_string(home.path().join("mine.toml")).unwrap(), text);
    // A daily check: the change at three rails is unknown until both tests are played.
    let daily = || {
        let daily = run(&["calibrate", "--daily", "--table", "mine.toml", "entries.toml"]).assert().success();
        String::from_utf8_lossy(&daily.get_output().stdout).into_owned()
    };
    let lag = daily();
    assert!(lag.contains("not entered yet: corner-five (1)\n") && !lag.contains("three rails"), "{lag}");
    let corner = "[[trial]]\ntest = \"corner-five\"\nfirst = 5.9\nthird = 5.2\n";
    fs::write(home.path().join("entries.toml"), ENTRIES.to_owned() + corner).unwrap();
    let both = daily();
    assert!(both.contains("today a lag rolls") && both.contains("three rails play"), "{both}");
}

#[test]
fn a_session_without_an_entry_writes_no_table_and_says_so() {
    let home = tempfile::tempdir().unwrap();
    let told = at_home(home.path(), &["calibrate", "--out", "mine.toml"]).write_stdin("").assert().code(2);
    let told = String::from_utf8_lossy(&told.get_output().stderr).into_owned();
    assert!(told.contains("there is no mark that can be used") && !home.path().join("mine.toml").exists(), "{told}");
}

#[test]
fn strokes_that_contradict_each_other_are_named_and_no_table_is_written() {
    let home = tempfile::tempdir().unwrap();
    let strokes = ["5", "9", "16"].map(|time| format!("[[trial]]\ntest = \"slow-roll\"\ntime = {time}\nstop = 5\n"));
    fs::write(home.path().join("entries.toml"), strokes.concat()).unwrap();
    let told = at_home(home.path(), &["calibrate", "entries.toml"]).assert().code(2);
    assert!(!String::from_utf8_lossy(&told.get_output().stderr).contains("no table is written"));
    let told = String::from_utf8_lossy(&told.get_output().stdout).into_owned();
    assert!(told.contains("contradict the others") && told.contains("trial 1 (slow-roll)"), "{told}");
    assert!(told.contains("unsure") && !told.contains(" better") && !told.contains(" well"), "{told}");
    let refused = at_home(home.path(), &["calibrate", "entries.toml", "--out", "mine.toml"]).assert().code(2);
    assert!(String::from_utf8_lossy(&refused.get_output().stderr).contains("no table is written"));
    assert!(!home.path().join("mine.toml").exists());
}

#[test]
fn a_table_that_is_not_found_by_its_name_is_named_instead_of_listed() {
    let home = tempfile::tempdir().unwrap();
    let tables = home.path().join("data/carom/tables");
    fs::create_dir_all(&tables).unwrap();
    let shown = at_home(home.path(), &["table", "show", "match"]).assert().success();
    fs::write(tables.join("match.toml"), &shown.get_output().stdout).unwrap();
    let listed = at_home(home.path(), &["table"]).assert().success();
    let (out, said) = (&listed.get_output().stdout, String::from_utf8_lossy(&listed.get_output().stderr).into_owned());
    assert_eq!(String::from_utf8_lossy(out).matches("match:").count(), 1);
    assert!(said.contains("match.toml is not found by its name"), "{said}");
}

#[test]
fn odd_entries_are_named_and_nothing_is_overwritten() {
    let home = tempfile::tempdir().unwrap();
    let refused = |args: &[&str], code: i32| {
        let output = at_home(home.path(), args).output().unwrap();
        assert_eq!(output.status.code(), Some(code), "{args:?}: {}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stderr).unwrap()
    };
    let write = |name: &str, text: &str| fs::write(home.path().join(name), text).unwrap();
    write("odd.toml", &format!("{ENTRIES}[[trial]]\ntest = \"lag\"\nrest = 240\n"));
    let said = refused(&["calibrate", "odd.toml", "--out", "new.toml"], 2);
    assert!(said.contains("trial 3 (lag): rest = 240") && said.contains("no table is written"), "{said}");
    assert!(!home.path().join("new.toml").exists());
    write("notes.txt", "my notes");
    write("entries.toml", ENTRIES);
    for own in ["notes.txt", "entries.toml"] {
        let before = fs::read(home.path().join(own)).unwrap();
        let said = refused(&["calibrate", "entries.toml", "--out", own], 1);
        assert!(said.contains("is no table, so it stays as it is"), "{said}");
        assert_eq!(fs::read(home.path().join(own)).unwrap(), before);
    }
    write("broken.toml", "[[trial]\n");
    assert!(refused(&["calibrate", "broken.toml"], 2).contains("line 1"));
    write("empty.toml", "");
    assert!(refused(&["calibrate", "empty.toml"], 2).contains("--tests"));
    assert!(refused(&["calibrate", "nowhere.toml"], 1).contains("nowhere.toml cannot be read"));
    assert!(refused(&["calibrate", "--daily", "entries.toml"], 2).contains("calibrated before"));
    assert!(refused(&["calibrate", "entries.toml", "--name", "a", "--simulate", "0"], 2).contains("simulate"));
    assert!(refused(&["calibrate", "entries.toml", "--name", "match"], 2).contains("bundled"));
    let mistyped = ["calibrate", "entries.toml", "--out", "tabels/new.toml"];
    assert!(refused(&mistyped, 1).contains("there is no folder tabels"));
    assert!(!home.path().join("tabels").exists());
}

#[test]
fn a_reader_that_goes_away_takes_no_table_and_no_note_with_it() {
    let home = tempfile::tempdir().unwrap();
    fs::write(home.path().join("entries.toml"), ENTRIES).unwrap();
    let unread = |args: &[&str]| {
        let mut child = command(home.path(), args).stdin(Stdio::piped()).spawn().unwrap();
        drop(child.stdout.take());
        // The program ignores its input if it reads a file.
        let _ = child.stdin.take().unwrap().write_all(b"make\nmiss\nmake\n");
        assert!(child.wait().unwrap().success(), "{args:?}");
    };
    unread(&["calibrate", "entries.toml", "--out", "new.toml"]);
    assert!(home.path().join("new.toml").exists());
    unread(&["drill", "log", "half-ball"]);
    assert_eq!(tried(home.path()), 3);
}

#[test]
fn a_session_says_what_it_has_kept_of_a_stroke_what_is_missing_and_what_each_mark_is() {
    let home = tempfile::tempdir().unwrap();
    let output = at_home(home.path(), &["calibrate"]).write_stdin("9.1\n9.2 5.3 2\ndone\n").assert().success();
    let said = String::from_utf8_lossy(&output.get_output().stderr).into_owned();
    assert!(said.contains("on one line"), "{said}");
    assert!(said.contains("mark    rails: how many short rails it has met, if not 0"), "{said}");
    let first = "kept: slow-roll, stroke 1: time 9.1; without stop, drift (undo takes it back)\n";
    assert!(said.contains(first), "{said}");
    assert!(said.contains("kept: slow-roll, stroke 2: time 9.2, stop 5.3, drift 2\n"), "{said}");
}

#[test]
fn a_session_keeps_every_entry_and_goes_on_where_it_ended() {
    let home = tempfile::tempdir().unwrap();
    let file = home.path().join("data/carom/calibration.toml");
    let play = |lines: &str, code: i32| {
        let output = at_home(home.path(), &["calibrate"]).write_stdin(lines.to_owned()).assert().code(code);
        let output = output.get_output();
        String::from_utf8_lossy(&[&output.stderr[..], &output.stdout].concat()).into_owned()
    };
    let said = play("", 0);
    assert!(said.contains("nothing is entered yet") && said.contains("slow-roll") && !file.exists(), "{said}");
    // An impossible mark is refused, and a program that pipes it in learns that from the exit code at the end.
    let said = play("9.6 5.4 2\n9 99 2\n9.4 5.3\nskip\nlap 4.4 rest 8 stop 3.5\nundo\n4.4 8 3.5 2\n", 2);
    assert!(said.contains("slow-roll: stop = 99: no ball can be there") && said.contains("nothing was kept"), "{said}");
    assert!(said.contains("the last entry (lag) is taken back") && said.contains("mu_r"), "{said}");
    let kept = fs::read_to_string(&file).unwrap();
    assert_eq!(kept.matches("[[trial]]").count(), 3, "{kept}");
    let said = play("again\n9.9 - 2\ndone\n", 0);
    assert!(said.contains("slow-back (1"), "it goes on with what is missing: {said}");
    assert_eq!(fs::read_to_string(&file).unwrap().matches("test = \"lag\"").count(), 2);
    // An unreadable file is not overwritten.
    fs::write(&file, "broken").unwrap();
    let output = at_home(home.path(), &["calibrate"]).write_stdin("1 2 3\n").output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(fs::read_to_string(&file).unwrap(), "broken");
}

#[test]
fn the_tests_are_listed_for_people_and_programs_and_the_template_is_a_file_of_entries() {
    let home = tempfile::tempdir().unwrap();
    let output = |args: &[&str]| String::from_utf8(at_home(home.path(), args).output().unwrap().stdout).unwrap();
    let text = output(&["calibrate", "--tests"]);
    assert!(text.contains("1. slow-roll (2 times)") && text.contains("20 strokes in all"), "{text}");
    let tests: Vec<Value> =
        output(&["calibrate", "--tests", "--json"]).lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert_eq!(tests.iter().map(|test| test["times"].as_u64().unwrap()).sum::<u64>(), 20);
    assert_eq!(tests[0]["marks"][0]["unit"], "seconds");
    assert!(tests.iter().any(|test| test["rails"]["words"].is_string() && test["rails"]["usual"].is_null()));
    assert!(tests.iter().any(|test| test["rails"].is_null()), "{tests:?}");
    fs::write(home.path().join("entries.toml"), output(&["calibrate", "--template"])).unwrap();
    let said = at_home(home.path(), &["calibrate", "entries.toml"]).output().unwrap();
    assert!(String::from_utf8_lossy(&said.stderr).contains("no mark that can be used"));
    let measured = output(&["calibrate", "--simulate", "2", "--seed", "5", "--json"]);
    let measured: Value = serde_json::from_str(&measured).unwrap();
    assert_eq!((measured["tables"].as_u64(), measured["strokes"].as_u64()), (Some(2), Some(20)));
    assert!(measured["constants"].as_array().unwrap().len() >= 14);
}
