//! The command line through the real binary: answers, JSON, batches, and what happens to bad input.

use std::path::Path;

use serde_json::Value;

use crate::program::{batch, carom_command as carom, finished, json_answer, run, stdout};

/// Returns the exit code and the message for input that must leave the standard output empty.
fn refusal(args: &[&str]) -> (i32, String) {
    let output = run(args);
    assert!(output.out.is_empty(), "nothing may be written for refused input");
    (output.code.unwrap(), output.err)
}

const LAYOUT: &str = "-0.5,0 0,0 0.5,0.03";
const SHOT: &str = "0,0.3,0,1,4";

#[test]
fn simulate_prints_events_as_text_and_json() {
    let text = stdout(&["simulate", "--layout", LAYOUT, "--shot", SHOT]);
    assert!(text.contains("impulse: V0 = (4.9") && text.contains("ball-ball") && text.contains("all still after"));
    let answer = json_answer(&["simulate", "--layout", LAYOUT, "--shot", SHOT, "--json"]);
    assert_eq!(answer["events"][0]["kind"], "ball-ball");
    assert_eq!(answer["events"][0]["balls"], serde_json::json!([0, 1]));
    assert_eq!(answer["final"].as_array().unwrap().len(), 3);
    assert!(answer["duration"].as_f64().unwrap() > 1.0);
}

#[test]
fn layouts_may_be_given_in_diamonds() {
    let metres = json_answer(&["simulate", "--layout", "-0.71,0 0.71,0 -0.71,0.355", "--shot", SHOT, "--json"]);
    let diamonds = json_answer(&["simulate", "--layout", "2d,2d 6d,2d 2d,3d", "--shot", SHOT, "--json"]);
    assert_eq!(metres["events"], diamonds["events"]);
}

