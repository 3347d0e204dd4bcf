//! The command line through the real binary: answers, JSON, batches, and what happens to bad input.

use std::path::Path;

use assert_cmd::Command;
use serde_json::Value;

use crate::program::asked as carom;

fn json(args: &[&str]) -> Value {
    let output = carom(args).assert().success().get_output().stdout.clone();
    serde_json::from_slice(&output).unwrap()
}

fn lines(output: &[u8]) -> Vec<Value> {
    String::from_utf8_lossy(output).lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

/// Returns the exit code and the message for input that must leave the standard output empty.
fn refusal(command: &mut Command) -> (i32, String) {
    let output = command.output().unwrap();
    assert!(output.stdout.is_empty(), "nothing may be written for refused input");
    (output.status.code().unwrap(), String::from_utf8(output.stderr).unwrap())
}

const LAYOUT: &str = "-0.5,0 0,0 0.5,0.03";
const SHOT: &str = "0,0.3,0,1,4";

#[test]
fn simulate_tells_the_events_to_people_and_to_programs() {
    let text = carom(&["simulate", "--layout", LAYOUT, "--shot", SHOT]).assert().success();
    let text = String::from_utf8_lossy(&text.get_output().stdout).into_owned();
    assert!(text.contains("impulse: V0 = (4.9") && text.contains("ball-ball") && text.contains("all still after"));
    let answer = json(&["simulate", "--layout", LAYOUT, "--shot", SHOT, "--json"]);
    assert_eq!(answer["events"][0]["kind"], "ball-ball");
    assert_eq!(answer["events"][0]["balls"], serde_json::json!([0, 1]));
    assert_eq!(answer["final"].as_array().unwrap().len(), 3);
    assert!(answer["duration"].as_f64().unwrap() > 1.0);
}

#[test]
fn layouts_may_be_written_in_diamonds() {
    let metres = json(&["simulate", "--layout", "-0.71,0 0.71,0 -0.71,0.355", "--shot", SHOT, "--json"]);
    let diamonds = json(&["simulate", "--layout", "2d,2d 6d,2d 2d,3d", "--shot", SHOT, "--json"]);
    assert_eq!(metres["events"], diamonds["events"]);
}

#[test]
fn a_batch_answers_every_line_in_order_and_goes_on_after_a_bad_one() {
    let shots = include_str!("../data/shots.jsonl");
    let mut input: Vec<&str> = shots.lines().take(3).collect();
    input.insert(1, r#"{"preset": "match", "layout": [[0,0],[0,0.01],[1,0]], "cue": {"a":0,"b":0,"theta_deg":0,"phi_deg":0,"speed":1}}"#);
    input.push("not json");
    let output = carom(&["simulate", "--batch", "-"]).write_stdin(input.join("\n")).assert().code(2);
    let answers = lines(&output.get_output().stdout);
    assert_eq!(answers.len(), 5);
    let refused = answers[1]["error"].as_str().unwrap();
    assert!(refused.starts_with("line 2: ") && refused.contains("0.0100"), "{refused}");
    assert!(answers[4]["error"].as_str().unwrap().contains("line 5"));
    let expected: Value = serde_json::from_str(shots.lines().next().unwrap()).unwrap();
    let difference = answers[0]["duration"].as_f64().unwrap() - expected["duration"].as_f64().unwrap();
    assert!(difference.abs() < 1e-9);
    assert!(String::from_utf8_lossy(&output.get_output().stderr).contains("2 of 5 lines"));
}

#[test]
fn recommend_gives_a_shot_that_simulates_to_a_point() {
    let answer = json(&["recommend", "--layout", LAYOUT, "--json"]);
    assert_eq!(answer["solved"], true);
    let cue = &answer["cue"];
    let number = |key: &str| cue[key].as_f64().unwrap();
    assert!(number("a").powi(2) + number("b").powi(2) <= 0.25);
    let shot =
        format!("{},{},{},{},{}", number("a"), number("b"), number("theta_deg"), number("phi_deg"), number("speed"));
    let played = json(&["simulate", "--layout", LAYOUT, "--shot", &shot, "--json"]);
    let meets = |ball: u64| {
        let pair = serde_json::json!([0, ball]);
        played["events"].as_array().unwrap().iter().any(|event| event["kind"] == "ball-ball" && event["balls"] == pair)
    };
    assert!(meets(1) && meets(2));
    for key in ["make_probability", "source", "simulations", "elapsed_ms", "alternatives"] {
        assert!(!answer[key].is_null(), "{key} is missing");
    }
}

#[test]
fn a_recommendation_is_told_as_a_player_says_it() {
    let args =
        [&["recommend", "--layout", LAYOUT, "--skill", "club", "--margins"][..], &["--simulations", "4000"]].concat();
    let answer = json(&[&args[..], &["--json"]].concat());
    let words = &answer["words"];
    let sentence = words["sentence"].as_str().unwrap();
    assert!(sentence.contains(" table length") && sentence.contains("cue"), "{sentence}");
    assert!(words["table_lengths"].as_f64().unwrap() > 0.0 && words["ahead"]["diamond"].is_number(), "{words}");
    assert!(answer["pattern"].is_string() && answer["why"]["sentence"].is_string(), "{answer}");
    for other in answer["alternatives"].as_array().unwrap() {
        assert!(other["pattern"].is_string() && other["words"]["course"].is_string(), "{other}");
    }
    let home = tempfile::tempdir().unwrap();
    let text = |settings: &str| {
        std::fs::create_dir_all(home.path().join("carom")).unwrap();
        std::fs::write(home.path().join("carom/config.toml"), settings).unwrap();
        let told = carom(&args).env("XDG_CONFIG_HOME", home.path()).env("HOME", home.path()).output().unwrap();
        String::from_utf8(told.stdout).unwrap()
    };
    let told = text("");
    assert_eq!(told.lines().next(), Some(sentence), "{told}");
    assert!(told.contains("\nPattern: ") && told.contains("\nWhy: "), "{told}");
    assert!(
        told.contains("\nFor a player of skill \"club\" under the rule straight; --skill and --rule choose"),
        "{told}"
    );
    let others: Vec<&str> = told.lines().filter(|line| line.starts_with("or ")).collect();
    assert!(
        !others.is_empty() && others.iter().all(|line| line.contains("; first ") || line.contains("; cushion first"))
    );
    assert!(others.iter().all(|line| line.contains(" % of the time (")), "{told}");
    let told = text("tip_unit = \"mm\"\nplace_unit = \"mm\"\n");
    assert!(told.lines().nth(2).unwrap().contains(" mm on the "), "{told}");
    let told = text("length_unit = \"feet\"\n");
    assert!(told.contains(" more, ft/s") && told.contains(" more, in\n"), "{told}");
    let mut sorts = told.lines().filter(|line| line.starts_with("or ") || line.starts_with("a point "));
    assert!(sorts.all(|line| line.contains("8.2 ft/s") && !line.contains("m/s")), "{told}");
    let speed = answer["cue"]["speed"].as_f64().unwrap();
    let row = format!("V      {:>8.3} ft/s ({speed:.3} m/s where a shot is typed)", speed / 0.3048);
    assert!(told.contains(&row) && told.contains(") ft/s, w0 = "), "{told}");
}

#[test]
fn where_balls_roll_is_listed_where_it_is_asked_for() {
    let text = |more: &[&str]| {
        let args = [&["simulate", "--layout", LAYOUT, "--shot", SHOT], more].concat();
        String::from_utf8(carom(&args).output().unwrap().stdout).unwrap()
    };
    assert!(!text(&[]).contains("sliding-rolling") && text(&["--rolls"]).contains("sliding-rolling"));
}

#[test]
fn a_recommendation_says_how_sure_it_is_how_far_off_one_may_be_and_what_else_there_is() {
    let own = "a=0.7,b=0.7,theta=0.2,phi=0.2,V=0.1";
    let time = ["--budget-ms", "5000", "--simulations", "20000"];
    let args =
        [&["recommend", "--layout", LAYOUT, "--skill", own, "--margins", "--plan", "--json"][..], &time].concat();
    let answer = json(&args);
    let [rate, low, high] = [&answer["make_probability"], &answer["make_interval"][0], &answer["make_interval"][1]]
        .map(|n| n.as_f64().unwrap());
    assert!(0.0 < low && low <= rate && rate <= high && high <= 1.0);
    let kinds: Vec<_> = answer["alternatives"].as_array().unwrap().iter().map(|other| &other["kind"]).collect();
    assert!(!kinds.is_empty() && !kinds.contains(&&answer["kind"]), "{answer}");
    assert!(answer["next_probability"].as_f64().is_some_and(|next| next > 0.5));
    assert_eq!(answer["margins"].as_array().unwrap().len(), 5);
    assert_eq!(answer["maps"][0]["outcomes"][20][20], "point", "the shot is in the middle");
    assert!(answer["aim"]["hit"]["fullness"].is_number());
    let (code, said) = refusal(&mut carom(&["recommend", "--skill", "a=0.7,b=0.7,theta=0.2,phi=-1,V=0.1"]));
    assert!(code == 2 && said.contains("phi = -1") && said.contains("0 to 45 degrees"), "{said}");
}

#[test]
fn self_play_counts_points_and_misses() {
    let args = ["evaluate", "--self-play", "--rule", "three-cushion", "--skill", "beginner", "--layouts", "3"];
    let report = json(&[&args[..], &["--budget-ms", "20", "--most-points", "2", "--json"]].concat());
    let number = |key: &str| report[key].as_u64().unwrap();
    assert_eq!(report["runs"].as_array().unwrap().len(), 3);
    assert_eq!(number("misses") + number("broken_off"), 3);
    assert!(number("longest") <= 2 && number("points") <= 6);
    // With a single turn, the mean must equal the slowest turn. Regression test: the mean included the time to play the shot, too.
    let turn = json(&["evaluate", "--self-play", "--layouts", "1", "--most-points", "1", "--budget-ms", "9", "--json"]);
    assert_eq!(turn["mean_ms"], turn["slowest_ms"]);
}

#[test]
fn the_networks_alone_answer_without_a_simulation() {
    let answer = json(&["recommend", "--policy-only", "--json"]);
    assert_eq!((&answer["source"], &answer["simulations"]), (&"policy".into(), &0.into()));
}

#[test]
fn networks_that_never_saw_anybody_err_say_nothing_of_players_who_do() {
    let models = Path::new(env!("CARGO_MANIFEST_DIR")).join("models");
    let is_told = |model: &str, skill| {
        let policy = models.join(model).with_extension("safetensors");
        let policy = ["--rule", "three-cushion", "--policy", policy.to_str().unwrap(), "--skill", skill];
        json(&[&["recommend", "--policy-only", "--json"][..], &policy].concat())["make_probability"].is_number()
    };
    assert!(is_told("match-three-cushion", "perfect") && !is_told("match-three-cushion", "club"));
    assert!(is_told("context-three-cushion", "club") && !is_told("thesis-three-cushion", "perfect"));
}

#[test]
fn a_batch_of_layouts_takes_rules_and_tables_line_by_line() {
    let input = r#"{"preset":"match","layout":[[-0.5,0],[0,0],[0.5,0.03]],"rule":"3c"}
{"preset":"thesis","layout":[[-0.5,0],[0,0],[0.5,0.03]]}
{"preset":"snooker","layout":[[-0.5,0],[0,0],[0.5,0.03]]}
{"preset":"match","layout":[[-0.5,0],[0,0],[0.5,0.03]],"rule":"four-cushion"}
{"layout":[[-0.5,0],[0,0],[0.5,0.03]]}"#;
    let output = carom(&["recommend", "--batch", "-", "--budget-ms", "5000", "--simulations", "20000"])
        .write_stdin(input)
        .assert()
        .code(2);
    let answers = lines(&output.get_output().stdout);
    assert_eq!((&answers[0]["solved"], &answers[1]["solved"]), (&true.into(), &true.into()));
    assert!(answers[2]["error"].as_str().unwrap().contains("snooker"));
    assert!(answers[3]["error"].as_str().unwrap().contains("four-cushion"));
    assert!(answers[4]["error"].as_str().unwrap().contains("preset (the table, like \"match\") and layout"));
}

#[test]
fn where_the_time_runs_out_the_best_attempt_is_shown_and_said_to_be_one() {
    // The balls are in three corners and there is time for one batch of simulated shots at most, which finds no three-cushion shot.
    let layout = "-1.38,-0.67 1.38,0.67 1.38,-0.67";
    let args = ["recommend", "--table", "thesis", "--layout", "-1.2,-0.6 1.2,0.6 1.2,-0.6", "--rule", "three-cushion"];
    let output = carom(&args).args(["--budget-ms", "0", "--json"]).output().unwrap();
    let answer: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(answer["solved"], false);
    assert_eq!(output.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&output.stderr).contains("best attempt"));
    // The same on the table that has a policy must also end, whatever it finds.
    carom(&["recommend", "--layout", layout, "--budget-ms", "0"]).output().unwrap();
}

#[test]
fn a_wish_that_no_attempt_keeps_is_said_to_be_broken_and_a_miss_has_no_pattern() {
    let asked = |seed: &str| {
        let args = ["recommend", "--first", "cushion", "--simulations", "100", "--seed", seed];
        let output = carom(&args).output().unwrap();
        assert_eq!(output.status.code(), Some(1));
        let told = String::from_utf8(output.stdout).unwrap();
        assert!(!told.contains("Pattern: "), "{told}");
        (told.starts_with("Bottom long rail first"), String::from_utf8(output.stderr).unwrap())
    };
    let (keeps_wish, said) = asked("0");
    assert!(!keeps_wish && said.contains("with cushion first in "), "{said}");
    assert!(said.contains("; no such attempt either; this is a plain stroke, a larger --simulations may do"), "{said}");
    let (keeps_wish, said) = asked("4");
    assert!(keeps_wish && said.contains("; this is the best attempt"), "{said}");
}

#[test]
fn bad_input_gets_one_sentence_that_names_it_and_exit_code_two() {
    let folder = tempfile::tempdir().unwrap();
    let cellar = folder.path().join("cellar.toml");
    let table = include_str!("../../src/table/thesis.toml").replace("name = \"thesis\"", "name = \"cellar\"");
    std::fs::write(&cellar, table).unwrap();
    let cellar = cellar.to_str().unwrap();
    let cases: [(&[&str], &[&str]); 9] = [
        (&["simulate", "--layout", "9,0 0,0 0.5,0.5", "--shot", SHOT], &["9.0000", "1.3892"]),
        (&["simulate", "--layout", "0,0 0,0.01 0.5,0.5", "--shot", SHOT], &["0.0100", "0.0615"]),
        (&["simulate", "--layout", "NaN,0 0,0.01 0.5,0.5", "--shot", SHOT], &["NaN", "finite"]),
        (&["simulate", "--layout", "here", "--shot", SHOT], &["\"here\"", "metres"]),
        (&["simulate", "--shot", "0.9,0.9,0,0,1"], &["1.62", "at most 1"]),
        (&["simulate", "--shot", "0,0,0,0"], &["\"0,0,0,0\"", "a,b,theta,phi,V"]),
        (&["simulate", "--shot", "0,0,0,0,-1"], &["V = -1", "above 0"]),
        (&["simulate", "--shot", "0,0,0,1e6,1"], &["phi = ", "36000"]),
        (&["recommend", "--table", cellar, "--policy-only"], &["cellar", "--policy"]),
    ];
    for (args, words) in cases {
        let (code, said) = refusal(&mut carom(args));
        assert_eq!((code, said.lines().count()), (2, 1), "{args:?}: {said}");
        for word in words {
            assert!(said.contains(word), "{args:?} says {said}");
        }
    }
}

#[test]
fn a_negative_number_is_refused_by_the_range_and_not_as_an_option() {
    for (args, words) in [
        (&["recommend", "--budget-ms", "-5"][..], &["from 0 to 3600000", "--budget-ms"][..]),
        (&["recommend", "--seed", "-1"], &["from 0 to 18446744073709551615", "--seed"]),
        (&["simulate", "--shot", SHOT, "--method", "steps", "--dt", "-1"], &["dt = -1", "accepted"]),
        (&["drill", "list", "--grade", "-1"], &["from 0 to 5", "--grade"]),
        (&["bench", "--seconds", "-1"], &["-1"]),
        (&["evaluate", "--layouts", "-2"], &["from 1 to 10000000", "--layouts"]),
    ] {
        let (code, said) = refusal(&mut carom(args));
        assert_eq!(code, 2, "{args:?}: {said}");
        assert!(words.iter().all(|word| said.contains(word)) && !said.contains("unexpected"), "{args:?}: {said}");
    }
}

#[test]
fn without_a_terminal_one_sentence_names_the_command_line() {
    let (code, said) = refusal(&mut carom(&[]));
    assert_eq!(code, 2);
    assert!(said.contains("carom recommend"), "{said}");
}

#[test]
fn a_table_of_ones_own_is_read_from_toml() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("club.toml");
    let text = include_str!("../../src/table/match.toml").replace("\"match\"", "\"club\"");
    std::fs::write(&path, &text).unwrap();
    let table = path.to_str().unwrap();
    let own = json(&["simulate", "--table", table, "--layout", LAYOUT, "--shot", SHOT, "--json"]);
    assert_eq!(own, json(&["simulate", "--layout", LAYOUT, "--shot", SHOT, "--json"]));
    std::fs::write(&path, text.replace("mu_s = 0.2", "mu_s = -1")).unwrap();
    let (code, said) = refusal(&mut carom(&["simulate", "--table", table, "--shot", SHOT]));
    assert!(code == 2 && said.contains("mu_s = -1"), "{said}");
}

