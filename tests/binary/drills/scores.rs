//! Playing, logging, and the resulting scores.

use serde_json::{Value, json};

use super::of_kind;
use crate::program::{SAVE, carom, command, drill, folder, run_with_input, session_files};

#[test]
fn logged_results_are_scored_correctly() {
    let folder = folder();
    let undo = |times| drill(folder.path(), &[&["log", "mine"][..], &["undo"].repeat(times)].concat()).code;
    drill(folder.path(), &["log", "mine", "make", "make", "miss", "make", "miss", "miss"]);
    assert_eq!(undo(1), Some(0));
    let log = drill(folder.path(), &["log", "mine", "undo", "--json"]);
    let score = &log.json()[0];
    assert_eq!([&score["tried"], &score["made"], &score["innings"], &score["high_run"]], [4, 3, 2, 2]);
    assert_eq!(score["average"], 1.5);
    drill(folder.path(), &["log", "mine", "--made", "7", "--of", "10"]).ok();
    let lines =
        run_with_input(command(folder.path(), &["drill", "log", "mine", "--json"]), "make\nmiss\nundo\nmake\nmake\n")
            .json();
    assert_eq!(lines.len(), 5, "every word is answered");
    assert_eq!([&lines[4]["tried"], &lines[4]["high_run"]], [3, 3]);
    let all = &drill(folder.path(), &["history", "--json"]).json()[0];
    assert_eq!(
        [&all["name"], &all["tried"], &all["made"], &all["high_run"]],
        [&json!("mine"), &json!(17), &json!(13), &json!(3)]
    );
    assert_eq!(drill(folder.path(), &["history", "mine", "--json"]).json().len(), 3);
    let text = drill(folder.path(), &["history", "mine"]).out;
    assert!(text.contains("13 of 17 made, 76 %") && text.contains('█'), "{text}");
    // Four undos for the results logged one by one, one for those logged together, three more for the first ones.
    assert_eq!(undo(8), Some(0));
    let text = drill(folder.path(), &["history", "mine"]).err;
    assert!(text.contains("not tried yet"), "{text}");
    assert_eq!(undo(1), Some(1));
    run_with_input(command(folder.path(), &["drill", "log", "mine"]), "undo\n").fails(1, &["to undo"]);
    // A session without any remaining attempt is not exported.
    let file = folder.path().join("all.json");
    let written = drill(folder.path(), &["export", file.to_str().unwrap()]);
    assert!((written.out + &written.err).contains("0 sessions"), "{}", written.code.unwrap());
}

#[test]
fn surplus_undos_are_refused_after_the_possible_ones() {
    let folder = folder();
    drill(folder.path(), &["log", "mine", "make", "miss"]);
    let undone = drill(folder.path(), &["log", "mine", "undo", "undo", "undo"])
        .fails(1, &["there is no attempt at mine to undo"]);
    assert!(undone.out.contains("undone; this session has no other attempts"), "{}", undone.out);
}

#[test]
fn an_overlong_line_is_refused_and_the_run_continues() {
    let folder = folder();
    let args = ["drill", "run", "mine", "--goal", "2", "--skill", "perfect", "--seed", "1", "--json"];
    let long = "0".repeat((1 << 20) + 1);
    let run = run_with_input(command(folder.path(), &args), &format!("0,0,0,90,1\n{long}\n0,0,0,90,1\n"));
    let lines = run.json();
    assert_eq!((run.code, of_kind(&lines, "attempt").len()), (Some(2), 2));
    let refused = of_kind(&lines, "refused");
    let error = refused[0]["error"].as_str().unwrap();
    assert!(refused.len() == 1 && refused[0]["line"] == 2 && error.contains("a line is too long"), "{refused:?}");
}

