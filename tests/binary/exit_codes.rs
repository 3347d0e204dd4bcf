//! The rule for exit codes, through the real binary; docs/command-line.md states it.

use std::fs;

use crate::program::{carom, command, drill, folder, outcome, run_with_input};

#[test]
fn missing_names_and_files_exit_with_one() {
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
        let output = carom(home.path(), args);
        assert!(
            output.code == Some(1) && output.err.contains("nowhere") || args.contains(&"own"),
            "{args:?}: {}",
            output.err
        );
        assert!(output.err.starts_with("carom: ") && output.out.is_empty(), "{args:?}: {}", output.err);
        assert_eq!(output.err.lines().count(), 1, "{args:?}: {}", output.err);
        assert!(!output.err.contains("os error"), "{args:?}: {}", output.err);
    }
}

#[test]
fn invalid_input_exits_with_two() {
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
        let output = carom(home.path(), args);
        assert!(output.code == Some(2) && !output.err.is_empty() && output.out.is_empty(), "{args:?}: {}", output.err);
        // Messages of clap have several lines.
        assert!(!output.err.starts_with("carom: ") || output.err.lines().count() == 1, "{args:?}: {}", output.err);
    }
}

#[test]
fn refused_input_lines_exit_with_two_at_the_end() {
    let home = folder();
    let run = |args: &[&str], lines: &str| run_with_input(command(home.path(), args), lines);
    for (args, good, refused) in [
        (&["--plain"][..], "where\nballs 0,0 0.5,0 1,0\nquit\n", "where\nballs 0,0 0,0 1,0\nperhaps\n"),
        (&["drill", "log", "mine"], "make\nmiss\n", "make\nperhaps\nmake it\n"),
        (&["drill", "run", "mine", "--goal", "9"], "0,0.3,0,1,2\n", "0,0.3,0,1,2\n0,0\nperhaps\n"),
        (&["calibrate"], "undo\ndone\n", "perhaps\nperhaps\ndone\n"),
    ] {
        assert_eq!(run(args, good).code, Some(0), "{args:?}");
        let ended = run(args, refused);
        assert!(
            ended.code == Some(2) && ended.err.ends_with("2 lines refused; the reasons are above\n"),
            "{args:?}: {}",
            ended.err
        );
    }
    run(&["--plain"], "margins\nundo\nfilm 1000\nother\nskill own\n").fails(2, &["5 lines refused"]);
}

#[test]
#[cfg(target_os = "linux")]
fn unwritable_output_exits_with_one() {
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
        let output = outcome(full.spawn().unwrap()).fails(1, &["cannot be written"]);
        assert_eq!(output.err.lines().count(), 1, "{args:?}: {}", output.err);
        let read = carom(home.path(), args);
        assert!(read.code == Some(0) && read.err.is_empty() && !read.out.is_empty(), "{args:?}: {}", read.err);
    }
    drill(home.path(), &["--help"]).ok();
}
