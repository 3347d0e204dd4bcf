//! No data is lost: kills, a full disk, newer versions, damaged files, several programs at once.

use std::{
    fs,
    io::{BufRead, BufReader, Write},
    path::Path,
    process::Stdio,
    time::Duration,
};

use assert_cmd::cargo::cargo_bin;

use crate::program::{SAVE, command, count_attempts, drill, folder, outcome, program, run_with_input, session_files};

/// Returns the number of attempts in a session file, which must be valid.
fn attempts(file: &Path) -> usize {
    let text = fs::read_to_string(file).unwrap();
    let session: serde_json::Value = serde_json::from_str(&text).unwrap();
    session["attempts"].as_array().unwrap().len()
}

#[test]
fn an_attempt_undone_by_another_process_stays_undone() {
    let folder = folder();
    let mut noting = command(folder.path(), &["drill", "log", "mine", "--json"]).stdin(Stdio::piped()).spawn().unwrap();
    let mut input = noting.stdin.take().unwrap();
    let mut lines = BufReader::new(noting.stdout.take().unwrap()).lines();
    let mut tried_after = |word: &str| {
        writeln!(input, "{word}").unwrap();
        let answer: serde_json::Value = serde_json::from_str(&lines.next().unwrap().unwrap()).unwrap();
        answer["tried"].as_u64().unwrap()
    };
    let undo = || assert_eq!(drill(folder.path(), &["log", "mine", "undo"]).code, Some(0));
    assert_eq!([tried_after("make"), tried_after("make")], [1, 2]);
    undo();
    assert_eq!(tried_after("miss"), 2);
    // Until no attempt is left.
    undo();
    undo();
    assert_eq!(tried_after("make"), 1);
    drop(input);
    assert!(noting.wait().unwrap().success());
    assert_eq!(count_attempts(folder.path()), 1);
}

#[test]
fn a_killed_program_loses_no_reported_attempt() {
    let folder = folder();
    let mut least = 0;
    for kill in 0..12 {
        let before = session_files(folder.path());
        let args = ["drill", "run", "mine", "--goal", "10000", "--strokes", "10000", "--json"];
        let mut child = command(folder.path(), &args).stdin(Stdio::piped()).spawn().unwrap();
        let mut input = child.stdin.take().unwrap();
        let feeder = std::thread::spawn(move || while writeln!(input, "0,0.3,3,1,4").is_ok() {});
        let lines = BufReader::new(child.stdout.take().unwrap()).lines();
        // Each kill comes at another time, mostly while an attempt is played or written.
        std::thread::sleep(Duration::from_millis(40 + 37 * kill));
        child.kill().unwrap();
        child.wait().unwrap();
        let reported =
            lines.map_while(Result::ok).filter(|line| line.contains("\"attempt\"") && line.ends_with('}')).count();
        feeder.join().unwrap();
        let new: Vec<_> = session_files(folder.path()).into_iter().filter(|file| !before.contains(file)).collect();
        let kept: usize = new.iter().map(|file| attempts(file)).sum();
        assert!(kept == reported || kept == reported + 1, "{kept} attempts kept, {reported} told");
        least += reported as u64;
    }
    assert!(least > 20, "almost no attempt was played before the kills");
    assert!(count_attempts(folder.path()) >= least);
}

#[test]
fn concurrent_programs_lose_no_attempts() {
    let folder = folder();
    let logs: Vec<_> = (0..4)
        .map(|_| {
            let mut child = command(folder.path(), &["drill", "log", "mine"]).stdin(Stdio::piped()).spawn().unwrap();
            let mut input = child.stdin.take().unwrap();
            let feeder = std::thread::spawn(move || input.write_all("make\n".repeat(25).as_bytes()).unwrap());
            (child, feeder)
        })
        .collect();
    for (child, feeder) in logs {
        feeder.join().unwrap();
        outcome(child).ok();
    }
    assert_eq!((count_attempts(folder.path()), session_files(folder.path()).len()), (100, 4));
    // If several programs save under the same new name, exactly one succeeds.
    let saves: Vec<_> = (0..4)
        .map(|title| {
            let title = title.to_string();
            let args = [&["drill", "save", "ours"], &SAVE[2..], &["--title", &title]].concat();
            command(folder.path(), &args).spawn().unwrap()
        })
        .collect();
    let codes: Vec<_> = saves.into_iter().map(|child| outcome(child).code).collect();
    assert_eq!(codes.iter().filter(|code| **code == Some(0)).count(), 1, "{codes:?}");
}

