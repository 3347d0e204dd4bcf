//! The command line: verdicts of shots, consistent names of balls and directions, and typed names.

use serde_json::{Value, json};

use crate::program::{batch, carom, drill, folder, json_answer, run, stdout};

/// Returns the error message of a refused command.
fn refusal(args: &[&str]) -> String {
    let output = run(args);
    assert!(output.code != Some(0) && output.out.is_empty(), "{}", output.out);
    output.err
}

/// Returns the answer to one line of a batch.
fn batch_answer(args: &[&str], line: &str) -> Value {
    serde_json::from_str(&batch(args, line).ok().out).unwrap()
}

const LAYOUT: &str = "-0.5,0 0,0 0.5,0.03";
/// Meets yellow, a cushion, then red.
const ONE_CUSHION: &str = "0,0.4,0,0.3,3";
/// Meets four cushions first, then red, then yellow.
const CUSHIONS: &str = "0,0,0,100,8";

fn simulate<'a>(shot: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    [&["simulate", "--layout", LAYOUT, "--shot", shot], more].concat()
}

#[test]
fn a_simulated_shot_is_judged_by_the_requested_rule() {
    let straight = stdout(&simulate(ONE_CUSHION, &[]));
    assert!(straight.contains("Point: yellow, one cushion, red (straight)"), "{straight}");
    let three = stdout(&simulate(ONE_CUSHION, &["--rule", "three-cushion"]));
    assert!(three.contains("No point: one cushion before red, three needed (three-cushion)"), "{three}");
    let missed = stdout(&simulate("0,0,0,90,0.5", &["--rule", "one-cushion"]));
    assert!(missed.contains("No point: no ball was hit (one-cushion)"), "{missed}");
    assert!(refusal(&simulate(ONE_CUSHION, &["--rule", "snooker"])).contains("three-cushion"));
}

#[test]
fn json_output_contains_the_verdict_in_addition_to_events() {
    let straight = json_answer(&simulate(ONE_CUSHION, &["--json"]));
    let judged = |answer: &Value| json!([answer["rule"], answer["point"], answer["cushions_before_second"]]);
    assert_eq!(judged(&straight), json!(["straight", true, 1]));
    assert!(straight["events"].is_array() && straight["final"].is_array() && straight["duration"].is_number());
    let three = json_answer(&simulate(ONE_CUSHION, &["--json", "--rule", "three-cushion"]));
    assert_eq!(judged(&three), json!(["three-cushion", false, 1]));
    let missed = json_answer(&simulate("0,0,0,90,0.5", &["--json"]));
    assert_eq!((&missed["point"], missed.get("cushions_before_second")), (&json!(false), None));
}

/// The rules forbid a stroke at a ball that touches the cue ball.
#[test]
fn a_stroke_onto_a_touching_ball_is_a_foul() {
    let home = tempfile::tempdir().unwrap();
    // Two radii of "match" are 0.0615 m.
    let frozen = ["--layout", "0,0 0.0615,0 -0.3,0.02"];
    let foul = "the stroke pushes yellow, which touches the cue ball";
    let shot = |shot: &'static str, more: &[&'static str]| [&["simulate", "--shot", shot], &frozen[..], more].concat();
    assert!(stdout(&shot("0,-0.4,5,0,3", &[])).contains(&format!("Foul: {foul} (straight)")));
    let at_it = json_answer(&shot("0,-0.4,5,0,3", &["--json"]));
    assert_eq!((&at_it["point"], &at_it["foul"]), (&json!(false), &json!(foul)));
    assert_eq!((&at_it["cushions_before_second"], at_it["events"].is_array()), (&json!(0), true));
    let away = json_answer(&shot("0,0,5,180,3", &["--json"]));
    assert_eq!((&away["point"], away.get("foul")), (&json!(true), None));
    let line = json!({"preset": "match", "layout": [[0, 0], [0.0615, 0], [-0.3, 0.02]], "impulse": at_it["impulse"]});
    let given = batch_answer(&["simulate"], &line.to_string());
    assert_eq!((&given["point"], &given["foul"]), (&json!(false), &json!(foul)));
    drill(home.path(), &[&["save", "frozen"], &frozen[..]].concat());
    let tried = drill(home.path(), &["try", "frozen", "--shot", "0,-0.4,5,0,3", "--skill", "perfect"]).out;
    assert!(tried.contains(&format!("Foul: {foul}")), "{tried}");
}