#[test]
fn a_seed_repeats_attempts_and_compares_with_the_model_shot() {
    let folder = folder();
    let play = || {
        let args =
            ["try", "mine", "--shot", "0,0.3,3,30,4", "--repeat", "5", "--skill", "club", "--seed", "3", "--json"];
        drill(folder.path(), &[&args[..], &["--budget-ms", "1000"]].concat()).json()
    };
    let (once, again) = (play(), play());
    let attempts = of_kind(&once, "attempt");
    assert_eq!(attempts.len(), 5);
    for (attempt, again) in attempts.iter().zip(of_kind(&again, "attempt")) {
        assert_eq!(
            [&attempt["played"], &attempt["end"], &attempt["chance"]],
            [&again["played"], &again["end"], &again["chance"]]
        );
        assert!(attempt["advised_chance"].as_f64() > attempt["chance"].as_f64(), "{attempt}");
        assert!(!attempt["changes"].as_array().unwrap().is_empty());
        assert_eq!(attempt["advised_by"], "exercise");
    }
    let own = drill(folder.path(), &["try", "mine", "--shot", "0,0.3,3,0.3,4", "--json"]).json();
    let own = of_kind(&own, "attempt")[0];
    assert_eq!([&own["changes"], &own["advised_chance"]], [&json!([]), &own["chance"]], "as the model shot");
    assert_ne!(attempts[0]["played"], attempts[1]["played"], "every attempt has its own errors");
    assert_eq!(drill(folder.path(), &["history", "--json"]).json()[0]["tried"], 11);
    let shifted = ["try", "mine", "--shot", "0,0.3,3,1,4", "--repeat", "3", "--shifted", "--budget-ms", "20", "--json"];
    let lines = drill(folder.path(), &shifted).json();
    assert_eq!(of_kind(&lines, "position").len(), 3, "the balls are shifted every time");
}

#[test]
fn a_run_reads_strokes_and_coach_and_skips_invalid_lines() {
    let folder = folder();
    let args = ["drill", "run", "mine", "--goal", "2", "--skill", "perfect", "--seed", "1", "--json"];
    let run = run_with_input(
        command(folder.path(), &args),
        "0,0,0,90,1\n\nfull speed\n0,0,0,0,-1\n0,0.8,0,0,1\ncoach\ncoach\ncoach\n",
    );
    let lines = run.json();
    let refused: Vec<u64> = of_kind(&lines, "refused").iter().map(|line| line["line"].as_u64().unwrap()).collect();
    assert_eq!((run.code, refused), (Some(2), vec![3, 4, 5]));
    let attempts = of_kind(&lines, "attempt");
    let numbers: Vec<_> = of_kind(&lines, "position").iter().map(|line| line["number"].as_u64().unwrap()).collect();
    assert_eq!(numbers, [1, 2, 3], "one before every stroke, though the balls do not change");
    let results: Vec<_> =
        attempts.iter().map(|attempt| (attempt["made"].as_bool(), attempt["helped"].as_bool())).collect();
    let [no, yes] = [false, true].map(Some);
    assert_eq!(results, [(no, no), (yes, yes), (yes, yes)], "two in a row end it");
    assert_eq!(attempts[0]["verdict"], "No point: no ball was hit");
    let result = lines.last().unwrap();
    assert_eq!([&result["kind"], &result["over"], &result["high_run"]], [&json!("result"), &json!(true), &json!(2)]);
}

#[test]
fn the_same_seed_and_simulations_give_the_same_strokes() {
    let folder = folder();
    let args = ["--coach", "--simulations", "300", "--seed", "3", "--skill", "club", "--json"];
    for command in [&["drill", "run", "mine", "--goal", "2", "--strokes", "3"][..], &["play", "--innings", "1"][..]] {
        let strokes = || {
            let lines = carom(folder.path(), &[command, &args[..]].concat()).json();
            of_kind(&lines, "attempt").into_iter().cloned().collect::<Vec<_>>()
        };
        let once = strokes();
        assert!(!once.is_empty() && once == strokes(), "{once:?}");
    }
    drill(folder.path(), &["try", "mine", "--shot", "coach", "--simulations", "0"]).fails(2, &["whole number from 1"]);
}

