//! Room for the cue on the command line: notes, JSON and the answers of `recommend` on a table with rails of finite height.

use std::{fs, path::PathBuf};

use serde_json::Value;

use crate::program::{batch, run};

const TABLE: &str = "name = \"railed\"\nL = 2.84\nl = 1.42\nR = 0.03075\nm = 0.21\nM = 0.54\nmu_s = 0.2\nmu_r = 0.01\n\
                     mu_sp = 0.0124\ne_ball = 0.95\nmu_b = 0.06\ne_rail = 0.85\nmu_rail = 0.2\ng = 9.81\n\
                     miscue_limit = 0.25\nd = 0.1825\n";

/// White is frozen to the bottom rail.
const FROZEN: &str = "0,-0.67925 -0.5,0.3 0.6,0.1";

/// Writes the table with this ending to its own file.
fn table(name: &str, end: &str) -> PathBuf {
    let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("{name}.toml"));
    fs::write(&path, format!("{TABLE}{end}")).unwrap();
    path
}

#[test]
fn a_stroke_through_the_rail_is_simulated_with_a_note() {
    let path = table("railed", "[room]\n");
    let path = path.to_str().unwrap();
    let simulate = |shot: &str, more: &[&str]| {
        let args = ["simulate", "--table", path, "--layout", FROZEN, "--shot", shot];
        let output = run(&[&args[..], more].concat()).ok();
        [output.out, output.err]
    };
    let [text, note] = simulate("0,0.395,0,90,2", &[]);
    assert!(text.contains("all still after") && note.contains("the bottom rail is in the way"), "{note}");
    let [_, note] = simulate("0,0.1,60,90,2", &[]);
    assert!(note.contains("no room at any elevation"), "{note}");
    let [_, note] = simulate("0,0.5,3,90,2", &[]);
    assert_eq!(note, "");

    let answer = |shot: &str| serde_json::from_str::<Value>(&simulate(shot, &["--json"])[0]).unwrap();
    let low = answer("0,0.395,0,90,2");
    let least = low["cue_room"]["least_theta_deg"].as_f64().unwrap();
    assert!(low["cue_room"]["has_room"] == false && low["cue_room"]["over"] == "the bottom rail" && least > 1.0);
    let raised = answer(&format!("0,0.395,{},90,2", least + 0.001));
    assert_eq!(raised["cue_room"]["has_room"], true);
    let never = answer("0,0.1,60,90,2");
    assert!(never["cue_room"]["least_theta_deg"].is_null() && never["duration"].as_f64().unwrap() > 1.0);
}

#[test]
fn a_table_without_a_room_section_omits_cue_room() {
    let path = table("free", "");
    let args = ["simulate", "--table", path.to_str().unwrap(), "--layout", FROZEN, "--shot", "0,0.1,0,90,2", "--json"];
    let output = run(&args).ok();
    assert!(output.err.is_empty() && output.json()[0].get("cue_room").is_none(), "{}", output.err);
}

#[test]
fn recommended_strokes_have_room_for_the_cue() {
    let path = table("batch", "[room]\n");
    let question = serde_json::json!({
        "preset": path, "layout": [[0.0, -0.67925], [-0.5, 0.3], [0.6, 0.1]], "rule": "straight"
    });
    let ask = |args: &[&str], question: &Value| batch(args, format!("{question}\n")).ok().json().remove(0);
    let advice = ask(&["recommend", "--budget-ms", "100"], &question);
    let question = serde_json::json!({"preset": path, "layout": question["layout"], "cue": advice["cue"]});
    let answer = ask(&["simulate"], &question);
    assert_eq!(answer["cue_room"]["has_room"], true, "{advice} {answer}");

    let wrong = table("wrong", "[room]\nnose = 0.5\n");
    run(&["table", "check", wrong.to_str().unwrap()]).fails(2, &["room.nose = 0.5"]);
}