/// The printed impulse of the stroke, used as input, plays the same shot; the motion of the balls is reported at any time.
#[test]
fn the_impulse_can_be_replayed_and_states_listed_at_times() {
    let stroke = json_answer(&simulate("0,0.4,0,0,2", &["--json", "--at", "0,0.5,100"]));
    let line = json!({"preset": "match", "layout": [[-0.5, 0], [0, 0], [0.5, 0.03]], "impulse": stroke["impulse"]});
    let replayed = batch_answer(&["simulate", "--at", "0.5"], &line.to_string());
    assert_eq!((&replayed["final"], &replayed["moments"][0]), (&stroke["final"], &stroke["moments"][1]));
    let white = |moment: usize| &stroke["moments"][moment]["balls"][0];
    let speed = |moment: usize| white(moment)["velocity"][0].as_f64().unwrap();
    assert_eq!(white(0)["velocity"][0], stroke["impulse"]["velocity"][0]);
    assert!(speed(0) > speed(1) && speed(2) == 0.0, "{stroke}");
    assert!(stdout(&simulate("0,0.4,0,0,2", &["--at", "0.5"])).contains("after 0.5 s:\n  white at ("));
    assert!(refusal(&simulate("0,0.4,0,0,2", &["--at", "-1"])).contains("0 or more"));
}

/// Only text uses the units of the settings: JSON stays in metres and millimetres.
#[test]
fn text_output_uses_the_units_of_the_settings() {
    let home = folder();
    let settings = home.path().join("config/carom");
    std::fs::create_dir_all(&settings).unwrap();
    let outputs = |args: &[&str]| {
        let [default, json] = [args.to_vec(), [args, &["--json"]].concat()].map(|args| carom(home.path(), &args).out);
        std::fs::write(settings.join("config.toml"), "length_unit = \"feet\"\ntip_unit = \"mm\"\n").unwrap();
        let other = [args.to_vec(), [args, &["--json"]].concat()].map(|args| carom(home.path(), &args).out);
        std::fs::remove_file(settings.join("config.toml")).unwrap();
        // The name of a session differs every time.
        let nameless =
            |text: &str| text.lines().filter(|line| !line.contains("\"session\"")).collect::<Vec<_>>().join("\n");
        assert_eq!(nameless(&json), nameless(&other[1]));
        (default, other[0].clone())
    };
    let (metres, feet) = outputs(&simulate(ONE_CUSHION, &["--at", "0.5"]));
    assert!(metres.contains(" m/s") && !metres.contains("ft/s"), "{metres}");
    assert!(feet.contains("ft/s, spin") && feet.contains(" ft/s\n") && !feet.contains("m/s"), "{feet}");
    let (tips, mm) = outputs(&["drill", "try", "mine", "--shot", "0,-0.2,3,1,2", "--skill", "perfect", "--seed", "1"]);
    assert!(tips.contains("tips up, harder 2.0 m/s") && mm.contains("tip up 15.4 mm, harder 6.6 ft/s"), "{tips}{mm}");
}