#[test]
fn a_session_without_attempts_is_not_named_because_it_is_not_saved() {
    let folder = folder();
    let args = ["drill", "run", "mine", "--goal", "2", "--json"];
    let result = |lines: &str| run_with_input(command(folder.path(), &args), lines).json().last().unwrap().clone();
    let none = result("quit\n");
    assert_eq!([&none["kind"], &none["session"], &none["tried"]], [&json!("result"), &Value::Null, &json!(0)]);
    assert_eq!(session_files(folder.path()).len(), 0);
    let name = result("0,0,0,90,1\n")["session"].as_str().unwrap().to_owned();
    assert!(session_files(folder.path())[0].to_string_lossy().contains(&name));
}

#[test]
fn exams_offer_no_table() {
    let folder = folder();
    assert!(!drill(folder.path(), &["exam", "--help"]).out.contains("--table"));
}

#[test]
fn quit_ends_a_session() {
    let folder = folder();
    let args = ["drill", "run", "mine", "--goal", "2", "--skill", "perfect", "--seed", "1", "--json"];
    let run = run_with_input(command(folder.path(), &args), "0,0,0,90,1\nquit\nfull speed\n");
    let lines = run.json();
    let counts = ["attempt", "refused", "result"].map(|kind| of_kind(&lines, kind).len());
    assert_eq!((run.code, counts), (Some(0), [1, 0, 1]), "{lines:?}");
}

#[test]
fn a_game_continues_from_end_positions_until_its_last_inning() {
    let folder = tempfile::tempdir().unwrap();
    let args = ["play", "--coach", "--innings", "2", "--rule", "three-cushion", "--skill", "beginner"];
    let lines = carom(folder.path(), &[&args[..], &["--seed", "5", "--json", "--budget-ms", "300"]].concat()).json();
    let mut lie = &Value::Null;
    for line in &lines {
        // After a miscue the balls stay where they are.
        match line["kind"].as_str() {
            Some("attempt") => lie = &line["end"],
            Some("position") => assert!(lie.is_null() || *lie == line["layout"], "{lie} {line}"),
            _ => {}
        }
    }
    let made: Vec<bool> = of_kind(&lines, "attempt").iter().map(|turn| turn["made"].as_bool().unwrap()).collect();
    let points = made.iter().filter(|made| **made).count();
    assert_eq!((made.len() - points, made.last()), (2, Some(&false)));
    let result = lines.last().unwrap();
    assert_eq!([&result["made"], &result["innings"]], [points, 2]);
    assert_eq!(result["average"].as_f64().unwrap(), points as f64 / 2.0);
    let games = drill(folder.path(), &["history", "--games", "three-cushion", "--json"]).json();
    assert!(games.is_empty(), "games of the coach are not in the player's history");
}

#[test]
fn a_line_is_refused_when_the_coach_finds_no_point() {
    let folder = tempfile::tempdir().unwrap();
    let args = ["play", "--table", "thesis", "--rule", "three-cushion", "--budget-ms", "0", "--innings", "1", "--json"];
    let layout = ["--layout", "0.58,-0.02 -0.72,-0.21 0.52,-0.4"];
    let lines = run_with_input(command(folder.path(), &[&args[..], &layout].concat()), "coach\n0,0,0,0,2\n").json();
    assert_eq!([of_kind(&lines, "refused").len(), of_kind(&lines, "attempt").len()], [1, 1], "{lines:?}");
}

