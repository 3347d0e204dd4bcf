//! Small bugs that were found, each with its effect.

use std::{fs, os::unix::fs::PermissionsExt};

use crate::program::{carom, command, drill, fed, folder, outcome, tried};

const SLIPPERY: &str = "name = \"odd\"\nL = 2.54\nl = 1.27\nR = 0.0305\nm = 0.21\nM = 0.54\nmu_s = 0.2\nmu_r = 0.016\n\
    mu_sp = 0.044\ne_ball = 0.3\ne_rail = 0.3\nmu_rail = 0.2\ng = 9.81\nmiscue_limit = 1.0\nd = 0.163\n";

#[test]
fn unknown_keys_of_a_batch_are_refused() {
    let home = folder();
    let line = r#"{"preset":"match","layout":[[-0.5,0],[0,0],[0.5,0.03]],"rul":"three-cushion"}"#;
    let said = fed(command(home.path(), &["recommend", "--budget-ms", "10", "--batch", "-"]), line);
    assert_eq!(said.code, Some(2));
    assert!(said.out.contains("rul") && said.out.contains("accepted are preset, layout, rule"), "{}", said.out);
    // Lines of files with answers are accepted as requests.
    let known = include_str!("../../data/shots.jsonl").lines().next().unwrap();
    assert_eq!(fed(command(home.path(), &["simulate", "--batch", "-"]), known).code, Some(0));
}

#[test]
fn a_line_that_is_too_long_is_refused_and_the_rest_go_on() {
    let home = folder();
    let good = include_str!("../../data/shots.jsonl").lines().next().unwrap();
    let long = format!("{{\"id\": \"{}\"}}", "x".repeat(1 << 20));
    let said = fed(command(home.path(), &["simulate", "--batch", "-"]), &format!("{good}\n{long}\n{good}\n"));
    assert_eq!(said.code, Some(2));
    let answers: Vec<&str> = said.out.lines().collect();
    assert!(answers.len() == 3 && answers[0] == answers[2], "{}", said.out);
    assert!(answers[1].contains("line 2 is too long; accepted are up to 1048576 bytes"), "{}", answers[1]);
}

#[test]
fn a_stroke_of_a_saved_position_that_is_none_is_refused_by_what_is_accepted() {
    let home = folder();
    for wrong in ["foo", "coach"] {
        let said = drill(home.path(), &["save", "mine", "--layout", "-0.5,0 0,0 0.5,0.03", "--shot", wrong]);
        assert_eq!(said.code, Some(2));
        assert!(said.err.contains(&format!("\"{wrong}\" is not understood; accepted are")), "{}", said.err);
        assert!(said.err.contains("\"a,b,theta,phi,V\""), "{}", said.err);
        assert!(!said.err.contains("for the coach"), "{}", said.err);
    }
}

#[test]
fn a_line_without_an_end_fills_no_memory() {
    let home = folder();
    let endless = std::fs::File::open("/dev/zero").unwrap();
    let said = outcome(command(home.path(), &["simulate", "--batch", "-"]).stdin(endless).spawn().unwrap());
    assert_eq!(said.code, Some(1));
    assert!(said.err.contains("a line has more than"), "{}", said.err);
    let said = carom(home.path(), &["simulate", "--batch", "/dev/zero"]);
    assert_eq!(said.code, Some(1));
    assert!(said.err.contains("a device") && said.err.contains("accepted is a regular file"), "{}", said.err);
}

#[test]
fn notes_that_several_take_back_at_once_are_taken_back_once_each() {
    let home = folder();
    assert_eq!(drill(home.path(), &["log", "mine", "make", "miss", "make", "miss", "make", "make"]).code, Some(0));
    for left in [2] {
        let all: Vec<_> =
            (0..4).map(|_| command(home.path(), &["drill", "log", "mine", "undo"]).spawn().unwrap()).collect();
        for child in all {
            let said = outcome(child);
            assert_eq!(said.code, Some(0), "{}", said.err);
        }
        assert_eq!(tried(home.path()), left);
    }
}

#[test]
fn an_own_skill_that_cannot_be_read_is_no_wrong_input() {
    let home = folder();
    fs::write(home.path().join("carom/player.json"), "{").unwrap();
    for args in [&["recommend", "--skill", "own"][..], &["evaluate", "--skill", "own"]] {
        let said = carom(home.path(), args);
        assert_eq!(said.code, Some(1), "{}", said.err);
        assert!(said.err.starts_with("carom: "), "{}", said.err);
    }
    assert_eq!(carom(home.path(), &["recommend", "--skill", "nobody"]).code, Some(2));
}

#[test]
fn a_folder_that_cannot_be_written_is_named_and_no_file_that_is_not_there() {
    let home = folder();
    let shut = home.path().join("shut");
    fs::create_dir(&shut).unwrap();
    fs::set_permissions(&shut, fs::Permissions::from_mode(0o555)).unwrap();
    if fs::write(shut.join("probe"), "").is_ok() {
        // For a user with all permissions, such as root, nothing is refused.
        return;
    }
    let said = carom(home.path(), &["drill", "export", "shut/out.json"]);
    assert_eq!(said.code, Some(1));
    assert!(said.err.contains("shut/out.json") && !said.err.contains(".partial"), "{}", said.err);
}

#[test]
fn numbers_that_are_not_finite_are_an_error() {
    let home = folder();
    // A friction coefficient without unique forces, which once gave NaN, is refused; the largest accepted one can be computed.
    fs::write(home.path().join("t.toml"), format!("{SLIPPERY}mu_b = 1000\n")).unwrap();
    let refused = carom(home.path(), &["simulate", "--table", "t.toml", "--shot", "0,0,0,0,2"]);
    assert!(refused.code == Some(2) && refused.err.contains("mu_b = 1000"), "{}", refused.err);
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
    let said = fed(command(home.path(), &["simulate", "--batch", "-"]), &lines.join("\n"));
    for line in said.out.lines() {
        assert!(!line.contains("null"), "{line}");
    }
    assert_eq!(said.out.lines().count(), lines.len());
}

#[test]
fn fixed_steps_that_nobody_can_wait_for_are_refused() {
    let home = folder();
    let shot = ["simulate", "--layout", "-0.5,0 0,0 0.5,0.03", "--shot", "0,0.3,0,1,4", "--method", "steps", "--dt"];
    let said = carom(home.path(), &[&shot[..], &["1e-8"]].concat());
    assert_eq!(said.code, Some(2));
    assert!(said.err.contains("accepted is"), "{}", said.err);
    assert_eq!(carom(home.path(), &[&shot[..], &["1e-3"]].concat()).code, Some(0));
}