#[test]
fn the_recommender_finds_a_point_on_all_of_two_thousand_layouts() {
    let report = json(&["evaluate", "--layouts", "2000", "--seed", "11", "--json"]);
    assert_eq!(report["success"]["successes"], 2000);
}

#[test]
fn a_table_before_the_subcommand_is_not_silently_ignored() {
    let (code, said) = refusal(&mut carom(&["--table", "thesis", "recommend"]));
    assert!(code == 2 && said.contains("--table"), "{said}");
}

#[test]
fn a_batch_line_is_named_by_its_place_in_the_file() {
    let output =
        carom(&["simulate", "--batch", "-"]).write_stdin(b"\n\n{\"preset\": 3}\n\xff\n".to_vec()).assert().code(2);
    let answers = lines(&output.get_output().stdout);
    let said = |index: usize| answers[index]["error"].as_str().unwrap().to_owned();
    assert!(said(0).contains("line 3") && !said(0).contains("line 1"), "{}", said(0));
    assert!(said(1).contains("line 4"), "{}", said(1));
}

#[test]
fn a_table_that_only_has_the_name_of_a_bundled_one_gets_no_bundled_policy() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("match.toml");
    std::fs::write(&path, include_str!("../../src/table/match.toml").replace("L = 2.84", "L = 4.0")).unwrap();
    let (code, said) = refusal(&mut carom(&["recommend", "--policy-only", "--table", path.to_str().unwrap()]));
    assert!(code == 2 && said.contains("no policy is bundled"), "{said}");
}

