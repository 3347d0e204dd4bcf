//! The calibration through the real binary: files of entries, a saved session, and written tables.

use std::{fs, io::Write, path::Path, process::Stdio};

use crate::program::{Outcome, carom, command, count_attempts, run_with_input};

/// Plays a session with these lines.
fn session(home: &Path, lines: &str) -> Outcome {
    run_with_input(command(home, &["calibrate"]), lines)
}

const ENTRIES: &str = "name = \"ours\"\n[[trial]]\ntest = \"slow-roll\"\ntime = 9.6\nstop = 5.4\ndrift = \"725 mm\"\n\
                       [[trial]]\ntest = \"lag\"\nlap = 4.4\nrest = 8.0\nstop = 3.5\n";

#[test]
fn an_entries_file_becomes_a_table_that_commands_accept() {
    let home = tempfile::tempdir().unwrap();
    let run = |args: &[&str]| carom(home.path(), args).ok();
    fs::write(home.path().join("entries.toml"), ENTRIES).unwrap();
    let printed = run(&["calibrate", "entries.toml", "--out", "mine.toml"]).out;
    for part in ["mu_r", "well", "all marks agree", "not entered yet: slow-roll (1), slow-back (1)", "helps most"] {
        assert!(printed.contains(part), "{part}: {printed}");
    }
    run(&["table", "check", "mine.toml"]);
    run(&["simulate", "--table", "mine.toml", "--shot", "0,0.3,0,1,2"]);
    let text = fs::read_to_string(home.path().join("mine.toml")).unwrap();
    assert!(text.contains("[doubt.deviations]") && text.contains("name = \"ours\""), "{text}");
    // Again, from the table just written: the uncertainty is smaller now, and the file is replaced.
    let answer =
        run(&["calibrate", "entries.toml", "--table", "mine.toml", "--out", "mine.toml", "--json"]).json().remove(0);
    let roll = answer["constants"].as_array().unwrap().iter().find(|one| one["name"] == "mu_r").unwrap();
    assert!(roll["before_deviation"].as_f64().unwrap() < 0.0006, "{roll}");
    assert_ne!(fs::read_to_string(home.path().join("mine.toml")).unwrap(), text);
    // A daily check: the change at three rails is unknown until both tests are played.
    let daily = || run(&["calibrate", "--daily", "--table", "mine.toml", "entries.toml"]).out;
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
    carom(home.path(), &["calibrate", "--out", "mine.toml"]).fails(2, &["there is no mark that can be used"]);
    assert!(!home.path().join("mine.toml").exists());
}

#[test]
fn contradictory_strokes_are_named_and_no_table_is_written() {
    let home = tempfile::tempdir().unwrap();
    let strokes = ["5", "9", "16"].map(|time| format!("[[trial]]\ntest = \"slow-roll\"\ntime = {time}\nstop = 5\n"));
    fs::write(home.path().join("entries.toml"), strokes.concat()).unwrap();
    let Outcome { code, out, err } = carom(home.path(), &["calibrate", "entries.toml"]);
    assert!(code == Some(2) && !err.contains("no table is written"), "{err}");
    assert!(out.contains("contradict the others") && out.contains("trial 1 (slow-roll)"), "{out}");
    assert!(out.contains("unsure") && !out.contains(" better") && !out.contains(" well"), "{out}");
    carom(home.path(), &["calibrate", "entries.toml", "--out", "mine.toml"]).fails(2, &["no table is written"]);
    assert!(!home.path().join("mine.toml").exists());
}

#[test]
fn a_table_shadowed_by_a_bundled_name_is_reported() {
    let home = tempfile::tempdir().unwrap();
    let tables = home.path().join("carom/tables");
    fs::create_dir_all(&tables).unwrap();
    fs::write(tables.join("match.toml"), carom(home.path(), &["table", "show", "match"]).ok().out).unwrap();
    let listed = carom(home.path(), &["table"]).ok();
    assert_eq!(listed.out.matches("match:").count(), 1);
    assert!(listed.err.contains("match.toml is not found by its name"), "{}", listed.err);
}

#[test]
fn invalid_entries_are_named_and_nothing_is_overwritten() {
    let home = tempfile::tempdir().unwrap();
    let refused = |args: &[&str], code: i32| {
        let output = carom(home.path(), args);
        assert_eq!(output.code, Some(code), "{args:?}: {}", output.err);
        output.err
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
    let message = session(home.path(), "9.1\n9.2 5.3 2\ndone\n").ok().err;
    assert!(message.contains("on one line"), "{message}");
    assert!(message.contains("mark    rails: how many short rails it has met, if not 0"), "{message}");
    let first = "saved: slow-roll, stroke 1: time 9.1; without stop, drift (undo removes it)\n";
    assert!(message.contains(first), "{message}");
    assert!(message.contains("saved: slow-roll, stroke 2: time 9.2, stop 5.3, drift 2\n"), "{message}");
}

#[test]
fn a_session_saves_every_entry_and_can_be_resumed() {
    let home = tempfile::tempdir().unwrap();
    let file = home.path().join("carom/calibration.toml");
    let play = |lines: &str, code: i32| {
        let output = session(home.path(), lines);
        assert_eq!(output.code, Some(code), "{}", output.err);
        output.err + &output.out
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
    assert_eq!(session(home.path(), "1 2 3\n").code, Some(2));
    assert_eq!(fs::read_to_string(&file).unwrap(), "broken");
}

#[test]
fn tests_are_listed_and_the_template_is_an_entries_file() {
    let home = tempfile::tempdir().unwrap();
    let output = |args: &[&str]| carom(home.path(), args).ok();
    let text = output(&["calibrate", "--tests"]).out;
    assert!(text.contains("1. slow-roll (2 times)") && text.contains("20 strokes in all"), "{text}");
    let tests = output(&["calibrate", "--tests", "--json"]).json();
    assert_eq!(tests.iter().map(|test| test["times"].as_u64().unwrap()).sum::<u64>(), 20);
    assert_eq!(tests[0]["marks"][0]["unit"], "seconds");
    assert!(tests.iter().any(|test| test["rails"]["words"].is_string() && test["rails"]["usual"].is_null()));
    assert!(tests.iter().any(|test| test["rails"].is_null()), "{tests:?}");
    fs::write(home.path().join("entries.toml"), output(&["calibrate", "--template"]).out).unwrap();
    assert!(carom(home.path(), &["calibrate", "entries.toml"]).err.contains("no mark that can be used"));
    let measured = &output(&["calibrate", "--simulate", "2", "--seed", "5", "--json"]).json()[0];
    assert_eq!((measured["tables"].as_u64(), measured["strokes"].as_u64()), (Some(2), Some(20)));
    assert!(measured["constants"].as_array().unwrap().len() >= 14);
}
