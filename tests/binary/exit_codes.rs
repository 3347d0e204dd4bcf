//! The rule for exit codes, through the real binary; docs/command-line.md states it.

use std::fs;

use crate::program::{carom, command, drill, fed, folder};

#[test]
fn what_a_name_or_a_path_stands_for_and_is_not_there_cannot_be_done() {
    let home = folder();
    let layouts = ["--layouts", "1"];
    for args in [
        &["--plain", "--table", "nowhere"][..],
        &["simulate", "--table", "nowhere", "--shot", "0,0,0,0,2"],
        &["simulate", "--table", "nowhere.toml", "--shot", "0,0,0,0,2"],
        &["simulate", "--batch", "nowhere.jsonl"],
        &["recommend", "--table", "nowhere"],
        &["recommend", "--policy", "nowhere"],
        &["recommend", "--skill", "own"],
        &["evaluate", "--table", "nowhere", layouts[0], layouts[1]],
        &["evaluate", "--policy", "nowhere", layouts[0], layouts[1]],
        &["evaluate", "--policy-only", "--policy", "nowhere"],
        &["evaluate", "--merge", "nowhere.json"],
        &["train", "--table", "nowhere"],
        &["train", "--from", "nowhere"],
        &["train", "--config", "nowhere"],
        &["train", "--resume", "nowhere"],
        &["watch", "nowhere"],
        &["follow", "nowhere"],
        &["drill", "show", "nowhere"],
        &["drill", "try", "nowhere", "--shot", "0,0,0,0,2"],
        &["drill", "log", "nowhere", "make"],
        &["drill", "remove", "nowhere"],
        &["drill", "import", "nowhere.json"],
        &["calibrate", "nowhere.toml"],
        &["calibrate", "--tests", "--table", "nowhere"],
        &["table", "show", "nowhere"],
        &["table", "check", "nowhere.toml"],
        &["reproduce", "--table", "nowhere"],
        &["accuracy", "--table", "nowhere"],
    ] {
        let said = carom(home.path(), args);
        assert!(
            said.code == Some(1) && said.err.contains("nowhere") || args.contains(&"own"),
            "{args:?}: {}",
            said.err
        );
        assert!(said.err.starts_with("carom: ") && said.out.is_empty(), "{args:?}: {}", said.err);
        assert_eq!(said.err.lines().count(), 1, "{args:?}: {}", said.err);
        assert!(!said.err.contains("os error"), "{args:?}: {}", said.err);
    }
}

#[test]
fn what_would_be_wrong_on_every_machine_is_not_acceptable() {
    let home = folder();
    fs::write(home.path().join("odd.toml"), "[table]\nlength = -1\n").unwrap();
    fs::write(home.path().join("odd.safetensors"), "this is no safetensors file").unwrap();
    for args in [
        &["nonsense"][..],
        &["simulate"],
        &["simulate", "--shot", "0,0,0"],
        &["simulate", "--layout", "0,0", "--shot", "0,0,0,0,2"],
        &["simulate", "--shot", "0,0,0,0,2", "--rule", "snooker"],
        &["recommend", "--skill", "nobody"],
        &["recommend", "--budget-ms", "never"],
        &["recommend", "--policy", "odd.safetensors"],
        &["evaluate", "--merge", "odd.safetensors"],
        &["drill", "log", "mine", "perhaps"],
        &["drill", "save", "other", "--layout", "0,0 0,0 1,0"],
        &["table", "check", "odd.toml"],
        &["reproduce", "--figure", "nothing"],
        &["man", "nothing"],
        &["completions", "nothing"],
        &["calibrate", "odd.toml"],
        &["config", "--nothing"],
    ] {
        let said = carom(home.path(), args);
        assert!(said.code == Some(2) && !said.err.is_empty() && said.out.is_empty(), "{args:?}: {}", said.err);
        // Messages of clap have several lines.
        assert!(!said.err.starts_with("carom: ") || said.err.lines().count() == 1, "{args:?}: {}", said.err);
    }
}

#[test]
fn refused_lines_of_a_pipe_end_every_conversation_in_the_same_way() {
    let home = folder();
    let said = |args: &[&str], lines: &str| fed(command(home.path(), args), lines);
    for (args, good, refused) in [
        (&["--plain"][..], "where\nballs 0,0 0.5,0 1,0\nquit\n", "where\nballs 0,0 0,0 1,0\nperhaps\n"),
        (&["drill", "log", "mine"], "make\nmiss\n", "make\nperhaps\nmake it\n"),
        (&["drill", "run", "mine", "--goal", "9"], "0,0.3,0,1,2\n", "0,0.3,0,1,2\n0,0\nperhaps\n"),
        (&["calibrate"], "undo\ndone\n", "perhaps\nperhaps\ndone\n"),
    ] {
        assert_eq!(said(args, good).code, Some(0), "{args:?}");
        let ended = said(args, refused);
        assert!(
            ended.code == Some(2) && ended.err.ends_with("2 lines refused; the reasons are above\n"),
            "{args:?}: {}",
            ended.err
        );
    }
    let early = said(&["--plain"], "margins\nundo\nfilm 1000\nother\nskill own\n");
    assert!(early.code == Some(2) && early.err.contains("5 lines refused"), "{}", early.err);
}

#[test]
#[cfg(target_os = "linux")]
fn what_cannot_be_written_is_not_done_help_and_documents_too() {
    let home = folder();
    for args in [
        &["--help"][..],
        &["--version"],
        &["recommend", "--help"],
        &["man"],
        &["completions", "bash"],
        &["table", "list"],
        &["table", "show", "match"],
        &["config"],
        &["simulate", "--shot", "0,0.2,5,12.5,3"],
        &["simulate", "--shot", "0,0.2,5,12.5,3", "--json"],
        &["calibrate", "--template"],
    ] {
        let mut full = command(home.path(), args);
        full.stdout(fs::File::create("/dev/full").unwrap());
        let said = crate::program::outcome(full.spawn().unwrap());
        assert!(
            said.code == Some(1) && said.err.contains("cannot be written"),
            "{args:?}: {:?} {}",
            said.code,
            said.err
        );
        assert_eq!(said.err.lines().count(), 1, "{args:?}: {}", said.err);
        let read = carom(home.path(), args);
        assert!(read.code == Some(0) && read.err.is_empty() && !read.out.is_empty(), "{args:?}: {}", read.err);
    }
    assert_eq!(drill(home.path(), &["--help"]).code, Some(0));
}