#[test]
fn a_recommendation_counts_on_the_diamonds_where_a_system_describes_it() {
    // Two balls are in the path of a bank from the corner: 50 - 30 = 20.
    let layout = "0.84,-0.32 -0.27,-0.55 -0.18,-0.63";
    let args = ["recommend", "--rule", "three-cushion", "--budget-ms", "60000", "--simulations", "20000"];
    let mut counted = 0;
    for seed in ["0", "1", "2"] {
        let answer = json(&[&args[..], &["--layout", layout, "--seed", seed, "--json"]].concat());
        let system = &answer["system"];
        let number = |name: &str| system[name].as_f64().unwrap();
        match system["name"].as_str() {
            Some("corner5") => assert!((number("start") - number("third") - number("first")).abs() < 0.2, "{system}"),
            Some("plus") => assert!((number("third") - number("start") - number("first")).abs() < 0.02, "{system}"),
            Some("seven") => assert!((number("start") * number("third") - number("first")).abs() < 0.2, "{system}"),
            Some("parallel-shift") => assert!((number("third") - number("arrival")).abs() <= 1.0, "{system}"),
            other => assert_eq!(other, None),
        }
        if let Some(name) = system["name"].as_str() {
            counted += 1;
            let text = carom(&[&args[..], &["--layout", layout, "--seed", seed]].concat()).output().unwrap().stdout;
            let line = if name == "parallel-shift" { "Parallel shift: " } else { "aim at " };
            assert!(String::from_utf8(text).unwrap().contains(line), "{name}");
        }
    }
    assert!(counted > 0, "no shot of three seeds takes three cushions in a row");
}

