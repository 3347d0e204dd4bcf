//! Games of two sides: whose turn it is, which ball is the cue ball, and the score of each side.

use super::of_kind;
use crate::program::{carom, command, folder, run_with_input};

/// A stroke that moves the cue ball a little and meets nothing.
const MISS: &str = "0,0,5,180,0.3\n";

#[test]
fn after_a_miss_the_other_side_plays_the_same_position() {
    let folder = folder();
    let args = ["play", "--both", "--ball", "yellow", "--innings", "1", "--seed", "1", "--json"];
    let lines = run_with_input(command(folder.path(), &args), &MISS.repeat(5)).json();
    let (positions, attempts) = (of_kind(&lines, "position"), of_kind(&lines, "attempt"));
    assert_eq!(attempts.len(), 2, "one inning of each side: {lines:?}");
    for (index, colour) in ["yellow", "white"].into_iter().enumerate() {
        assert_eq!([&positions[index]["cue_ball"], &attempts[index]["cue_ball"]], [colour, colour]);
    }
    let (end, next) = (&attempts[0]["end"], &positions[1]["layout"]);
    assert_eq!([&end[0], &end[1], &end[2]], [&next[1], &next[0], &next[2]]);
    let result = of_kind(&lines, "result")[0];
    assert_eq!(result["over"], true);
    for side in ["white", "yellow"] {
        assert_eq!([&result["sides"][side]["tried"], &result["sides"][side]["innings"]], [1, 1]);
    }
}

#[test]
fn the_coach_plays_the_other_side_against_the_player() {
    let folder = folder();
    let args = ["play", "--against-coach", "--innings", "2", "--seed", "1", "--strokes", "40"];
    let args = [&args[..], &["--skill", "beginner", "--json"]].concat();
    let lines = run_with_input(command(folder.path(), &args), &MISS.repeat(5)).json();
    let attempts = of_kind(&lines, "attempt");
    assert!(attempts.iter().any(|attempt| attempt["cue_ball"] == "yellow"), "{lines:?}");
    for attempt in &attempts {
        assert_eq!(attempt["by_coach"], attempt["cue_ball"] == "yellow", "{attempt}");
        assert_eq!(attempt["helped"], false, "{attempt}");
    }
    let alone = ["play", "--ball", "yellow", "--innings", "2", "--seed", "1", "--json"];
    let lines = run_with_input(command(folder.path(), &alone), &MISS.repeat(5)).json();
    assert!(of_kind(&lines, "attempt").iter().all(|attempt| attempt["cue_ball"] == "yellow"));
    assert!(of_kind(&lines, "result")[0].get("sides").is_none());
    let text = run_with_input(command(folder.path(), &["play", "--both", "--innings", "1"]), &MISS.repeat(3)).out;
    assert!(text.contains("the cue ball is white") && text.contains("the cue ball is yellow"), "{text}");
    assert!(text.contains("\nwhite: 0 of 1 made") && text.contains("\nyellow: 0 of 1 made"), "{text}");
}

#[test]
fn a_match_to_points_has_an_equalising_inning_and_a_winner() {
    let folder = folder();
    let common = ["play", "--points", "1", "--skill", "perfect", "--seed", "1"];
    // White makes the point from the opening position at straight rail; yellow misses from the same position.
    let input = format!("0.2,0.3,6,-8.8,2.5\n{MISS}");
    let lines = run_with_input(command(folder.path(), &[&common[..], &["--both", "--json"]].concat()), &input).json();
    let positions = of_kind(&lines, "position");
    let balls: Vec<_> = positions.iter().map(|position| &position["cue_ball"]).collect();
    assert_eq!(balls, ["white", "yellow"], "{lines:?}");
    assert_eq!(positions[0]["layout"], positions[1]["layout"]);
    let result = of_kind(&lines, "result")[0];
    assert_eq!([&result["over"], &result["sides"]["white"]["made"]], [&serde_json::json!(true), &serde_json::json!(1)]);
    assert_eq!(result["winner"], "white");
    let text = run_with_input(command(folder.path(), &[&common[..], &["--both"]].concat()), &input).out;
    assert!(text.contains("\nwhite 1 : 0 yellow: white wins\n"), "{text}");
    assert!(text.contains("; run 1; white 1 : 0 yellow; ") && text.contains("; the equalising inning\n"), "{text}");
    // The coach has a skill of its own.
    let args = [&common[..], &["--against-coach", "--coach-skill", "beginner", "--innings", "1", "--json"]].concat();
    let lines = run_with_input(command(folder.path(), &args), MISS).json();
    let skills: Vec<_> = of_kind(&lines, "position").iter().map(|position| position["skill"].clone()).collect();
    assert_eq!(skills[..2], ["perfect", "beginner"], "{lines:?}");
    carom(folder.path(), &["play", "--points", "3"]).fails(2, &["--points 3 is the distance of a match", "--both"]);
    carom(folder.path(), &["play", "--coach-skill", "club"]).fails(2, &["--against-coach"]);
}

#[test]
fn unknown_balls_and_sides_are_refused_with_accepted_values() {
    let folder = folder();
    for (args, says) in
        [(["play", "--ball", "red"], "use white or yellow"), (["play", "--side", "up"], "left or right")]
    {
        carom(folder.path(), &args).fails(2, &[says]);
    }
}
