//! The calibration through the real binary: files of entries, a saved session, and written tables.

use std::{fs, io::Write, path::Path, process::Stdio};

use assert_cmd::Command;
use serde_json::Value;

use crate::program::{carom_command as carom, command, count_attempts};

/// Returns the program with its own home folder.
fn at_home(home: &Path, args: &[&str]) -> Command {
    let mut command = carom(args);
    command.current_dir(home).env("HOME", home).env("XDG_DATA_HOME", home.join("data"));
    command
}

const ENTRIES: &str = "name = \"ours\"\n[[trial]]\ntest = \"slow-roll\"\ntime = 9.6\nstop = 5.4\ndrift = \"725 mm\"\n\
                       [[trial]]\ntest = \"lag\"\nlap = 4.4\nrest = 8.0\nstop = 3.5\n";

#[test]
fn an_entries_file_becomes_a_table_that_commands_accept() {
    let home = tempfile::tempdir().unwrap();
    let run = |args: &[&str]| at_home(home.path(), args);
    fs::write(home.path().join("entries.toml"), ENTRIES).unwrap();
    let printed = run(&["calibrate", "entries.toml", "--out", "mine.toml"]).assert().success();
    let printed = String::from_utf8_lossy(&printed.get_output().stdout).into_owned();
    for part in ["mu_r", "well", "all marks agree", "not entered yet: slow-roll (1), slow-back (1)", "helps most"] {
        assert!(printed.contains(part), "{part}: {printed}");
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
fn a_session_without_entries_writes_no_table() {
    let home = tempfile::tempdir().unwrap();
    let message = at_home(home.path(), &["calibrate", "--out", "mine.toml"]).write_stdin("").assert().code(2);
    let message = String::from_utf8_lossy(&message.get_output().stderr).into_owned();
    assert!(
        message.contains("there is no mark that can be used") && !home.path().join("mine.toml").exists(),
        "{message}"
    );
}

#[test]
fn contradictory_strokes_are_named_and_no_table_is_written() {
    let home = tempfile::tempdir().unwrap();
    let strokes = ["5", "9", "16"].map(|time| format!("[[trial]]\ntest = \"slow-roll\"\ntime = {time}\nstop = 5\n"));
    fs::write(home.path().join("entries.toml"), strokes.concat()).unwrap();
    let output = at_home(home.path(), &["calibrate", "entries.toml"]).assert().code(2);
    assert!(!String::from_utf8_lossy(&output.get_output().stderr).contains("no table is written"));
    let output = String::from_utf8_lossy(&output.get_output().stdout).into_owned();
    assert!(output.contains("contradict the others") && output.contains("trial 1 (slow-roll)"), "{output}");
    assert!(output.contains("unsure") && !output.contains(" better") && !output.contains(" well"), "{output}");
    let refused = at_home(home.path(), &["calibrate", "entries.toml", "--out", "mine.toml"]).assert().code(2);
    assert!(String::from_utf8_lossy(&refused.get_output().stderr).contains("no table is written"));
    assert!(!home.path().join("mine.toml").exists());
}

#[test]
fn a_table_shadowed_by_a_bundled_name_is_reported() {
    let home = tempfile::tempdir().unwrap();
    let tables = home.path().join("data/carom/tables");
    fs::create_dir_all(&tables).unwrap();
    let shown = at_home(home.path(), &["table", "show", "match"]).assert().success();
    fs::write(tables.join("match.toml"), &shown.get_output().stdout).unwrap();
    let listed = at_home(home.path(), &["table"]).assert().success();
    let (out, message) =
        (&listed.get_output().stdout, String::from_utf8_lossy(&listed.get_output().stderr).into_owned());
    assert_eq!(String::from_utf8_lossy(out).matches("match:").count(), 1);
    assert!(message.contains("match.toml is not found by its name"), "{message}");
}

#[test]
fn invalid_entries_are_named_and_nothing_is_overwritten() {
    let home = tempfile::tempdir().unwrap();
    let refused = |args: &[&str], code: i32| {
        let output = at_home(home.path(), args).output().unwrap();
        assert_eq!(output.status.code(), Some(code), "{args:?}: {}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stderr).unwrap()
    };
    let write = |name: &str, text: &str| fs::write(home.path().join(name), text).unwrap();
    write("odd.toml", &format!("{ENTRIES}[[trial]]\ntest = \"lag\"\nrest = 240\n"));
    let message = refused(&["calibrate", "odd.toml", "--out", "new.toml"], 2);
    assert!(message.contains("trial 3 (lag): rest = 240") && message.contains("no table is written"), "{message}");
    assert!(!home.path().join("new.toml").exists());
    write("notes.txt", "my notes");
    write("entries.toml", ENTRIES);
    for own in ["notes.txt", "entries.toml"] {
        let before = fs::read(home.path().join(own)).unwrap();
        let message = refused(&["calibrate", "entries.toml", "--out", own], 1);
        assert!(message.contains("is no table, so it is not overwritten"), "{message}");
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
fn tables_and_attempts_are_saved_when_stdout_is_closed() {
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
    assert_eq!(count_attempts(home.path()), 3);
}

#[test]
fn a_session_reports_saved_marks_missing_marks_and_their_meaning() {
    let home = tempfile::tempdir().unwrap();
    let output = at_home(home.path(), &["calibrate"]).write_stdin("9.1\n9.2 5.3 2\ndone\n").assert().success();
    let message = String::from_utf8_lossy(&output.get_output().stderr).into_owned();
    assert!(message.contains("on one line"), "{message}");
    assert!(message.contains("mark    rails: how many short rails it has met, if not 0"), "{message}");
    let first = "saved: slow-roll, stroke 1: time 9.1; without stop, drift (undo removes it)\n";
    assert!(message.contains(first), "{message}");
    assert!(message.contains("saved: slow-roll, stroke 2: time 9.2, stop 5.3, drift 2\n"), "{message}");
}

#[test]
fn a_session_saves_every_entry_and_can_be_resumed() {
    let home = tempfile::tempdir().unwrap();
    let file = home.path().join("data/carom/calibration.toml");
    let play = |lines: &str, code: i32| {
        let output = at_home(home.path(), &["calibrate"]).write_stdin(lines.to_owned()).assert().code(code);
        let output = output.get_output();
        String::from_utf8_lossy(&[&output.stderr[..], &output.stdout].concat()).into_owned()
    };
    let printed = play("", 0);
    assert!(printed.contains("nothing is entered yet") && printed.contains("slow-roll") && !file.exists(), "{printed}");
    // An impossible mark is refused, and a program that pipes it in learns that from the exit code at the end.
    let printed = play("9.6 5.4 2\n9 99 2\n9.4 5.3\nskip\nlap 4.4 rest 8 stop 3.5\nundo\n4.4 8 3.5 2\n", 2);
    assert!(
        printed.contains("slow-roll: stop = 99: no ball can be there") && printed.contains("nothing was saved"),
        "{printed}"
    );
    assert!(printed.contains("the last entry (lag) was removed") && printed.contains("mu_r"), "{printed}");
    let kept = fs::read_to_string(&file).unwrap();
    assert_eq!(kept.matches("[[trial]]").count(), 3, "{kept}");
    let printed = play("again\n9.9 - 2\ndone\n", 0);
    assert!(printed.contains("slow-back (1"), "it goes on with what is missing: {printed}");
    assert_eq!(fs::read_to_string(&file).unwrap().matches("test = \"lag\"").count(), 2);
    // An unreadable file is not overwritten.
    fs::write(&file, "broken").unwrap();
    let output = at_home(home.path(), &["calibrate"]).write_stdin("1 2 3\n").output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(fs::read_to_string(&file).unwrap(), "broken");
}

#[test]
fn tests_are_listed_and_the_template_is_an_entries_file() {
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
    let refused = at_home(home.path(), &["calibrate", "entries.toml"]).output().unwrap();
    assert!(String::from_utf8_lossy(&refused.stderr).contains("no mark that can be used"));
    let measured = output(&["calibrate", "--simulate", "2", "--seed", "5", "--json"]);
    let measured: Value = serde_json::from_str(&measured).unwrap();
    assert_eq!((measured["tables"].as_u64(), measured["strokes"].as_u64()), (Some(2), Some(20)));
    assert!(measured["constants"].as_array().unwrap().len() >= 14);
}