/// Writes a table file like `textbook` whose balls can leave the cloth.
fn flying_table(folder: &std::path::Path) -> String {
    let file = folder.join("flying.toml");
    std::fs::write(&file, format!("{}\n[flight]\n", include_str!("../../src/table/textbook.toml"))).unwrap();
    file.to_str().unwrap().to_owned()
}

#[test]
fn simulate_tells_how_high_and_far_a_jump_is_and_who_left_the_table() {
    let folder = tempfile::tempdir().unwrap();
    let table = flying_table(folder.path());
    let jump = ["simulate", "--table", &table, "--layout", "-0.5,0 -0.2,0.3 0.9,0.5", "--shot", "0,0,45,0,3"];
    let text = carom(&jump).assert().success();
    let text = String::from_utf8_lossy(&text.get_output().stdout).into_owned();
    assert!(text.contains(" mm high, ") && text.contains(" far\n") && text.contains("lands"), "{text}");
    let answer = json(&[&jump[..], &["--json"]].concat());
    let first = &answer["events"][0];
    assert!(first["kind"] == "jumps" && first["height"].as_f64().unwrap() > 0.02, "{first}");
    assert!(first["distance"].as_f64().unwrap() > 0.1 && answer.get("off_table").is_none(), "{answer}");
    let off = ["simulate", "--table", &table, "--layout", "0.9,0 0.1,0.3 0.1,-0.3", "--shot", "0,0,30,0,9"];
    let text = carom(&off).assert().success();
    let text = String::from_utf8_lossy(&text.get_output().stdout).into_owned();
    assert!(text.contains("Foul: white left the table over the right rail and goes to the "), "{text}");
    let answer = json(&[&off[..], &["--json"]].concat());
    assert_eq!(answer["off_table"], serde_json::json!([{"ball": "white", "rail": "right"}]));
    assert!(answer["point"] == false && answer["final"][0][0].as_f64().unwrap().abs() < 1.0, "{answer}");
    let left = answer["events"].as_array().unwrap().iter().find(|event| event["kind"] == "leaves-table").unwrap();
    assert_eq!(left["balls"], serde_json::json!([0]));
}