#[test]
fn a_batch_line_may_name_its_own_rule() {
    let line = |rule: &str| {
        let cue = r#"{"a":0,"b":0.4,"theta_deg":0,"phi_deg":0.3,"speed":3}"#;
        format!(r#"{{"preset":"match","layout":[[-0.5,0],[0,0],[0.5,0.03]],"cue":{cue}{rule}}}"#)
    };
    let input = [line(""), line(r#","rule":"straight""#)].join("\n");
    let rules = batch(&["simulate", "--rule", "three-cushion"], input).ok().json();
    assert_eq!(
        rules.iter().map(|line| (&line["rule"], &line["point"])).collect::<Vec<_>>(),
        [(&json!("three-cushion"), &json!(false)), (&json!("straight"), &json!(true))]
    );
}

/// Regression test: the messages used the jargon of the JSON library: `invalid type: string "4", expected f64, column 113`.
#[test]
fn a_refused_line_names_field_value_and_accepted_values() {
    let line = |name: &str, value: Value| {
        let cue = json!({"a": 0, "b": 0, "theta_deg": 0, "phi_deg": 1, "speed": 4});
        let mut line = json!({"preset": "match", "layout": [[-0.5, 0], [0, 0], [0.5, 0.03]], "cue": cue});
        line[name] = value;
        line.to_string()
    };
    let long = "x".repeat(100_000);
    let whole = line("rule", json!("straight"));
    for (line, words) in [
        (line("preset", json!(7)), &["\"preset\" is 7", "a table's name"][..]),
        (line("layout", json!([[0, 0], [0.5, 0]])), &["\"layout\" is [[0,0],[0.5,0]]", "three pairs [x, y]"]),
        (line("layout", json!("0,0 0.5,0 1,0")), &["\"layout\" is \"0,0 0.5,0 1,0\"", "three pairs [x, y]"]),
        (line("cue", json!({"a": 0, "theta": 0})), &["\"cue\" is {\"a\":0,\"theta\":0}", "\"theta_deg\"", "numbers"]),
        (line("cue", json!(long)), &["\"cue\" is \"xxx", "…", "\"theta_deg\""]),
        (line("impulse", json!({"velocity": 3})), &["\"impulse\" is {\"velocity\":3}", "[x, y, z]"]),
        (line("rule", json!("Straight")), &["\"rule\" is \"Straight\"", "\"three-cushion\""]),
        (whole[..40].to_owned(), &["it ends before its object does"]),
        (whole.replacen("match", "match\" \"", 1), &[" is not JSON"]),
        (whole.replacen("\"rule\"", "\"preset\": \"thesis\", \"rule\"", 1), &["\"preset\" occurs twice"]),
    ] {
        let output = batch(&["simulate"], line.as_str());
        let answer: Value = serde_json::from_str(&output.out).unwrap();
        let error = answer["error"].as_str().unwrap();
        assert!(output.code == Some(2) && error.starts_with("line 1 "), "{error}");
        assert!(words.iter().all(|word| error.contains(word)) && error.len() < 600, "{line:.200}: {error}");
        let jargon = ["invalid type", "f64", "array of length", "variant", "EOF"];
        assert!(!jargon.iter().any(|word| error.contains(*word)), "{error}");
    }
    let wrong = json!({"preset": "match", "layout": [[0, 0], [0.5, 0]], "rule": "straight"}).to_string();
    let output = batch(&["recommend"], wrong);
    assert!(output.out.contains("three pairs [x, y]"));
}

#[test]
fn text_output_names_balls_by_colour() {
    let simulated = stdout(&simulate(CUSHIONS, &[]));
    assert!(simulated.contains("white at (") && simulated.contains("red at ("), "{simulated}");
    let recommended =
        stdout(&["recommend", "--layout", LAYOUT, "--budget-ms", "5000", "--simulations", "2000", "--margins"]);
    for text in [&simulated, &recommended] {
        assert!(!text.contains("ball 0") && !text.contains("ball 1") && !text.contains("ball 2"), "{text}");
    }
    assert!(recommended.contains("hits yellow") || recommended.contains("hits red"), "{recommended}");
    assert!(stdout(&["simulate", "--help"]).contains("white is the cue ball"));
}

#[test]
fn directions_are_printed_from_0_to_below_360_degrees() {
    // The only course to both balls leads down to the right.
    let layout = "-0.5,0.3 0,0 0.3,-0.2";
    let common =
        ["recommend", "--layout", layout, "--budget-ms", "5000", "--simulations", "2000", "--skill", "perfect"];
    let text = stdout(&common);
    let phi = |line: &str| -> f64 { line.split_whitespace().nth(1).unwrap().parse().unwrap() };
    let shot = text.lines().find(|line| line.starts_with("phi")).map(phi).unwrap();
    assert!((0.0..360.0).contains(&shot), "{text}");
    let others = text.lines().filter(|line| line.starts_with("or "));
    for other in others {
        let phi: f64 = other.split(',').nth(3).unwrap().parse().unwrap();
        assert!((0.0..360.0).contains(&phi), "{other}");
    }
    let save = ["save", "down", "--replace", "--layout", layout, "--shot", "0,0,2,-30,3"];
    let home = tempfile::tempdir().unwrap();
    drill(home.path(), &save).ok();
    let shown = drill(home.path(), &["show", "down"]).out;
    assert!(shown.contains("0.0000,0.0000,2.000,330.000,3.000"), "{shown}");
}

#[test]
fn self_play_minutes_may_be_fractional() {
    let args = ["evaluate", "--self-play", "--layouts", "2", "--budget-ms", "20", "--most-points", "1", "--minutes"];
    let report = json_answer(&[&args[..], &["0.3", "--json"]].concat());
    assert_eq!(report["innings"], 2);
    for wrong in ["0", "-1", "NaN"] {
        let minutes = format!("--minutes={wrong}");
        let refused = refusal(&[&args[..8], &[&minutes]].concat());
        assert!(refused.contains(&format!("--minutes {wrong}")) && refused.contains("above 0"), "{refused}");
    }
}

#[test]
fn an_exercise_is_found_by_its_title_or_a_prefix() {
    let exercises = run(&["drill", "list", "--json"]).ok().json();
    let text = |exercise: &Value, key: &str| exercise[key].as_str().unwrap().to_owned();
    let (name, title) = (text(&exercises[3], "name"), text(&exercises[3], "title"));
    let by_name = stdout(&["drill", "show", &name]);
    for called in [name.to_uppercase(), title.clone(), title.to_lowercase()] {
        assert_eq!(stdout(&["drill", "show", &called]), by_name, "{called}");
    }
    let refused = refusal(&["drill", "show", "a"]);
    assert!(refused.contains("\"a\"") && refused.contains(" and ") && refused.lines().count() == 1, "{refused}");
    assert!(refusal(&["drill", "show", "no such exercise"]).contains("carom drill list"));
    // The record belongs to the exercise, whichever name was used.
    let home = tempfile::tempdir().unwrap();
    drill(home.path(), &["log", &title, "make"]).ok();
    let history = drill(home.path(), &["history", &title, "--json"]).out;
    assert!(history.contains("\"made\":1"), "{history}");
}