#[test]
fn enough_results_give_a_skill_that_commands_accept() {
    let folder = folder();
    drill(folder.path(), &["skill"]).fails(1, &["0 of 20 attempts, at 0 of 3 different shots"]);
    let own = |args: &[&str]| carom(folder.path(), &[args, &["--skill", "own"]].concat());
    own(&["recommend"]).fails(1, &["carom drill skill --keep"]);
    drill(folder.path(), &["log", "half-ball", "--made", "60", "--of", "60"]);
    let one_shot = "60 attempts are enough, but at 1 of 3 different shots. \
        Only strokes noted at a real table count: model shots";
    drill(folder.path(), &["skill", "--keep"]).fails(1, &[one_shot]);
    for other in ["big-ball", "follow-left"] {
        drill(folder.path(), &["log", other, "--made", "9", "--of", "9"]);
    }
    drill(folder.path(), &["skill", "--keep"]).fails(1, &["at least"]);
    assert!(drill(folder.path(), &["skill"]).out.contains("at least"));
    assert_eq!(own(&["recommend"]).code, Some(1), "nothing was kept");
    drill(folder.path(), &["log", "half-ball", "undo"]);
    drill(folder.path(), &["log", "mine", "--made", "12", "--of", "60"]);
    let answer = &drill(folder.path(), &["skill", "--keep", "--json"]).json()[0];
    assert_eq!([&answer["kept"], &drill(folder.path(), &["skill", "--json"]).json()[0]["kept"]], [true, true]);
    let number = |value: &Value| value.as_f64().unwrap();
    let [low, high] = [&answer["interval"][0], &answer["interval"][1]].map(number);
    assert!(low < number(&answer["scale"]) && number(&answer["scale"]) < high && high < 16.0, "{answer}");
    let report = own(&["evaluate", "--policy-only", "--layouts", "1", "--json"]).json().remove(0);
    assert_eq!(report["robustness"]["skill"], answer["skill"]);
    let lines = own(&["drill", "try", "mine", "--shot", "0,0.3,3,1,4", "--budget-ms", "0", "--json"]).json();
    assert_eq!(of_kind(&lines, "attempt").len(), 1);
}

#[test]
fn invalid_or_missing_names_and_values_are_named() {
    let folder = folder();
    let cases: [(&[&str], i32, &str); 12] = [
        (&["show", "nobody"], 1, "\"nobody\""),
        (&["history", "nobody"], 1, "\"nobody\""),
        (&["remove", "nobody"], 1, "\"nobody\""),
        (SAVE, 1, "--replace"),
        (&["log", "mine", "made"], 2, "\"made\""),
        (&["log", "mine", "--made", "4", "--of", "3"], 2, "4 made of 3"),
        (&["save", "a/b", "--layout", "-0.5,0 0,0 0.5,0.03"], 2, "\"a/b\""),
        (&["save", "near", "--layout", "0,0 0,0 0.5,0.03"], 2, "0.0615"),
        (&["try", "mine", "--shot", "0,0.8,0,0,1"], 2, "0.6400"),
        (&["try", "mine", "--shot", "hardly"], 2, "\"hardly\""),
        (&["add", "carom:04000"], 2, "damaged"),
        (&["list", "--category", "snooker"], 2, "three-cushion"),
    ];
    for (args, code, word) in cases {
        drill(folder.path(), args).fails(code, &[word]);
    }
}

#[test]
fn exercises_accept_a_users_table_of_the_same_size() {
    let folder = folder();
    let file = folder.path().join("cellar.toml");
    let own = carom(folder.path(), &["table", "show", "match"]).out.replace("name = \"match\"", "name = \"cellar\"");
    std::fs::write(&file, own.replace("mu_s = ", "mu_s = 0.1 # ")).unwrap();
    let file = file.to_str().unwrap();
    let shot = ["--shot", "0,0.3,3,1,4", "--skill", "perfect", "--json"];
    let on = |table: &[&str]| drill(folder.path(), &[&["try", "mine"], &shot[..], table].concat()).json();
    let (own, bundled) = (on(&["--table", file]), on(&[]));
    assert_eq!([&own[0]["table"], &bundled[0]["table"]], ["cellar", "match"]);
    assert_ne!(own[1]["end"], bundled[1]["end"], "the cloth has another friction");
    drill(folder.path(), &["try", "mine", "--shot", "coach", "--table", "thesis"])
        .fails(2, &["2.84 by 1.42 m", "\"thesis\" is another"]);
    drill(folder.path(), &["exam", "--table", file]).fails(2, &["--table"]);
    let game =
        run_with_input(command(folder.path(), &["play", "--table", file, "--innings", "1", "--json"]), "0,0,0,0,1\n")
            .json();
    assert_eq!(game[0]["table"], "cellar");
}