#[test]
fn a_batch_answers_every_line_and_continues_after_errors() {
    let shots = include_str!("../data/shots.jsonl");
    let mut input: Vec<&str> = shots.lines().take(3).collect();
    input.insert(1, r#"{"preset": "match", "layout": [[0,0],[0,0.01],[1,0]], "cue": {"a":0,"b":0,"theta_deg":0,"phi_deg":0,"speed":1}}"#);
    input.push("not json");
    let output = batch(&["simulate"], input.join("\n"));
    let answers = output.json();
    assert_eq!((output.code, answers.len()), (Some(2), 5));
    let refused = answers[1]["error"].as_str().unwrap();
    assert!(refused.starts_with("line 2: ") && refused.contains("0.0100"), "{refused}");
    assert!(answers[4]["error"].as_str().unwrap().contains("line 5"));
    let expected: Value = serde_json::from_str(shots.lines().next().unwrap()).unwrap();
    let difference = answers[0]["duration"].as_f64().unwrap() - expected["duration"].as_f64().unwrap();
    assert!(difference.abs() < 1e-9);
    assert!(output.err.contains("2 of 5 lines"));
}

#[test]
fn the_recommended_shot_makes_the_point_when_simulated() {
    let answer = json_answer(&["recommend", "--layout", LAYOUT, "--json"]);
    assert_eq!(answer["solved"], true);
    let cue = &answer["cue"];
    let number = |key: &str| cue[key].as_f64().unwrap();
    assert!(number("a").powi(2) + number("b").powi(2) <= 0.25);
    let shot =
        format!("{},{},{},{},{}", number("a"), number("b"), number("theta_deg"), number("phi_deg"), number("speed"));
    let played = json_answer(&["simulate", "--layout", LAYOUT, "--shot", &shot, "--json"]);
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
fn a_recommendation_is_described_in_players_words() {
    let args =
        [&["recommend", "--layout", LAYOUT, "--skill", "club", "--margins"][..], &["--simulations", "4000"]].concat();
    let answer = json_answer(&[&args[..], &["--json"]].concat());
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
        finished(carom(&args).env("XDG_CONFIG_HOME", home.path()).env("HOME", home.path())).out
    };
    let printed = text("");
    assert_eq!(printed.lines().next(), Some(sentence), "{printed}");
    assert!(printed.contains("\nPattern: ") && printed.contains("\nWhy: "), "{printed}");
    assert!(
        printed.contains("\nFor a player of skill \"club\" under the rule straight; --skill and --rule choose"),
        "{printed}"
    );
    let others: Vec<&str> = printed.lines().filter(|line| line.starts_with("or ")).collect();
    assert!(
        !others.is_empty() && others.iter().all(|line| line.contains("; first ") || line.contains("; cushion first"))
    );
    assert!(others.iter().all(|line| line.contains(" % of the time (")), "{printed}");
    let printed = text("tip_unit = \"mm\"\nplace_unit = \"mm\"\n");
    assert!(printed.lines().nth(2).unwrap().contains(" mm on the "), "{printed}");
    let printed = text("length_unit = \"feet\"\n");
    assert!(printed.contains(" more, ft/s") && printed.contains(" more, in\n"), "{printed}");
    let mut sorts = printed.lines().filter(|line| line.starts_with("or ") || line.starts_with("a point "));
    assert!(sorts.all(|line| line.contains("8.2 ft/s") && !line.contains("m/s")), "{printed}");
    let speed = answer["cue"]["speed"].as_f64().unwrap();
    let row = format!("V      {:>8.3} ft/s ({speed:.3} m/s where a shot is typed)", speed / 0.3048);
    assert!(printed.contains(&row) && printed.contains(") ft/s, w0 = "), "{printed}");
}

#[test]
fn transitions_to_rolling_are_listed_on_request() {
    let text = |more: &[&str]| stdout(&[&["simulate", "--layout", LAYOUT, "--shot", SHOT], more].concat());
    assert!(!text(&[]).contains("sliding-rolling") && text(&["--rolls"]).contains("sliding-rolling"));
}

#[test]
fn a_recommendation_has_interval_margins_maps_and_alternatives() {
    let own = "a=0.7,b=0.7,theta=0.2,phi=0.2,V=0.1";
    let time = ["--budget-ms", "5000", "--simulations", "20000"];
    let args =
        [&["recommend", "--layout", LAYOUT, "--skill", own, "--margins", "--plan", "--json"][..], &time].concat();
    let answer = json_answer(&args);
    let [rate, low, high] = [&answer["make_probability"], &answer["make_interval"][0], &answer["make_interval"][1]]
        .map(|n| n.as_f64().unwrap());
    assert!(0.0 < low && low <= rate && rate <= high && high <= 1.0);
    let kinds: Vec<_> = answer["alternatives"].as_array().unwrap().iter().map(|other| &other["kind"]).collect();
    assert!(!kinds.is_empty() && !kinds.contains(&&answer["kind"]), "{answer}");
    assert!(answer["next_probability"].as_f64().is_some_and(|next| next > 0.5));
    assert_eq!(answer["margins"].as_array().unwrap().len(), 5);
    assert_eq!(answer["maps"][0]["outcomes"][20][20], "point", "the shot is in the middle");
    assert!(answer["aim"]["hit"]["fullness"].is_number());
    let (code, message) = refusal(&["recommend", "--skill", "a=0.7,b=0.7,theta=0.2,phi=-1,V=0.1"]);
    assert!(code == 2 && message.contains("phi = -1") && message.contains("0 to 45 degrees"), "{message}");
}

#[test]
fn self_play_counts_points_and_misses() {
    let args = ["evaluate", "--self-play", "--rule", "three-cushion", "--skill", "beginner", "--layouts", "3"];
    let report = json_answer(&[&args[..], &["--budget-ms", "20", "--most-points", "2", "--json"]].concat());
    let number = |key: &str| report[key].as_u64().unwrap();
    assert_eq!(report["runs"].as_array().unwrap().len(), 3);
    assert_eq!(number("misses") + number("broken_off"), 3);
    assert!(number("longest") <= 2 && number("points") <= 6);
    // With a single turn, the mean must equal the slowest turn. Regression test: the mean included the time to play the shot, too.
    let turn =
        json_answer(&["evaluate", "--self-play", "--layouts", "1", "--most-points", "1", "--budget-ms", "9", "--json"]);
    assert_eq!(turn["mean_ms"], turn["slowest_ms"]);
}

#[test]
fn policy_only_recommends_without_simulations() {
    let answer = json_answer(&["recommend", "--policy-only", "--json"]);
    assert_eq!((&answer["source"], &answer["simulations"]), (&"policy".into(), &0.into()));
}

#[test]
fn make_probability_is_omitted_for_networks_trained_without_errors() {
    let models = Path::new(env!("CARGO_MANIFEST_DIR")).join("models");
    let is_told = |model: &str, skill| {
        let policy = models.join(model).with_extension("safetensors");
        let policy = ["--rule", "three-cushion", "--policy", policy.to_str().unwrap(), "--skill", skill];
        json_answer(&[&["recommend", "--policy-only", "--json"][..], &policy].concat())["make_probability"].is_number()
    };
    assert!(is_told("match-three-cushion", "perfect") && !is_told("match-three-cushion", "club"));
    assert!(is_told("context-three-cushion", "club") && !is_told("thesis-three-cushion", "perfect"));
}

#[test]
fn each_recommend_batch_line_has_its_own_rule_and_table() {
    let input = r#"{"preset":"match","layout":[[-0.5,0],[0,0],[0.5,0.03]],"rule":"3c"}
{"preset":"thesis","layout":[[-0.5,0],[0,0],[0.5,0.03]]}
{"preset":"snooker","layout":[[-0.5,0],[0,0],[0.5,0.03]]}
{"preset":"match","layout":[[-0.5,0],[0,0],[0.5,0.03]],"rule":"four-cushion"}
{"layout":[[-0.5,0],[0,0],[0.5,0.03]]}"#;
    let output = batch(&["recommend", "--budget-ms", "5000", "--simulations", "20000"], input);
    let answers = output.json();
    assert_eq!(output.code, Some(2));
    assert_eq!((&answers[0]["solved"], &answers[1]["solved"]), (&true.into(), &true.into()));
    assert!(answers[2]["error"].as_str().unwrap().contains("snooker"));
    assert!(answers[3]["error"].as_str().unwrap().contains("four-cushion"));
    assert!(answers[4]["error"].as_str().unwrap().contains("preset (the table, like \"match\") and layout"));
}

#[test]
fn a_recommend_batch_line_without_a_rule_has_that_of_the_command() {
    let line = |rule: &str| format!(r#"{{"preset":"match","layout":[[-0.5,0],[0,0],[0.5,0.03]]{rule}}}"#);
    let named = batch(&["recommend", "--policy-only"], line(r#","rule":"3c""#)).ok().json()[0]["cue"].clone();
    let [default, other] = ["three-cushion", "straight"].map(|rule| {
        let answer = batch(&["recommend", "--policy-only", "--rule", rule], line("")).ok();
        answer.json()[0]["cue"].clone()
    });
    assert!(default == named && other != named, "{named} {default} {other}");
}

#[test]
fn at_timeout_the_best_attempt_is_reported_as_such() {
    // The balls are in three corners and there is time for one batch of simulated shots at most, which finds no three-cushion shot.
    let layout = "-1.38,-0.67 1.38,0.67 1.38,-0.67";
    let args = ["recommend", "--table", "thesis", "--layout", "-1.2,-0.6 1.2,0.6 1.2,-0.6", "--rule", "three-cushion"];
    let output = run(&[&args[..], &["--budget-ms", "0", "--json"]].concat());
    assert_eq!((&output.json()[0]["solved"], output.code), (&Value::Bool(false), Some(1)));
    assert!(output.err.contains("best attempt"));
    // The same on the table that has a policy must also end, whatever it finds.
    run(&["recommend", "--layout", layout, "--budget-ms", "0"]);
}

#[test]
fn an_unmet_first_contact_wish_is_reported() {
    let recommend = |table: &str, seed: &str| {
        let args = ["recommend", "--table", table, "--first", "cushion", "--simulations", "100", "--seed", seed];
        let output = run(&args);
        assert_eq!(output.code, Some(1));
        assert!(!output.out.contains("Pattern: "), "{}", output.out);
        (output.out.contains(" rail first at "), output.err)
    };
    // The networks of this table propose no shot that begins with a cushion.
    let (keeps_wish, message) = recommend("thesis", "0");
    assert!(!keeps_wish && message.contains("with cushion first in "), "{message}");
    assert!(
        message.contains("; no attempt begins that way; this is a plain stroke, a larger --simulations may help"),
        "{message}"
    );
    let (keeps_wish, message) = recommend("match", "4");
    assert!(keeps_wish && message.contains("; this is the best attempt"), "{message}");
}

#[test]
fn a_game_cannot_open_with_yellow() {
    let args = ["recommend", "--rule", "three-cushion", "--first", "yellow", "--simulations", "100"];
    run(&args).fails(1, &["there is no point with yellow first: a game opens with red"]);
}

#[test]
fn invalid_input_gets_one_sentence_and_exit_code_two() {
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
        let (code, message) = refusal(args);
        assert_eq!((code, message.lines().count()), (2, 1), "{args:?}: {message}");
        for word in words {
            assert!(message.contains(word), "{args:?} says {message}");
        }
    }
}

#[test]
fn negative_numbers_are_refused_by_range_not_as_options() {
    for (args, words) in [
        (&["recommend", "--budget-ms", "-5"][..], &["from 0 to 3600000", "--budget-ms"][..]),
        (&["recommend", "--seed", "-1"], &["from 0 to 18446744073709551615", "--seed"]),
        (&["simulate", "--shot", SHOT, "--method", "steps", "--dt", "-1"], &["dt = -1", "accepted"]),
        (&["drill", "list", "--grade", "-1"], &["from 0 to 5", "--grade"]),
        (&["bench", "--seconds", "-1"], &["-1"]),
        (&["evaluate", "--layouts", "-2"], &["from 1 to 10000000", "--layouts"]),
        (&["train", "--threads", "-1"], &["from 1 to 1024", "--threads"]),
    ] {
        let (code, message) = refusal(args);
        assert_eq!(code, 2, "{args:?}: {message}");
        assert!(
            words.iter().all(|word| message.contains(word)) && !message.contains("unexpected"),
            "{args:?}: {message}"
        );
    }
}

#[test]
fn a_users_table_is_read_from_toml() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("club.toml");
    let text = include_str!("../../src/table/match.toml").replace("\"match\"", "\"club\"");
    std::fs::write(&path, &text).unwrap();
    let table = path.to_str().unwrap();
    let own = json_answer(&["simulate", "--table", table, "--layout", LAYOUT, "--shot", SHOT, "--json"]);
    assert_eq!(own, json_answer(&["simulate", "--layout", LAYOUT, "--shot", SHOT, "--json"]));
    std::fs::write(&path, text.replace("mu_s = 0.2", "mu_s = -1")).unwrap();
    let (code, message) = refusal(&["simulate", "--table", table, "--shot", SHOT]);
    assert!(code == 2 && message.contains("mu_s = -1"), "{message}");
}

#[test]
fn the_recommender_finds_a_point_on_all_of_two_thousand_layouts() {
    let report = json_answer(&["evaluate", "--layouts", "2000", "--seed", "11", "--json"]);
    assert_eq!(report["success"]["successes"], 2000);
}

#[test]
fn a_table_before_the_subcommand_is_not_silently_ignored() {
    let (code, message) = refusal(&["--table", "thesis", "recommend"]);
    assert!(code == 2 && message.contains("--table"), "{message}");
}

#[test]
fn batch_errors_name_the_line_number_in_the_file() {
    let output = batch(&["simulate"], b"\n\n{\"preset\": 3}\n\xff\n");
    let answers = output.json();
    assert_eq!(output.code, Some(2));
    let error = |index: usize| answers[index]["error"].as_str().unwrap().to_owned();
    assert!(error(0).contains("line 3") && !error(0).contains("line 1"), "{}", error(0));
    assert!(error(1).contains("line 4"), "{}", error(1));
}

#[test]
fn a_modified_table_with_a_bundled_name_has_no_policy() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("match.toml");
    std::fs::write(&path, include_str!("../../src/table/match.toml").replace("L = 2.84", "L = 4.0")).unwrap();
    let (code, message) = refusal(&["recommend", "--policy-only", "--table", path.to_str().unwrap()]);
    assert!(code == 2 && message.contains("no policy is bundled"), "{message}");
}

#[test]
fn a_recommendation_includes_the_matching_diamond_system() {
    // Two balls are in the path of a bank from the corner: 50 - 30 = 20.
    let layout = "0.84,-0.32 -0.27,-0.55 -0.18,-0.63";
    let args = ["recommend", "--rule", "three-cushion", "--budget-ms", "60000", "--simulations", "20000"];
    let mut counted = 0;
    for seed in ["0", "1", "2"] {
        let answer = json_answer(&[&args[..], &["--layout", layout, "--seed", seed, "--json"]].concat());
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
            let text = run(&[&args[..], &["--layout", layout, "--seed", seed]].concat()).out;
            let line = if name == "parallel-shift" { "Parallel shift: " } else { "aim at " };
            assert!(text.contains(line), "{name}");
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
fn simulate_reports_jumps_and_balls_off_the_table() {
    let folder = tempfile::tempdir().unwrap();
    let table = flying_table(folder.path());
    let jump = ["simulate", "--table", &table, "--layout", "-0.5,0 -0.2,0.3 0.9,0.5", "--shot", "0,0,45,0,3"];
    let text = stdout(&jump);
    assert!(text.contains(" mm high, ") && text.contains(" far\n") && text.contains("lands"), "{text}");
    let answer = json_answer(&[&jump[..], &["--json"]].concat());
    let first = &answer["events"][0];
    assert!(first["kind"] == "jumps" && first["height"].as_f64().unwrap() > 0.02, "{first}");
    assert!(first["distance"].as_f64().unwrap() > 0.1 && answer.get("off_table").is_none(), "{answer}");
    let off = ["simulate", "--table", &table, "--layout", "0.9,0 0.1,0.3 0.1,-0.3", "--shot", "0,0,30,0,9"];
    let text = stdout(&off);
    assert!(text.contains("Foul: white left the table over the right rail and goes to the "), "{text}");
    let answer = json_answer(&[&off[..], &["--json"]].concat());
    assert_eq!(answer["off_table"], serde_json::json!([{"ball": "white", "rail": "right"}]));
    assert!(answer["point"] == false && answer["final"][0][0].as_f64().unwrap().abs() < 1.0, "{answer}");
    let left = answer["events"].as_array().unwrap().iter().find(|event| event["kind"] == "leaves-table").unwrap();
    assert_eq!(left["balls"], serde_json::json!([0]));
}

#[test]
fn upward_velocities_need_a_table_with_a_flight_section() {
    let folder = tempfile::tempdir().unwrap();
    let table = flying_table(folder.path());
    let line = |table: &str, up: f64| {
        let layout = "[[-0.5,0],[-0.2,0.3],[0.9,0.5]]";
        let impulse = format!(r#"{{"velocity": [2, 0, {up}], "spin": [0, 0, 0]}}"#);
        format!(r#"{{"preset": {}, "layout": {layout}, "impulse": {impulse}}}"#, Value::from(table))
    };
    let input = [line(&table, 1.0), line("textbook", 1.0), line(&table, -1.0)].join("\n");
    let output = batch(&["simulate"], input);
    let answers = output.json();
    assert_eq!(output.code, Some(2));
    let height = answers[0]["events"][0]["height"].as_f64().unwrap();
    assert!((height - 1.0 / (2.0 * 9.81)).abs() < 1e-3, "{}", answers[0]);
    let refused = answers[1]["error"].as_str().unwrap();
    assert!(refused.contains("1 m/s upwards") && refused.contains("[flight]"), "{refused}");
    assert!(answers[2]["error"].as_str().unwrap().contains("-1 m/s upwards"), "{}", answers[2]);
}

#[test]
fn a_stroke_beyond_the_miscue_limit_is_reported() {
    let miscue =
        |shot: &str| json_answer(&["simulate", "--layout", LAYOUT, "--shot", shot, "--json"])["miscue"].clone();
    assert_eq!((miscue("0.6,0,0,0,3"), miscue(SHOT)), (Value::Bool(true), Value::Null));
    let line = format!(
        r#"{{"preset": "match", "layout": [[-0.5,0],[0,0],[0.5,0.03]], "cue": {}}}"#,
        r#"{"a": 0.6, "b": 0, "theta_deg": 0, "phi_deg": 0, "speed": 3}"#
    );
    assert_eq!(batch(&["simulate"], line).ok().json()[0]["miscue"], true);
}