/// Runs the program in a shell with a file size limit of this many blocks, which acts like a full disk.
#[cfg(unix)]
#[test]
fn a_full_disk_is_reported_and_saved_attempts_remain() {
    let folder = folder();
    let script = "trap '' XFSZ; ulimit -f 6; exec \"$0\" drill log mine --json";
    let mut shell = program(folder.path(), Path::new("sh"));
    shell.args(["-c", script]).arg(cargo_bin!("carom"));
    let full = run_with_input(shell, &"make\n".repeat(500)).fails(1, &["sessions", "large"]);
    let reported = full.out.lines().count() as u64;
    assert!(reported > 5 && reported < 500, "{reported} were told");
    assert_eq!(count_attempts(folder.path()), reported);
    let left = fs::read_dir(folder.path().join("carom/sessions")).unwrap();
    let left = left.filter(|file| file.as_ref().unwrap().file_name() != "lock").count();
    assert_eq!(left, 1, "nothing half written is left");
}

#[test]
fn an_unwritable_session_folder_is_named() {
    let folder = folder();
    fs::write(folder.path().join("carom/sessions"), "in the way").unwrap();
    for args in [&["log", "mine", "make"][..], &["try", "mine", "--shot", "0,0.3,3,1,4", "--budget-ms", "10"]] {
        let refused = drill(folder.path(), args).fails(1, &["carom/sessions cannot be written"]);
        assert!(!refused.out.contains("of 1 made"), "{}", refused.out);
    }
    assert_eq!(fs::read_to_string(folder.path().join("carom/sessions")).unwrap(), "in the way");
}

#[test]
fn newer_and_damaged_files_are_named_and_never_changed() {
    let folder = folder();
    drill(folder.path(), &["log", "mine", "make", "miss"]);
    let [session] = &session_files(folder.path())[..] else { panic!("one session") };
    let text = fs::read_to_string(session).unwrap();
    let file = |name: &str, text: &str| {
        let path = folder.path().join("carom").join(name);
        fs::write(&path, text).unwrap();
        (path, text.to_owned())
    };
    let backup = folder.path().join("backup.json");
    drill(folder.path(), &["export", backup.to_str().unwrap()]).ok();
    let complete = fs::read_to_string(&backup).unwrap();
    let bad = [
        file("sessions/newer.json", &text.replace("\"version\":1", "\"version\":2")),
        file("sessions/half.json", &text[..text.len() / 2]),
        file("sessions/garbage.json", "\u{0}\u{1}"),
        file("positions/later.json", r#"{"format":"carom-library","version":5,"exercises":"unknown"}"#),
        file("player.json", r#"{"format":"carom-player","version":3,"skill":7}"#),
    ];
    drill(folder.path(), &["log", "mine", "make"]);
    let history = drill(folder.path(), &["history", "--json"]);
    assert_eq!((history.code, &history.json()[0]["tried"]), (Some(0), &serde_json::json!(3)), "{}", history.err);
    for name in ["newer.json", "version 2", "half.json", "garbage.json", "later.json", "version 5"] {
        assert!(history.err.contains(name), "{name}: {}", history.err);
    }
    drill(folder.path(), &["export"]).fails(1, &["5 files"]);
    drill(folder.path(), &["export", backup.to_str().unwrap()]).fails(1, &["stays as it is"]);
    assert_eq!(fs::read_to_string(&backup).unwrap(), complete, "a poorer export does not replace it");
    for args in [&["remove", "later"][..], &["skill", "--keep"]] {
        assert_eq!(drill(folder.path(), args).code, Some(1), "{args:?}");
    }
    for (path, text) in bad {
        assert_eq!(fs::read_to_string(&path).unwrap(), text, "{}", path.display());
    }
}