#[test]
fn an_exam_of_one_category_has_its_exercises_only() {
    let folder = folder();
    let args = ["drill", "exam", "--category", "draw", "--seed", "1", "--json"];
    let lines = run_with_input(command(folder.path(), &args), &"0,0,0,0,1\n".repeat(20)).json();
    let result = of_kind(&lines, "result")[0];
    assert_eq!([&result["tried"], &result["over"]], [&json!(6), &json!(true)], "{lines:?}");
    drill(folder.path(), &["exam", "--category", "own"])
        .fails(1, &["nobody has measured how difficult your own positions are"]);
    drill(folder.path(), &["exam", "--category", "banks"]).fails(2, &["there is no category \"banks\""]);
}

#[test]
fn an_exam_has_twenty_exercises_and_grades_the_score() {
    let folder = folder();
    let args = ["exam", "--level", "2", "--seed", "8", "--skill", "perfect", "--budget-ms", "200", "--json"];
    let lines = drill(folder.path(), &[&args[..], &["--coach"]].concat()).json();
    let attempts = of_kind(&lines, "attempt");
    let names: std::collections::BTreeSet<&str> =
        attempts.iter().map(|attempt| attempt["exercise"].as_str().unwrap()).collect();
    assert_eq!((attempts.len(), names.len()), (20, 20));
    let result = lines.last().unwrap();
    let points = result["made"].as_u64().unwrap();
    assert_eq!((&result["over"], &result["nearest"]), (&json!(true), &json!("world-class")), "{result}");
    assert!(points > 15, "a perfect player makes what the coach finds: {points}");
    // The same seed selects the same exercises; an exam that ends early is saved as far as it was played.
    let lines = run_with_input(command(folder.path(), &[&["drill"], &args[..]].concat()), "0,0,0,0,1\n").json();
    assert_eq!(of_kind(&lines, "position")[0]["exercise"], attempts[0]["exercise"]);
    let result = lines.last().unwrap();
    assert_eq!([&result["tried"], &result["over"]], [&json!(1), &json!(false)]);
    let text = run_with_input(command(folder.path(), &["drill", "exam"]), "0,0,0,0,1\n").out;
    assert!(text.contains("(1 of 20 played)"), "{text}");
}

#[test]
fn a_game_ended_by_the_stroke_limit_is_reported() {
    let folder = folder();
    let played = |strokes: &str| {
        let args = ["play", "--coach", "--innings", "3", "--budget-ms", "10", "--seed", "1", "--strokes", strokes];
        carom(folder.path(), &args)
    };
    let cut = played("2");
    let says = "the limit of 2 strokes ended it; --strokes sets another, up to 10000";
    assert!(cut.code == Some(0) && cut.err.contains(says), "{}", cut.err);
    // The miss that ends the last inning ends the game, even at the limit of strokes.
    let missing = run_with_input(
        command(folder.path(), &["play", "--innings", "1", "--strokes", "1", "--skill", "perfect"]),
        "0,0,0,90,1\n",
    );
    assert!(missing.code == Some(0) && !missing.err.contains("limit"), "{}", missing.err);
    let run = ["drill", "run", "mine", "--goal", "9", "--strokes", "2"];
    let run = run_with_input(command(folder.path(), &run), &"0,0,0,90,1\n".repeat(3));
    assert!(run.err.contains(says), "{}", run.err);
}
