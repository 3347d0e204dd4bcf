//! Small bugs that were found, each with its effect.

use std::{fs, os::unix::fs::PermissionsExt};

use crate::program::{carom, command, count_attempts, drill, folder, outcome, run_with_input};

const SLIPPERY: &str = "name = \"odd\"\nL = 2.54\nl = 1.27\nR = 0.0305\nm = 0.21\nM = 0.54\nmu_s = 0.2\nmu_r = 0.016\n\
    mu_sp = 0.044\ne_ball = 0.3\ne_rail = 0.3\nmu_rail = 0.2\ng = 9.81\nmiscue_limit = 1.0\nd = 0.163\n";

#[test]
fn unknown_keys_in_a_batch_are_refused() {
    let home = folder();
    let line = r#"{"preset":"match","layout":[[-0.5,0],[0,0],[0.5,0.03]],"rul":"three-cushion"}"#;
    let output = run_with_input(command(home.path(), &["recommend", "--budget-ms", "10", "--batch", "-"]), line);
    assert_eq!(output.code, Some(2));
    assert!(output.out.contains("rul") && output.out.contains("accepted are preset, layout, rule"), "{}", output.out);
    // Lines of files with answers are accepted as requests.
    let known = include_str!("../../data/shots.jsonl").lines().next().unwrap();
    run_with_input(command(home.path(), &["simulate", "--batch", "-"]), known).ok();
}

#[test]
fn an_overlong_line_is_refused_and_the_batch_continues() {
    let home = folder();
    let good = include_str!("../../data/shots.jsonl").lines().next().unwrap();
    let long = format!("{{\"id\": \"{}\"}}", "x".repeat(1 << 20));
    let output =
        run_with_input(command(home.path(), &["simulate", "--batch", "-"]), &format!("{good}\n{long}\n{good}\n"));
    assert_eq!(output.code, Some(2));
    let answers: Vec<&str> = output.out.lines().collect();
    assert!(answers.len() == 3 && answers[0] == answers[2], "{}", output.out);
    assert!(answers[1].contains("line 2 is too long; accepted are up to 1048576 bytes"), "{}", answers[1]);
}

#[test]
fn saving_an_invalid_stroke_names_the_accepted_forms() {
    let home = folder();
    for wrong in ["foo", "coach"] {
        let output = drill(home.path(), &["save", "mine", "--layout", "-0.5,0 0,0 0.5,0.03", "--shot", wrong])
            .fails(2, &[&format!("\"{wrong}\" is not understood; accepted are")]);
        assert!(output.err.contains("\"a,b,theta,phi,V\""), "{}", output.err);
        assert!(!output.err.contains("for the coach"), "{}", output.err);
    }
}

#[test]
fn an_endless_line_does_not_fill_memory() {
    let home = folder();
    let endless = std::fs::File::open("/dev/zero").unwrap();
    outcome(command(home.path(), &["simulate", "--batch", "-"]).stdin(endless).spawn().unwrap())
        .fails(1, &["a line has more than"]);
    carom(home.path(), &["simulate", "--batch", "/dev/zero"]).fails(1, &["a line has more than"]);
}

#[test]
fn concurrent_undos_each_remove_one_attempt() {
    let home = folder();
    drill(home.path(), &["log", "mine", "make", "miss", "make", "miss", "make", "make"]).ok();
    let all = [0; 4].map(|_| command(home.path(), &["drill", "log", "mine", "undo"]).spawn().unwrap());
    for child in all {
        outcome(child).ok();
    }
    assert_eq!(count_attempts(home.path()), 2);
}

#[test]
fn an_unreadable_own_skill_exits_with_one() {
    let home = folder();
    fs::write(home.path().join("carom/player.json"), "{").unwrap();
    for args in [&["recommend", "--skill", "own"][..], &["evaluate", "--skill", "own"]] {
        let output = carom(home.path(), args);
        assert_eq!(output.code, Some(1), "{}", output.err);
        assert!(output.err.starts_with("carom: "), "{}", output.err);
    }
    assert_eq!(carom(home.path(), &["recommend", "--skill", "nobody"]).code, Some(2));
}

#[test]
fn an_unwritable_folder_error_names_the_requested_file() {
    let home = folder();
    let shut = home.path().join("shut");
    fs::create_dir(&shut).unwrap();
    fs::set_permissions(&shut, fs::Permissions::from_mode(0o555)).unwrap();
    if fs::write(shut.join("probe"), "").is_ok() {
        // For a user with all permissions, such as root, nothing is refused.
        return;
    }
    let output = carom(home.path(), &["drill", "export", "shut/out.json"]);
    assert_eq!(output.code, Some(1));
    assert!(output.err.contains("shut/out.json") && !output.err.contains(".partial"), "{}", output.err);
}

#[test]
fn extreme_friction_never_yields_non_finite_numbers() {
    let home = folder();
    // A friction coefficient without unique forces, which once gave NaN, is refused; the largest accepted one can be computed.
    fs::write(home.path().join("t.toml"), format!("{SLIPPERY}mu_b = 1000\n")).unwrap();
    carom(home.path(), &["simulate", "--table", "t.toml", "--shot", "0,0,0,0,2"]).fails(2, &["mu_b = 1000"]);
    fs::write(home.path().join("t.toml"), format!("{SLIPPERY}mu_b = 0.99\n")).unwrap();
    let shot = |n: u32| {
        format!(
            r#"{{"preset":"t.toml","layout":[[-0.5,0],[0,0],[0.5,0.03]],"cue":{{"a":0.{},"b":-0.{},"theta_deg":{},"phi_deg":{},"speed":{}}}}}"#,
            n % 7,
            n % 5,
            n * 7 % 60,
            n % 5,
            1 + n % 7
        )
    };
    let lines: Vec<_> = (0..500).map(shot).collect();
    let output = run_with_input(command(home.path(), &["simulate", "--batch", "-"]), &lines.join("\n"));
    for line in output.out.lines() {
        assert!(!line.contains("null"), "{line}");
    }
    assert_eq!(output.out.lines().count(), lines.len());
}
