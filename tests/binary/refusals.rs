//! What is refused, when, and with which message.

use std::{
    fs,
    io::{BufRead, BufReader, Write},
    process::Stdio,
};

use crate::program::{KillOnDrop, SAVE, carom, command, drill, folder, run_with_input};

#[test]
fn invalid_output_options_are_refused_before_a_calibration_starts() {
    let home = folder();
    fs::write(home.path().join("notes.toml"), "not a table").unwrap();
    for (args, code, named) in [
        (["--out", "nowhere/mine.toml"], 1, "there is no folder nowhere"),
        (["--out", "carom"], 1, "is no table"),
        (["--out", "notes.toml"], 1, "is no table"),
        (["--name", "match"], 2, "the name of a bundled table"),
        (["--name", " "], 2, "not all of them blanks"),
    ] {
        let output = run_with_input(command(home.path(), &[&["calibrate"], &args[..]].concat()), "9.6 5.4 4\ndone\n");
        assert!(output.code == Some(code) && output.err.contains(named), "{args:?}: {}", output.err);
        assert!(output.err.lines().count() == 1 && output.out.is_empty(), "{args:?}: {}", output.err);
    }
    assert!(!home.path().join("carom/calibration.toml").exists(), "nothing was asked for");
}

#[test]
fn invalid_agent_settings_are_refused_in_plain_words() {
    let home = folder();
    let message = |agent: &str, text: &str| {
        fs::write(home.path().join("own.toml"), text).unwrap();
        let line = ["train", "--agent", agent, "--run", "run", "--steps", "192", "--config", "own.toml"];
        let message = carom(home.path(), &line);
        assert!(message.code == Some(2) && message.err.lines().count() == 1, "{text}: {}", message.err);
        assert!(!home.path().join("run").exists(), "{text}");
        message.err
    };
    let again =
        "the settings in own.toml: line 2, heads: a name that is already used; accepted are lines like heads = 8";
    for (agent, text, words) in [
        ("ddpg", "# mine\nheads = \n", "the settings in own.toml: line 2, heads: "),
        ("ddpg", "heads = 8\nheads = 9\n", again),
        ("ddpg", "heads = 1979-05-27\n", "heads = \"1979-05-27\""),
        ("ddpg", "heads = 2.5", "expected a whole number; accepted is 1 to 256"),
        ("ddpg", "searched = -1", "expected a whole number; accepted is 0 to 4096"),
        ("ddpg", "actor_layers = [0.5]", "expected a whole number; accepted is 1 to 8192 units a layer"),
        ("ddpg", "actor_layers = []", "actor_layers = [] is outside its range; accepted is a list of 1 to 16 layers"),
        ("ddpg", "critic_layers = [320, 0]", "critic_layers = 0 is outside its range"),
        ("ddpg", "head_speeds = [[1, 2], [5, 1]]", "head_speeds = [5, 1] is outside its range; accepted is [low, h"),
        ("ddpg", "head_speeds = [[0.1, 2]]", "head_speeds = [0.1, 2] is outside its range"),
        ("ddpg", "head_speeds = [[3, 7]]", "head_speeds = [3, 7] is outside its range"),
        ("ddpg", "tau = \"low\"", "string \"low\", expected a number; accepted is more than 0, up to 1"),
        ("ddpg", "heads = 2\nranking = \"abc\"", "ranking = \"abc\": invalid type"),
        ("ddpg", "batch_size = 16777216", "accepted is 1 to 65536"),
        ("ddpg", "exploration = 1", "expected noise and uniform"),
        ("ddpg", "exploration = { unifrom = 0.1 }", "unifrom"),
        ("ddpg", "exploration = { noise = [0.1, -1] }", "exploration.noise = -1 is"),
        ("ddpg", "context = 1", "context = 1: invalid type: integer `1`, expected true or false"),
        ("ddpg", "actions = \"all\"", "actions = \"all\": unknown word `all`, expected `phi-v` or `full`"),
        ("ddpg", "memory = 1", "memory = 1: unknown setting `memory`, expected one of `actions`"),
        ("ddpg", "hindsight = 0.5", "hindsight = 0.5 is outside its range; accepted is 0, as"),
        ("ddpg", "demonstrations = 0.2", "demonstrations = 0.2 is outside its range; accepted is 0, as"),
        ("ddpg", "searched = 1", "use searched with context = true"),
        // Regression test: expert iteration started from a round in which only the critic learned; it continued like that unnoticed for ten
        // rounds.
        (
            "ddpg",
            "context = true\nsearched = 1\nimitation = 0.3\nactor_learning_rate = 1e-9",
            "actor_learning_rate of 1e-9",
        ),
        // Settings without any effect.
        ("ddpg", "imitation = 0.3", "imitation needs searched strokes"),
        ("ddpg", "attempts = 8", "use attempts with context = true"),
        ("ddpg", "perfect = 1.0", "use it with context = true"),
        ("ddpg", "ranking = 0.01", "ranking is less than the eight shots"),
        ("q-learning", "learning_rate = 1.5", "learning_rate = 1.5"),
        ("q-learning", "alpha = 0.1", "alpha"),
        ("dqn", "target_update_interval = 0.5", "expected a whole number; accepted is 1 to 16777216"),
        ("dqn", "epsilon = 1", "expected first, last and over"),
        ("dqn", "layers = [16, 0]", "layers = 0"),
        ("dqn", "episode = { shots = 0 }", "episode = 0"),
        ("thesis-ddpg", "noise = { sigma = \"x\" }", "noise = {\"sigma\":\"x\"}"),
        ("thesis-ddpg", "noise = { simga = 1 }", "simga"),
        ("thesis-ddpg", "noise = 1", "noise = 1: invalid type: integer `1`, expected theta, sigma and dt"),
        ("thesis-ddpg", "noise = { theta = 3, dt = 1 }", "noise.theta = 3"),
        ("thesis-ddpg", "noise_end_factor = 0", "noise_end_factor = 0"),
        ("thesis-ddpg", "polyak = -0.1", "polyak = -0.1"),
        ("thesis-ddpg", "hindsight = 0.7\ndemonstrations = 0.7", "hindsight + demonstrations = 1.4"),
    ] {
        let message = message(agent, text);
        assert!(message.contains(words), "{message}");
        // Settings that only thesis-ddpg has are not suggested for other agents.
        assert!(
            agent == "thesis-ddpg" || message.contains("accepted is 0, as") || !message.contains("hindsight"),
            "{message}"
        );
    }
    carom(home.path(), &["train", "--set", "=8"]).fails(2, &["write NAME=VALUE"]);
    carom(home.path(), &["train", "--config", "nowhere.toml"])
        .fails(1, &["the settings in nowhere.toml cannot be read"]);
}