#[test]
fn a_batch_takes_upward_velocities_where_balls_may_fly_and_says_elsewhere_which_section_lets_them() {
    let folder = tempfile::tempdir().unwrap();
    let table = flying_table(folder.path());
    let line = |table: &str, up: f64| {
        let layout = "[[-0.5,0],[-0.2,0.3],[0.9,0.5]]";
        let impulse = format!(r#"{{"velocity": [2, 0, {up}], "spin": [0, 0, 0]}}"#);
        format!(r#"{{"preset": {}, "layout": {layout}, "impulse": {impulse}}}"#, Value::from(table))
    };
    let input = [line(&table, 1.0), line("textbook", 1.0), line(&table, -1.0)].join("\n");
    let output = carom(&["simulate", "--batch", "-"]).write_stdin(input).assert().code(2);
    let answers = lines(&output.get_output().stdout);
    let height = answers[0]["events"][0]["height"].as_f64().unwrap();
    assert!((height - 1.0 / (2.0 * 9.81)).abs() < 1e-3, "{}", answers[0]);
    let refused = answers[1]["error"].as_str().unwrap();
    assert!(refused.contains("1 m/s upwards") && refused.contains("[flight]"), "{refused}");
    assert!(answers[2]["error"].as_str().unwrap().contains("-1 m/s upwards"), "{}", answers[2]);
}

#[test]
fn a_stroke_at_which_the_tip_slips_off_is_played_and_called_a_miscue() {
    let miscue = |shot: &str| json(&["simulate", "--layout", LAYOUT, "--shot", shot, "--json"])["miscue"].clone();
    assert_eq!((miscue("0.6,0,0,0,3"), miscue(SHOT)), (Value::Bool(true), Value::Null));
    let line = format!(
        r#"{{"preset": "match", "layout": [[-0.5,0],[0,0],[0.5,0.03]], "cue": {}}}"#,
        r#"{"a": 0.6, "b": 0, "theta_deg": 0, "phi_deg": 0, "speed": 3}"#
    );
    let output = carom(&["simulate", "--batch", "-"]).write_stdin(line).assert().success();
    assert_eq!(lines(&output.get_output().stdout)[0]["miscue"], true);
}