#[test]
fn options_without_effect_are_refused() {
    let home = folder();
    let list = ["train", "--list"];
    for args in [
        &[&list[..], &["--steps", "5"]].concat()[..],
        &[&list[..], &["--agent", "dqn"]].concat(),
        &[&list[..], &["--seed", "5"]].concat(),
        &[&list[..], &["--set", "heads=8"]].concat(),
        &[&list[..], &["--jobs", "2"]].concat(),
        &["accuracy", "--filmed", "--seed", "5"],
        &["calibrate", "--tests", "--name", "mine"],
        &["calibrate", "--template", "--table", "thesis"],
    ] {
        carom(home.path(), args).fails(2, &["cannot be used with"]);
    }
}

#[test]
fn durations_and_texts_have_limits() {
    let home = folder();
    carom(home.path(), &["evaluate", "--layouts", "1", "--budget-ms", "3600001"]).fails(2, &["from 0 to 3600000"]);
    let long = "x".repeat(4001);
    for (option, accepted) in [("--point", "up to 4000"), ("--title", "up to 400"), ("--tag", "up to 400")] {
        drill(home.path(), &[SAVE, &["--replace", option, &long]].concat()).fails(2, &[accepted]);
    }
    drill(home.path(), &[SAVE, &["--replace", "--point", &long[1..]]].concat()).ok();
    for args in [
        &["simulate", "--batch", ""][..],
        &["recommend", "--batch", ""],
        &["recommend", "--policy", ""],
        &["evaluate", "--policy", ""],
    ] {
        carom(home.path(), args).fails(2, &["a value is required"]);
    }
    for args in [&["bench", "--seconds", "1e300"][..], &["recommend", "--skill", "a=1e300,b=1,theta=1,phi=1,V=1"]] {
        carom(home.path(), args).fails(2, &["1e300"]);
    }
}

#[test]
#[cfg(unix)]
fn a_file_in_place_of_a_folder_is_named() {
    let home = folder();
    fs::write(home.path().join("taken"), "").unwrap();
    for args in [
        &["drill", "export", "taken/mine.json"][..],
        &["calibrate", "--out", "taken/mine.toml"],
        &["train", "--run", "/dev/null", "--steps", "192"],
        &["train", "--run", "taken/run", "--steps", "192"],
    ] {
        let output = carom(home.path(), args).fails(1, &["folder"]);
        assert!(!output.err.contains("os error"), "{args:?}: {}", output.err);
    }
}

#[test]
fn jobs_is_refused_when_resuming_a_single_run() {
    let home = folder();
    let train = ["train", "--run", "run", "--steps", "192", "--evaluation-layouts", "5"];
    carom(home.path(), &train).ok();
    carom(home.path(), &["train", "--resume", "run", "--jobs", "2"]).fails(2, &["--jobs 2 is for several seeds"]);
}

#[test]
fn a_refused_undo_does_not_block_other_programs() {
    let home = folder();
    drill(home.path(), &["log", "mine", "undo"]).fails(1, &["no attempt at mine to undo"]);
    let mut log = command(home.path(), &["drill", "log", "mine"]);
    let mut log = KillOnDrop(log.stdin(Stdio::piped()).spawn().unwrap());
    let mut words = log.stdin.take().unwrap();
    words.write_all(b"undo\n").unwrap();
    let mut answer = String::new();
    BufReader::new(log.stderr.take().unwrap()).read_line(&mut answer).unwrap();
    assert!(answer.contains("to undo"), "{answer}");
    drill(home.path(), &["log", "mine", "make"]).ok();
    drop(words);
    assert_eq!(log.wait().unwrap().code(), Some(1), "nothing was undone");
}

#[test]
fn a_guest_without_a_terminal_creates_no_files() {
    let home = tempfile::tempdir().unwrap();
    let output = carom(home.path(), &["--guest", "--player", "anna"]).fails(2, &["this is not a terminal"]);
    assert!(output.err.contains("ssh -t") && !output.err.contains("carom recommend"), "{}", output.err);
    assert_eq!(fs::read_dir(home.path()).unwrap().count(), 0);
}

#[test]
fn a_folder_in_place_of_a_table_is_named() {
    let home = tempfile::tempdir().unwrap();
    fs::create_dir(home.path().join("dir")).unwrap();
    carom(home.path(), &["simulate", "--table", "dir", "--shot", "0,0.3,1,1,4"]).fails(1, &["it is a folder"]);
}
